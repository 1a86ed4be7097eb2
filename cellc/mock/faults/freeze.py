"""A device repeats its last sample with its old stamp: a camera its image, an arm its joint state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import joints_of_device
from cellc.mock.faults.observed import cameras, ending_unobserved
from cellc.mock.faults.silent_states import catch_up, delay, of_joints
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Freeze:
    """Freezes the stream of a device; a message that comes again with its old stamp tells nothing new."""

    device: str
    joints: tuple[str, ...]

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Freeze | None:
        """Return the fault of an entry; None where its target is neither a camera nor has joints."""
        joints = joints_of_device(contract, entry.target)
        return cls(entry.target, joints) if joints or entry.target in cameras(contract) else None

    def begin(self, plant: Plant) -> None:
        """Repeat the last sample from now on."""
        if self.device in plant.cameras:
            plant.cameras[self.device].frozen = True
        for history in of_joints(plant, self.joints):
            delay(history, plant.now_ns)

    def end(self, plant: Plant) -> None:
        """Stream again."""
        if self.device in plant.cameras:
            plant.cameras[self.device].frozen = False
        for history in of_joints(plant, self.joints):
            catch_up(history, plant.now_ns)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every camera, and every device with joints."""
    bounds = Bounds(contract)
    for device, frames in cameras(contract).items():
        yield fault_case(FaultEntry(kind="freeze", target=device), contract, ending_unobserved(bounds, frames))
    for device in contract.devices:
        if joints_of_device(contract, device):
            yield fault_case(FaultEntry(kind="freeze", target=device), contract, partial(_stateless, bounds))


def _stateless(bounds: Bounds, step: CellStep) -> Ending:
    return ends_in("stale_state", within_s=bounds.joint_state_s()) if step.controllers else BORNE
