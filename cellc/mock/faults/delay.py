"""Joint states of a device arrive late."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import joints_of_device
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import joint_state_age_s
from cellc.mock.world.joint_states import JointStateHistory, LateArrival

TIMES_TOO_LATE = 3.0
"""A case delays by this multiple of the age that is allowed."""


@dataclass(frozen=True, slots=True)
class Delay:
    """Delays every broadcaster that reports a joint of the device."""

    joints: tuple[str, ...]
    delay_s: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Delay | None:
        """Return the fault of an entry; None where its target has no joints."""
        joints = joints_of_device(contract, entry.target)
        return cls(joints, entry.delay_s or 0.0) if joints else None

    def begin(self, plant: Plant) -> None:
        """Delay what is stamped from now on."""
        for history in self._histories(plant):
            history.late.append(LateArrival(plant.now_ns, None, round(self.delay_s * 1e9)))

    def end(self, plant: Plant) -> None:
        """Let what is stamped from now on arrive at once."""
        for history in self._histories(plant):
            history.late[-1] = replace(history.late[-1], until_ns=plant.now_ns)

    def _histories(self, plant: Plant) -> Iterator[JointStateHistory]:
        for history in plant.control.histories.values():
            if any(joint in history.names for joint in self.joints):
                yield history


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every device with joints."""
    for device in contract.devices:
        if joints_of_device(contract, device):
            delay_s = TIMES_TOO_LATE * joint_state_age_s(contract)
            entry = FaultEntry(kind="delay", target=device, delay_s=delay_s)
            yield fault_case(entry, contract, partial(_ending, Bounds(contract)))


def _ending(bounds: Bounds, step: CellStep) -> Ending:
    return ends_in("stale_state", within_s=bounds.joint_state_s()) if step.controllers else BORNE
