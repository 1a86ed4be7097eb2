"""A joint stands beside its command, as after a push or a slipped gear."""

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

SHARE_OF_RANGE = 0.1
"""A case displaces a joint by this share of its range, and by no more than ``MOST``."""
MOST = 0.5
"""rad or m."""


@dataclass(frozen=True, slots=True)
class Displace:
    """Puts a joint beside its command, by rad or m."""

    joint: str
    displacement: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Displace | None:
        """Return the fault of an entry; None where its target is no joint that moves."""
        return cls(entry.target, entry.displacement or 0.0) if entry.target in driven_joints(contract) else None

    def begin(self, plant: Plant) -> None:
        """Displace."""
        for server in plant.control.servers_of_joint(self.joint):
            server.disturbances.offset(self.joint, self.displacement)

    def end(self, plant: Plant) -> None:
        """Stand at the command again."""
        for server in plant.control.servers_of_joint(self.joint):
            server.disturbances.clear(self.joint)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield one joint of every controller that takes goals; a plan may start beyond a limit or in a collision."""
    for joint, controller in first_joints(contract).items():
        entry = FaultEntry(kind="displace", target=joint, displacement=_displacement(contract, joint))
        yield fault_case(entry, contract, ending_off_track(Bounds(contract), controller, "planning_failure"))


def _displacement(contract: Contract, joint: str) -> float:
    limits = contract.joint_limits.get(joint)
    if limits is None or limits.lower is None or limits.upper is None:
        return MOST
    return min(MOST, SHARE_OF_RANGE * (limits.upper - limits.lower))
