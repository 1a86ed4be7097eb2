"""The pick-and-place cell with its rehearsals run, as evidence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from cellc.contract.attempt import AttemptRecord
from cellc.mock import MockCell, load
from cellc.mock.folder import GeneratedFolder
from cellc.mock.gates import GateCheck, GateResult, JudgedRun, judged_rehearsals, sign_gates
from tests.cells import generated


@pytest.fixture(scope="session")
def pick() -> MockCell:
    """The loaded cell."""
    return load(generated("ur5e_pick"))


@pytest.fixture(scope="session")
def rehearsed(pick: MockCell) -> tuple[JudgedRun, ...]:
    """Its declared rehearsals: one that succeeds, a stale camera, a canceled goal."""
    return judged_rehearsals(pick.entries, [pick.run(name) for name in pick.rehearsals])


def gate(name: str, folder: GeneratedFolder, runs: tuple[JudgedRun, ...]) -> GateResult:
    """Sign the gates, and return one."""
    return next(each for each in sign_gates(folder, runs, 0) if each.gate == name)


def line(result: GateResult, words: str) -> GateCheck:
    """Return the one line of a gate that has some words."""
    found = [check for check in result.checks if words in check.text]
    assert len(found) == 1, [check.text for check in result.checks]
    return found[0]


def with_attempt(run: JudgedRun, step: str, change: Callable[[AttemptRecord], AttemptRecord]) -> JudgedRun:
    """Return a run whose attempt of a step is another one."""
    attempts = tuple(change(attempt) if attempt.step == step else attempt for attempt in run.result.attempts)
    return replace(run, result=replace(run.result, attempts=attempts))
