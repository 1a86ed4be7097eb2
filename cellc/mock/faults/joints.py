"""Joints that do not follow their commands, speed that is scaled, and update cycles that are missed."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome, Behavior
from cellc.mock.control import JointFault
from cellc.mock.faults.cases import (
    BORNE,
    CellStep,
    Ending,
    FaultCase,
    controllers,
    driven_joints,
    ends_in,
    fault_case,
    first_joints,
)
from cellc.mock.faults.endings import Bounds, off_track
from cellc.mock.faults.ports import FaultPorts

SHARE_OF_LIMIT = 0.01
"""A case lets a joint move at this share of its limit."""
DEFAULT_VELOCITY = 0.01
"""rad/s or m/s, where the contract states no limit."""
SHARE_OF_RANGE = 0.1
"""A case displaces a joint by this share of its range, and by no more than ``MOST``."""
MOST = 0.5
"""rad or m."""
_STUCK = JointFault(stuck=True)
BEYOND = 5
"""Cycles that a case misses beyond those that are allowed."""


@dataclass(frozen=True, slots=True)
class Stick:
    """A joint no longer follows its command: it stays where it is."""

    kind: ClassVar[FaultKind] = FaultKind.STICK
    joint: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Stick | None:
        """Return the fault of an entry; None where its target is no joint that moves."""
        return cls(entry.target) if entry.target in driven_joints(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield one joint of every controller that takes goals."""
        for joint, controller in first_joints(contract).items():
            entry = FaultEntry(kind=cls.kind, target=joint)
            yield fault_case(entry, contract, off_track(Bounds(contract), controller))

    def begin(self, ports: FaultPorts) -> None:
        """Stick."""
        ports.hardware.disturb(self.joint, _STUCK)

    def end(self, ports: FaultPorts) -> None:
        """Follow again."""
        ports.hardware.restore(self.joint, _STUCK)


@dataclass(frozen=True, slots=True)
class Slow:
    """A joint moves more slowly than it is commanded: its speed is bounded, rad/s or m/s."""

    kind: ClassVar[FaultKind] = FaultKind.SLOW
    joint: str
    velocity: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Slow | None:
        """Return the fault of an entry; None where its target is no joint that moves."""
        if entry.target not in driven_joints(contract):
            return None
        return cls(entry.target, DEFAULT_VELOCITY if entry.velocity is None else entry.velocity)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield one joint of every controller that takes goals."""
        for joint, controller in first_joints(contract).items():
            limits = contract.joint_limits.get(joint)
            velocity = DEFAULT_VELOCITY if limits is None else SHARE_OF_LIMIT * limits.velocity
            entry = FaultEntry(kind=cls.kind, target=joint, velocity=velocity)
            yield fault_case(entry, contract, off_track(Bounds(contract), controller))

    def begin(self, ports: FaultPorts) -> None:
        """Slow down."""
        ports.hardware.disturb(self.joint, JointFault(max_velocity=self.velocity))

    def end(self, ports: FaultPorts) -> None:
        """Follow as fast as commanded."""
        ports.hardware.restore(self.joint, JointFault(max_velocity=self.velocity))


@dataclass(frozen=True, slots=True)
class Displace:
    """A joint is offset from its command by rad or m, as after a push or a slipped gear."""

    kind: ClassVar[FaultKind] = FaultKind.DISPLACE
    joint: str
    displacement: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Displace | None:
        """Return the fault of an entry; None where its target is no joint that moves."""
        return cls(entry.target, entry.displacement or 0.0) if entry.target in driven_joints(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield one joint of every controller that takes goals.

        A plan may start beyond a limit or in a collision; an adapter refuses one that starts elsewhere.
        """
        for joint, controller in first_joints(contract).items():
            entry = FaultEntry(kind=cls.kind, target=joint, displacement=_displacement(contract, joint))
            refused = (AttemptOutcome.GOAL_REJECTION,) if controller in contract.adapters else ()
            more = (AttemptOutcome.PLANNING_FAILURE, *refused)
            yield fault_case(entry, contract, off_track(Bounds(contract), controller, *more))

    def begin(self, ports: FaultPorts) -> None:
        """Displace."""
        ports.hardware.disturb(self.joint, JointFault(offset=self.displacement))

    def end(self, ports: FaultPorts) -> None:
        """Stand at the command again."""
        ports.hardware.restore(self.joint, JointFault(offset=self.displacement))


