"""The update loops miss cycles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, FaultCase, ends_in, fault_case
from cellc.mock.plant import Plant

BEYOND = 5
"""Cycles that a case misses beyond those that are allowed."""


@dataclass(frozen=True, slots=True)
class SkipCycles:
    """Lets every controller manager and adapter miss a number of cycles in a row."""

    cycles: int

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> SkipCycles:
        """Return the fault of an entry."""
        return cls(entry.cycles or 1)

    def begin(self, plant: Plant) -> None:
        """Miss them."""
        for manager in plant.control.managers.values():
            manager.disturbances.skip_cycles(self.cycles)
        for server in plant.control.adapters.values():
            server.skip_cycles(self.cycles)

    def end(self, plant: Plant) -> None:
        """Nothing: a missed cycle stays missed."""


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield the loops; a cell that does not say how many misses it allows bears these few."""
    allowed = contract.kpis.missed_cycles
    entry = FaultEntry(kind="skip_cycles", target="", cycles=BEYOND + (allowed or 0))
    missed = BORNE if allowed is None else ends_in("missed_cycle", within_s=Bounds(contract).watched_s())
    yield fault_case(entry, contract, lambda step: missed)
