"""The mock executes callbacks one after the other where the spec says that they share a thread or a group."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from cellc.contract.entities import Processing
from cellc.mock import load
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.simulation import Simulation
from cellc.mock.nodes.executors import Executors
from cellc.mock.plant import Plant
from tests.cells import build_into, spec_text, written

_NODE = "lifecycle: true, host: control_pc, owner: perception"
_TAKES = "executor: single_threaded, callbacks: {/camera/color/image_raw: {takes: TIME}}"


def _oldest_s(tmp_path: Path, said: str) -> float:
    """Return the greatest age of a pose that reaches the task while the arm picks a part."""
    tmp_path.mkdir()
    text = spec_text("ur5e_pick").replace(_NODE, f"{_NODE}{said}", 1)
    cell = load(build_into(tmp_path.with_suffix(".built"), written(tmp_path, text)))
    ages: list[float] = []

    def watch(plant: Plant) -> None:
        inbox = plant.task.observations["object"]
        inbox.listen(lambda pose: ages.append(inbox.age_s(pose.stamp_ns)))

    result = cell.rehearse(cell.entry("canceled"), seed=0, watch=watch)
    assert result.outcome == result.expected
    return max(ages)


def test_poses_are_older_by_what_the_callback_takes(tmp_path: Path) -> None:
    stated = {time: _oldest_s(tmp_path / time, ", " + _TAKES.replace("TIME", f"{time} ms")) for time in ("20", "28")}
    assert stated["20"] == pytest.approx(
        _oldest_s(tmp_path / "none", "")
    )  # what the mock takes where nothing is stated
    assert stated["28"] - stated["20"] == pytest.approx(0.008, abs=1e-6)


def test_what_shares_a_line_waits_and_what_has_none_does_not() -> None:
    simulation = Simulation(ControlStack({}, {}, 1.0, {}))
    executors, ended = Executors(simulation), dict[str, int]()
    for name, line in (("a", "node"), ("b", "node"), ("c", ""), ("d", "")):
        executors.execute(Processing(line=line, takes_s=0.01), partial(_note, ended, name, simulation))
    simulation.catch_up(1_000_000_000)
    assert ended == {"a": 10_000_000, "b": 20_000_000, "c": 10_000_000, "d": 10_000_000}


def _note(ended: dict[str, int], name: str, simulation: Simulation) -> None:
    ended[name] = simulation.now_ns
