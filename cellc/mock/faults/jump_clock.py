"""A clock jumps, forwards or back: ages and lookups of whoever reads it are wrong until all samples are new."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.plant import Plant

DEFAULT_DOMAIN = "ros"
JUMPS_S = (1.0, -1.0)
"""Cases jump by more than any age that is allowed."""


@dataclass(frozen=True, slots=True)
class JumpClock:
    """Sets a clock, or all clocks of a domain."""

    clock: str
    jump_s: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> JumpClock | None:
        """Return the fault of an entry; None where its target is neither a clock nor a domain."""
        domains = {DEFAULT_DOMAIN, *(clock.domain for clock in contract.clocks.values())}
        return cls(entry.target, entry.jump_s or 0.0) if entry.target in domains | contract.clocks.keys() else None

    def begin(self, plant: Plant) -> None:
        """Jump."""
        plant.clocks.jump(self.clock, round(self.jump_s * 1e9))

    def end(self, plant: Plant) -> None:
        """Jump back."""
        plant.clocks.jump(self.clock, -round(self.jump_s * 1e9))


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every clock, once forwards and once back."""
    for clock in contract.clocks or (DEFAULT_DOMAIN,):
        for jump_s in JUMPS_S:
            entry = FaultEntry(kind="jump_clock", target=clock, jump_s=jump_s)
            yield fault_case(entry, contract, partial(_ending, Bounds(contract)))


def _ending(bounds: Bounds, step: CellStep) -> Ending:
    """Whatever is stale or cannot be looked up afterwards ends the step; new samples let it go on."""
    within_s = max([bounds.joint_state_s(), *(map(bounds.observation_s, bounds.dynamic_frames()))])
    if step.kind == "move" and step.frames:
        return ends_in("stale_state", "tf_failure", SUCCEEDED, within_s=within_s + bounds.asked_s())
    return ends_in("stale_state", SUCCEEDED, within_s=within_s)
