"""The cell of the chapter, built once, and rehearsals of it that stand in no folder."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import pytest

from cellc.contract.attempt import AttemptRecord
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.mock import MockCell, load
from cellc.mock.plant import Plant
from cellc.mock.result import RehearsalResult
from tests.cells import generated

HOME = StepEntry(kind=StepKind.MOVE, target="home")
DETECT = StepEntry(kind=StepKind.DETECT, target="object")
PICK = StepEntry(kind=StepKind.MOVE, target="pick")
ACKNOWLEDGE = StepEntry(kind=StepKind.ACKNOWLEDGE, target="operator")


def wait(duration_s: float) -> StepEntry:
    """Return a step that lets time pass."""
    return StepEntry(kind=StepKind.WAIT, target="", duration_s=duration_s)


def during(
    step: int,
    kind: FaultKind,
    target: str = "",
    *,
    when: Literal["started", "accepted", "moving"] = "moving",
    after_s: float = 0.3,
    **parameters: Any,
) -> FaultEntry:
    """Return a fault that begins while a step moves the arm."""
    event = FaultEvent(step=step, when=when, after_s=after_s)
    return FaultEntry(kind=kind, target=target, event=event, **parameters)


@dataclass(frozen=True, slots=True)
class Run:
    """A finished rehearsal with the plant that it ran on."""

    result: RehearsalResult
    plant: Plant

    @property
    def failed(self) -> AttemptRecord:
        """The first attempt that failed."""
        return next(record for record in self.result.attempts if record.outcome != "succeeded")

    def attempt(self, number: int) -> AttemptRecord:
        """Return an attempt by its step, from 1."""
        return self.result.attempts[number - 1]

    def travel(self, from_ns: int, until_ns: int) -> float:
        """Return by how much, in rad or m, any joint that is reported was moved between two instants."""
        spans = [0.0]
        for history in self.plant.control.histories.values():
            chosen = (history.stamps >= from_ns) & (history.stamps <= until_ns)
            if chosen.any():
                positions = history.positions[chosen]
                spans.append(float(np.ptp(positions, axis=0).max()))
        return max(spans)


Rehearse = Callable[..., Run]


@pytest.fixture(scope="session")
def cell() -> MockCell:
    """The loaded cell `ur5e_pick`."""
    return load(generated("ur5e_pick"))


@pytest.fixture(scope="session")
def plain(cell: MockCell) -> RehearsalEntry:
    """Its rehearsal without a fault: home, detect, pick, close, place, open, home."""
    return next(entry for entry in cell.entries if not entry.faults)


@pytest.fixture(scope="session")
def run(cell: MockCell, plain: RehearsalEntry) -> Rehearse:
    """Run the plain rehearsal, or other steps, with faults."""

    def rehearse(*faults: FaultEntry, **changes: Any) -> Run:
        plants: list[Plant] = []
        entry = plain.model_copy(update={"name": "faulty", "faults": faults, **changes})
        result = cell.rehearse(entry, watch=plants.append)
        return Run(result, plants[0])

    return rehearse
