"""A joint follows its command no faster than it can."""

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

SHARE_OF_LIMIT = 0.01
"""A case lets a joint move at this share of its limit."""
DEFAULT_VELOCITY = 0.01
"""rad/s or m/s, where the contract states no limit."""


@dataclass(frozen=True, slots=True)
class Slow:
    """Bounds the speed of a joint, rad/s or m/s."""

    joint: str
    velocity: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Slow | None:
        """Return the fault of an entry; None where its target is no joint that moves."""
        if entry.target not in driven_joints(contract):
            return None
        return cls(entry.target, DEFAULT_VELOCITY if entry.velocity is None else entry.velocity)

    def begin(self, plant: Plant) -> None:
        """Slow down."""
        for server in plant.control.servers_of_joint(self.joint):
            server.disturbances.slow(self.joint, self.velocity)

    def end(self, plant: Plant) -> None:
        """Follow as fast as commanded."""
        for server in plant.control.servers_of_joint(self.joint):
            server.disturbances.clear(self.joint)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield one joint of every controller that takes goals."""
    for joint, controller in first_joints(contract).items():
        limits = contract.joint_limits.get(joint)
        velocity = DEFAULT_VELOCITY if limits is None else SHARE_OF_LIMIT * limits.velocity
        entry = FaultEntry(kind="slow", target=joint, velocity=velocity)
        yield fault_case(entry, contract, ending_off_track(Bounds(contract), controller))
