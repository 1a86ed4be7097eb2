"""A goal moves out of the reach of its group."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.plant import Plant

DISTANCE_M = 10.0
"""Farther than any arm of a cell reaches."""


@dataclass(frozen=True, slots=True)
class Unreachable:
    """Displaces a goal along the z axis of its frame."""

    goal: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Unreachable | None:
        """Return the fault of an entry; None where its target is no Cartesian goal."""
        return cls(entry.target) if entry.target in contract.goals else None

    def begin(self, plant: Plant) -> None:
        """Displace it."""
        plant.requests.displaced[self.goal] = (0.0, 0.0, DISTANCE_M)

    def end(self, plant: Plant) -> None:
        """Put it back."""
        plant.requests.displaced.pop(self.goal, None)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every Cartesian goal."""
    for goal in contract.goals:
        entry = FaultEntry(kind="unreachable", target=goal)
        yield fault_case(entry, contract, partial(_ending, Bounds(contract), goal))


def _ending(bounds: Bounds, goal: str, step: CellStep) -> Ending:
    if (step.kind, step.target) != ("move", goal):
        return BORNE
    return ends_in("planning_failure", within_s=bounds.asked_s())
