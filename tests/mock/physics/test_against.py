"""The two runs of a rehearsal side by side: where they part, and by how much."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell
from cellc.mock.cell import cell_of, load, read_to_run
from cellc.mock.command.against import Comparison, compared
from cellc.robot.physics.scene import Scene
from tests.cells import generated
from tests.cli.run import run


def test_runs_that_end_alike_are_told_with_the_steps_that_take_longer() -> None:
    folder = generated("minimal")
    found = compared(load(folder), load(folder, physics=True), "ready", 0)
    assert found.alike
    # A gripper that has mass runs up to its speed, and is still before it is asked where it is.
    assert (
        found.parting()
        == "step 2 `grip close gripper` takes 0.10 s longer; step 4 `grip open gripper` takes 0.10 s longer"
    )
    # The shoulder turns at up to 1.3 rad/s; its loop of 100 rad/s is 2 / 100 s behind.
    assert found.away is not None
    assert 0.01 < found.away.by < 0.04


def _without_friction(folder: Path) -> MockCell:
    """Return a cell whose drives turn without friction, so that its springs swing."""
    text, count = re.subn(' frictionloss="[^"]*"', "", (folder / "sim/scene.xml").read_text(encoding="utf-8"))
    assert count == 7
    return cell_of(replace(read_to_run(folder, physics=True), scene=Scene(text, {})))


def test_runs_that_part_are_told_with_the_step_and_the_reason() -> None:
    folder = generated("fr3_hand")
    found = compared(load(folder), _without_friction(folder), "canceled", 0)
    assert not found.alike
    assert found.parting() == "step 3 `move pick`: canceled without mass, timeout with it"
    told = re.search(
        r"; stopping distance: joint (fr3_joint\d) goes on by (\S+) mrad, and still moves at ", found.having.reason
    )
    assert told is not None, found.having.reason
    assert 1.0 < float(told[2]) < 200.0


def test_a_step_that_only_one_run_begins_is_told() -> None:
    folder = generated("minimal")
    whole = load(folder).run("ready")
    first, *_, end = whole.attempts
    failed = replace(first, outcome=AttemptOutcome.TIMEOUT)
    short = replace(whole, attempts=(failed, end), outcome=AttemptOutcome.TIMEOUT)
    assert Comparison(whole, short, None).parting() == f"step 1 `{first.step}`: succeeded without mass, timeout with it"
    cut = replace(whole, attempts=(first, end))
    second = whole.attempts[1].step
    assert Comparison(whole, cut, None).parting() == f"step 2 `{second}`: succeeded without mass, not started with it"


def test_the_command_prints_one_row_for_each_rehearsal_and_ends_with_what_has_mass() -> None:
    told = run("mock", generated("fr3_hand").as_posix(), "--physics", "--against")
    assert told.code == 0
    assert "alike    tray_to_press: succeeded, 13.95 s without mass, " in told.out
    program = run("mock", generated("minimal").as_posix(), "--physics", "--against", "--json")
    (row,) = json.loads(program.out)["rehearsals"]
    assert (program.code, row["name"], row["alike"], row["passed"]) == (0, "ready", True, True)
    assert row["outcome"] == {"with": "succeeded", "without": "succeeded"}


def test_what_does_not_go_together_is_refused() -> None:
    folder = generated("minimal").as_posix()
    assert "--against needs --physics." in run("mock", folder, "--against").err
    ended = run("mock", folder, "--physics", "--against", "--records", "records.jsonl")
    assert (ended.code, "--against cannot be combined" in ended.err) == (2, True)
