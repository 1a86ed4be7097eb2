"""Units are answered once each, whoever does them, and whoever dies of them."""

from __future__ import annotations

import multiprocessing
import os
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from cellc.compute.processes import processes
from cellc.compute.work import ComputeError, Work, in_order, stream


def _squares(offset: int) -> Callable[[int], int]:
    return lambda unit: unit * unit + offset


def _deadly(folder: str) -> Callable[[int], int]:
    """Answer; the process that gets unit 3 ends by itself as often as the folder has files to take away."""

    def do(unit: int) -> int:
        lives = sorted(Path(folder).iterdir()) if unit == 3 else []
        if lives:
            lives[0].unlink()
            os._exit(9)
        return unit * unit

    return do


def _refused(_: None) -> Callable[[int], int]:
    raise ValueError("not with this shared value")


def test_every_unit_is_answered_once_and_no_process_is_left() -> None:
    found = list(stream(Work(_squares, 5), range(7), processes(2)))
    assert sorted(found) == [(number, number * number + 5) for number in range(7)]
    assert list(in_order(found)) == [number * number + 5 for number in range(7)]
    assert multiprocessing.active_children() == []


def test_a_worker_that_dies_costs_time_and_nothing_else(tmp_path: Path) -> None:
    for life in range(2):
        (tmp_path / str(life)).touch()
    found = sorted(stream(Work(_deadly, str(tmp_path)), range(6), processes(2)))
    assert found == [(number, number * number) for number in range(6)]
    assert list(tmp_path.iterdir()) == []


def test_a_unit_that_no_worker_survives_is_named(tmp_path: Path) -> None:
    for life in range(9):
        (tmp_path / str(life)).touch()
    work = Work(_deadly, str(tmp_path), lambda unit: f"unit {unit}")
    with pytest.raises(ComputeError, match=re.escape("`unit 3` ended by itself, 3 times")):
        list(stream(work, range(6), processes(2)))
    assert len(list(tmp_path.iterdir())) == 6
    assert multiprocessing.active_children() == []


def test_what_work_raises_is_raised_and_a_caller_that_stops_early_leaves_no_process() -> None:
    with pytest.raises(ValueError, match="not with this shared value"):
        list(stream(Work(_refused, None), range(3), processes(2)))
    found = stream(Work(_squares, 0), range(100), processes(1))
    next(found)
    found.close()
    assert multiprocessing.active_children() == []
