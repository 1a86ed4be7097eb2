"""A joint no longer follows its command."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import FaultCase, fault_case
from cellc.mock.faults.contents import driven_joints, first_joints
from cellc.mock.faults.off_track import ending_off_track
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Stick:
    """Holds a joint where it is."""

    joint: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Stick | None:
        """Return the fault of an entry; None where its target is no joint that moves."""
        return cls(entry.target) if entry.target in driven_joints(contract) else None

    def begin(self, plant: Plant) -> None:
        """Stick."""
        for server in plant.control.servers_of_joint(self.joint):
            server.disturbances.stick(self.joint)

    def end(self, plant: Plant) -> None:
        """Follow again."""
        for server in plant.control.servers_of_joint(self.joint):
            server.disturbances.clear(self.joint)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield one joint of every controller that takes goals."""
    for joint, controller in first_joints(contract).items():
        entry = FaultEntry(kind="stick", target=joint)
        yield fault_case(entry, contract, ending_off_track(Bounds(contract), controller))