@dataclass(frozen=True, slots=True)
class ScaleSpeed:
    """A device scales its speed, 0 to 1: a slider, a safety function, or a program that was stopped on its pendant.

    With a factor of 0 a controller that follows the scaling neither progresses nor aborts; the client bounds the goal.
    """

    kind: ClassVar[FaultKind] = FaultKind.SCALE_SPEED
    interface: str
    component: str
    factor: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> ScaleSpeed | None:
        """Return the fault of an entry; None where its target does not scale its speed."""
        device = contract.devices.get(entry.target)
        if device is None or device.speed_scaling_interface is None or device.hardware_component is None:
            return None
        return cls(device.speed_scaling_interface, device.hardware_component, entry.factor or 0.0)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device that scales its speed, at a standstill."""
        for name, device in contract.devices.items():
            if device.speed_scaling_interface is not None:
                entry = FaultEntry(kind=cls.kind, target=name, factor=0.0)
                yield fault_case(entry, contract, partial(_scaled, Bounds(contract), name))

    def begin(self, ports: FaultPorts) -> None:
        """Scale."""
        ports.hardware.scale_speed(self.component, self.interface, self.factor)

    def end(self, ports: FaultPorts) -> None:
        """Go on at full speed."""
        ports.hardware.scale_speed(self.component, self.interface, 1.0)


@dataclass(frozen=True, slots=True)
class SkipCycles:
    """Lets every controller manager and adapter miss a number of cycles in a row."""

    kind: ClassVar[FaultKind] = FaultKind.SKIP_CYCLES
    cycles: int

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> SkipCycles:
        """Return the fault of an entry."""
        return cls(entry.cycles or 1)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield the loops; a cell that does not say how many misses it allows bears these few.

        The watchdog of an adapter stops its device where they are longer than it waits.
        """
        allowed, within_s = contract.kpis.missed_cycles, Bounds(contract).watched_s()
        cycles = BEYOND + (allowed or 0)
        entry = FaultEntry(kind=cls.kind, target="", cycles=cycles)
        adapters = contract.adapters.values()
        watched = any((cycles + 1) * adapter.command_period_s > adapter.command_timeout_s for adapter in adapters)
        stops = (AttemptOutcome.PROTECTIVE_STOP,) if watched else ()
        missed = BORNE if allowed is None else ends_in(AttemptOutcome.MISSED_CYCLE, *stops, within_s=within_s)
        yield fault_case(entry, contract, lambda step: missed)

    def begin(self, ports: FaultPorts) -> None:
        """Miss them."""
        ports.hardware.skip_cycles(self.cycles)

    def end(self, ports: FaultPorts) -> None:
        """Nothing: a missed cycle stays missed."""


def _displacement(contract: Contract, joint: str) -> float:
    limits = contract.joint_limits.get(joint)
    if limits is None or limits.lower is None or limits.upper is None:
        return MOST
    return min(MOST, SHARE_OF_RANGE * (limits.upper - limits.lower))


_SCALED = (Behavior.SCALED_JOINT_TRAJECTORY, Behavior.JOINT_TRAJECTORY)


def _scaled(bounds: Bounds, device: str, step: CellStep) -> Ending:
    """A controller that follows the scaling stops; where the arm is already at its goal, that is tolerated.

    The upstream plugin follows it by a parameter from Kilted on, which is no part of the contract.
    """
    used = [facts for name, facts in controllers(bounds.contract).items() if name in step.controllers]
    if not any(facts.device == device and facts.behavior in _SCALED for facts in used):
        return BORNE
    return ends_in(AttemptOutcome.TIMEOUT, AttemptOutcome.SUCCEEDED, within_s=bounds.execution_s(step))
