"""What becomes of a cell in which a device has stopped: whatever runs ends, whichever device it moves."""

from __future__ import annotations

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import FaultCase, ends_in, fault_case
from cellc.vocabulary import FaultKind


def stopping_case(kind: FaultKind, device: str, outcome: str, contract: Contract, after_s: float = 0.0) -> FaultCase:
    """Return the case of a device that stops ``after_s`` after the fault began."""
    ending = ends_in(outcome, within_s=after_s + Bounds(contract).hold_s())
    return fault_case(FaultEntry(kind=kind, target=device), contract, lambda step: ending, at_once=True)
