"""The client cancels the goal that is executing, or the first that executes after."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.case import BORNE, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep, cell_steps
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import cancel_bound_s

KINDS = ("move", "grip")
"""Steps that send goals."""


@dataclass(frozen=True, slots=True)
class Cancel:
    """Asks the task to cancel a goal of one kind of step."""

    kind: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Cancel | None:
        """Return the fault of an entry; None where its target is no kind of step that sends goals."""
        return cls(entry.target) if entry.target in KINDS else None

    def begin(self, plant: Plant) -> None:
        """Ask."""
        plant.requests.cancel.add(self.kind)
        plant.requests.changed.fire(plant.now_ns)

    def end(self, plant: Plant) -> None:
        """Take the request back where no goal has been cancelled yet."""
        plant.requests.cancel.discard(self.kind)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every kind of step that sends goals in this cell; the bound is that of the cancel."""
    kinds = {step.kind for step in cell_steps(contract) if step.controllers}
    for kind in KINDS:
        if kind in kinds:
            entry = FaultEntry(kind="cancel", target=kind)
            yield fault_case(entry, contract, partial(_ending, kind, cancel_bound_s(contract)), at_once=True)


def _ending(kind: str, within_s: float, step: CellStep) -> Ending:
    return ends_in("cancelled", within_s=within_s) if step.kind == kind and step.controllers else BORNE
