"""What G2 says of rehearsals with masses: how they ended, or in one line that none was run."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace

import pytest

from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell, load
from cellc.mock.gates import GateCheck, JudgedRun, PhysicsRuns, Verdict, rehearsed_with_masses, sign_gates
from tests.cells import generated

_WORDS = "With masses, drives and contacts too"


@pytest.fixture(scope="module")
def minimal() -> MockCell:
    return load(generated("minimal"))


def _line(cell: MockCell, physics: PhysicsRuns, runs: Sequence[JudgedRun] = ()) -> GateCheck:
    (found,) = [
        check
        for gate in sign_gates(cell.folder, runs, 0, physics=physics)
        for check in gate.checks
        if _WORDS in check.text
    ]
    return found


def test_rehearsals_are_run_with_masses_and_one_that_fails_there_fails_the_gate(minimal: MockCell) -> None:
    physics = rehearsed_with_masses(minimal, generated("minimal"), 0)
    assert physics.results == (load(generated("minimal"), physics=True).run("ready"),)
    passed = _line(minimal, physics)
    assert (passed.verdict, passed.evidence) == (Verdict.PASSED, (f"{physics.computed_by}, ready: succeeded",))
    (ready,) = physics.results
    other = replace(physics, results=(replace(ready, outcome=AttemptOutcome.TIMEOUT),))
    assert _line(minimal, other).verdict is Verdict.FAILED


def test_without_mujoco_one_line_says_that_nothing_was_run_with_masses(
    minimal: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    line = _line(minimal, rehearsed_with_masses(minimal, generated("minimal"), 0))
    assert line.verdict is Verdict.UNKNOWN
    assert line.evidence == ("`cellc gates` where MuJoCo is installed (extra `physics`): it was not run with masses",)
