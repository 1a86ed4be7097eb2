"""The task looks at the cell as rarely as nothing can have happened, and sees everything when it would have anyway."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import pytest

from cellc.mock import MockCell
from cellc.mock.plant import Plant
from cellc.mock.task import context, watch
from tests.mock.conftest import LoadWith, fault

_LOOK_NS = 200_000_000


def _always(plant: Plant, *, disturbed: bool) -> int:
    """Return the next look of a task that looks five times a second."""
    return plant.now_ns + _LOOK_NS


@pytest.mark.parametrize("at_s", [2.05, 2.8501, 7.45])
def test_missed_cycles_are_seen_at_the_instant_at_which_looking_all_the_time_sees_them(
    load_with: LoadWith, monkeypatch: pytest.MonkeyPatch, at_s: float
) -> None:
    cell = load_with(fault("skip_cycles", "control", at_s, cycles=20), expect="missed_cycle")
    restore_topic = cell.run("faulty")
    monkeypatch.setattr(context, "next_look_ns", _always)
    assert restore_topic.outcome == "missed_cycle"
    assert repr(asdict(restore_topic)) == repr(asdict(cell.run("faulty")))


def test_a_quiet_rehearsal_ends_bit_by_bit_as_with_every_look_and_needs_fewer(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: dict[str, int] = {"seldom": 0, "always": 0}

    def seldom(plant: Plant, *, disturbed: bool) -> int:
        looks["seldom"] += 1
        return watch.next_look_ns(plant, disturbed=disturbed)

    def always(plant: Plant, *, disturbed: bool) -> int:
        looks["always"] += 1
        return _always(plant, disturbed=disturbed)

    monkeypatch.setattr(context, "next_look_ns", seldom)
    restore_topic = cell.run("pick_and_place")
    monkeypatch.setattr(context, "next_look_ns", always)
    assert repr(asdict(restore_topic)) == repr(asdict(cell.run("pick_and_place")))
    assert looks["seldom"] < 0.7 * looks["always"]


def _bound_observations(contract: Any) -> None:
    """Let an observation be too old before the next one comes, which is 100 ms later."""
    contract["interfaces"]["/object_pose"]["max_age_s"] = 0.14


def test_a_task_that_slept_over_a_stale_observation_runs_again_with_every_look(
    edit_contract: Callable[[Callable[[Any], None]], MockCell],
) -> None:
    cell, plants = edit_contract(_bound_observations), list[Plant]()
    entry = cell.entry("pick_and_place")
    slept = cell.rehearse(entry, watch=plants.append, from_off=False)
    assert slept.outcome == "stale_state"
    assert len(plants) == 2
    assert repr(asdict(slept)) == repr(asdict(cell.rehearse(entry, watch=plants.append)))
    assert len(plants) == 3


def test_a_task_whose_observations_come_in_time_runs_once_and_ends_as_with_every_look(cell: MockCell) -> None:
    entry, plants = cell.entry("pick_and_place"), list[Plant]()
    slept = cell.rehearse(entry, watch=plants.append, from_off=False)
    assert len(plants) == 1
    assert repr(asdict(slept)) == repr(asdict(cell.rehearse(entry, watch=plants.append)))
