"""Rehearsals whose joints and parts have mass: how they end, and that they end so bit by bit."""

from __future__ import annotations

import shutil
from dataclasses import asdict
from functools import cache
from pathlib import Path

import pytest

from cellc.mock import MockCell
from cellc.mock.cell import load
from cellc.mock.errors import MockError
from cellc.mock.plant import Plant
from tests.cells import EVERY_CELL, generated
from tests.cli.run import run


@cache
def _cell(name: str) -> MockCell:
    return load(generated(name), physics=True)


@pytest.mark.parametrize("name", EVERY_CELL)
def test_rehearsals_end_as_they_are_expected_to(name: str) -> None:
    cell = _cell(name)
    failed = {entry.name: result.reason for entry in cell.entries if not (result := cell.run(entry.name)).passed}
    assert failed == {}


def _run(cell: MockCell, rehearsal: str, *, from_off: bool, often: bool = False) -> tuple[str, bytes]:
    """Return the result of a run, and where everything was in each of its cycles.

    Args:
        often: have the state looked at in another rhythm, so that blocks of cycles end elsewhere.
    """
    plants: list[Plant] = []

    def watch(plant: Plant) -> None:
        plants.append(plant)
        if often:
            plant.simulation.every(0, 173.0, lambda _: plant.control.interrupt())

    result = cell.rehearse(cell.entry(rehearsal), watch=watch, from_off=from_off)
    dynamics = plants[-1].control.dynamics
    assert dynamics is not None
    times, states, commands = dynamics.since(0)
    return repr(asdict(result)), times.tobytes() + states.tobytes() + commands.tobytes()


@pytest.mark.parametrize("rehearsal", ["pick_and_place", "lost_part"])
def test_a_run_is_the_same_again_after_a_copy_and_however_far_it_is_computed_ahead(rehearsal: str) -> None:
    cell = load(generated("ur5e_pick"), physics=True)
    first = _run(cell, rehearsal, from_off=True)
    cell.run("gripper_activated")  # which keeps a copy of the cell after its bring-up
    assert _run(cell, rehearsal, from_off=False) == first
    assert _run(cell, rehearsal, from_off=True, often=True) == first


@pytest.mark.parametrize(("cell", "rehearsal"), [("dual_ur", "canceled"), ("hybrid_sdk", "loop_ended")])
def test_a_run_of_several_owners_is_the_same_again(cell: str, rehearsal: str) -> None:
    known = load(generated(cell), physics=True)
    first = _run(known, rehearsal, from_off=True)
    known.run(rehearsal)
    assert _run(known, rehearsal, from_off=False) == first


def test_owners_of_joints_share_one_world() -> None:
    """Each manager reports all joints: both read the same positions of both arms, to the last bit, at every stamp."""
    known, plants = load(generated("dual_ur"), physics=True), list[Plant]()
    known.rehearse(known.entry("canceled"), watch=plants.append)
    one, other = plants[-1].control.managers.values()
    assert one.now_ns == other.now_ns
    assert one.joint_positions() == other.joint_positions()
    assert len({at for at in one.joint_positions().values() if at}) > 6


def test_results_say_that_joints_have_mass_and_evidence_is_the_same_run(tmp_path: Path) -> None:
    folder, records = generated("minimal").as_posix(), tmp_path / "records.jsonl"
    told = run("mock", folder, "--physics", "--records", records.as_posix())
    assert told.out.startswith("note: joints and parts have mass, drives and contacts: `--physics`\n")
    assert "note: joints" not in run("mock", folder).out
    assert run("mock", folder, "--physics", "--evidence", (tmp_path / "evidence").as_posix()).code == 0
    assert (tmp_path / "evidence" / "ready.records.jsonl").read_bytes() == records.read_bytes()


def test_a_folder_without_a_scene_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "minimal"
    shutil.copytree(generated("minimal"), folder)
    manifest = folder / "manifest.json"
    lines = manifest.read_text(encoding="utf-8").splitlines(keepends=True)
    manifest.write_text("".join(line for line in lines if "sim/scene.xml" not in line), encoding="utf-8")
    with pytest.raises(MockError, match=r"holds no sim/scene.xml, which `--physics` needs; build it again"):
        load(folder, physics=True)


def test_an_edited_scene_is_executed(tmp_path: Path) -> None:
    folder = tmp_path / "ur5e_pick"
    shutil.copytree(generated("ur5e_pick"), folder)
    scene = folder / "sim/scene.xml"
    text = scene.read_text(encoding="utf-8")
    assert text.count('friction="0.5 ') == 1
    scene.write_text(text.replace('friction="0.5 ', 'friction="0.001 '), encoding="utf-8")
    with pytest.raises(MockError, match="is not executed"):
        load(folder, edited=True)
    result = load(folder, edited=True, physics=True).run("pick_and_place")
    assert (result.outcome, result.edited) == ("grip_failure", True)


def test_what_mujoco_refuses_is_said_in_one_line(tmp_path: Path) -> None:
    folder = tmp_path / "minimal"
    shutil.copytree(generated("minimal"), folder)
    (folder / "sim/scene.xml").write_text("<mujoco><worldbody><body><joint/></body></worldbody></mujoco>")
    ended = run("mock", folder.as_posix(), "--edited", "--physics")
    assert (ended.code, ended.out, ended.err.count("\n")) == (2, "", 1)
    assert "sim/scene.xml: MuJoCo refuses it" in ended.err


def test_physics_is_of_one_folder() -> None:
    ended = run("mock", generated("minimal").as_posix(), generated("rail_arm").as_posix(), "--physics")
    assert ended.code == 2
    assert "--physics needs exactly one folder." in ended.err
