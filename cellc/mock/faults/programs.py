"""Robots that follow no set points for a while, joints that are jogged meanwhile, and brakes that are closed.

A program on the robot stops and starts; where set points pass through none, its own fault comes and goes.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar, TypeVar

from cellc.contract.bring_up import WATCH_WITHIN_S
from cellc.contract.contract import Contract
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome, Moment, Need, Unmet
from cellc.mock.effects import JOGGED
from cellc.mock.errors import FaultMissedError
from cellc.mock.faults.cases import CellStep, Ending, FaultCase, ends_in, fault_case, joints_of_device, stop_of
from cellc.mock.faults.endings import Bounds, stopped_in, unfollowed
from cellc.mock.faults.ports import FaultPorts

JOG_AFTER_NS = 100_000_000
START_AFTER_NS = 500_000_000


def claim_needs(contract: Contract, *otherwise: Unmet) -> dict[str, tuple[Need, ...]]:
    """Return the devices with hardware whose claim needs something, of which one of these comes without it."""
    by_device: dict[str, tuple[Need, ...]] = {}
    for name, device in contract.devices.items():
        claim = device.effects.get(Moment.CLAIM)
        needs = () if claim is None else tuple(need for need, unmet in claim.needs.items() if unmet in otherwise)
        if needs and device.hardware_component is not None:
            by_device[name] = needs
    return by_device


def _kept(contract: Contract, device: str) -> Need | None:
    """Return what a device lacks when it keeps old set points: a running program, or what its claim names first."""
    needs = claim_needs(contract, Unmet.KEEPS_SET_POINTS).get(device, ())
    return Need.PROGRAM_RUNNING if Need.PROGRAM_RUNNING in needs else next(iter(needs), None)


_ProgramFault = TypeVar("_ProgramFault", bound="_Program")


@dataclass(frozen=True, slots=True)
class _Program:
    """What stops and starts the program of a robot."""

    device: str
    need: Need

    @classmethod
    def of(cls: type[_ProgramFault], entry: FaultEntry, contract: Contract) -> _ProgramFault | None:
        """Return the fault of an entry; None where the set points of its target pass through no program."""
        need = _kept(contract, entry.target)
        return None if need is None else cls(entry.target, need)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield nothing: every stop begins the case of stale set points too, and a start ends what it began."""
        yield from ()


class ProgramStop(_Program):
    """The program of a robot stops: the robot stops, reports it, and follows no set points."""

    kind: ClassVar[FaultKind] = FaultKind.PROGRAM_STOP

    def begin(self, ports: FaultPorts) -> None:
        """Stop."""
        ports.effects.unmet(self.device, self.need)

    def end(self, ports: FaultPorts) -> None:
        """Start again."""
        ports.effects.met(self.device, self.need)


class ProgramPause(_Program):
    """The program of a robot pauses: the robot stops, and its claims and goals stay alive until it goes on."""

    kind: ClassVar[FaultKind] = FaultKind.PROGRAM_PAUSE

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> ProgramPause | None:
        """Return the fault of an entry; None where nothing of its target pauses."""
        pausing = claim_needs(contract, Unmet.KEEPS_SET_POINTS).get(entry.target, ())
        return cls(entry.target, Need.NOT_PAUSED) if Need.NOT_PAUSED in pausing else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device whose program pauses."""
        for device in claim_needs(contract, Unmet.KEEPS_SET_POINTS):
            entry, bounds = FaultEntry(kind=cls.kind, target=device), Bounds(contract)
            if cls.of(entry, contract) is not None:
                heard = Need.NOT_PAUSED in contract.devices[device].reports
                ending = partial(_given_up, bounds) if heard else unfollowed(bounds, device)
                yield fault_case(entry, contract, ending)

    def begin(self, ports: FaultPorts) -> None:
        """Pause."""
        ports.effects.unmet(self.device, self.need)

    def end(self, ports: FaultPorts) -> None:
        """Go on."""
        ports.effects.met(self.device, self.need)


class ProgramStart(_Program):
    """Somebody starts the program of a robot, which follows set points from then on."""

    kind: ClassVar[FaultKind] = FaultKind.PROGRAM_START

    def begin(self, ports: FaultPorts) -> None:
        """Start."""
        if self.device not in ports.effects.silenced:
            raise FaultMissedError(f"the program of {self.device} is already running")
        ports.effects.met(self.device, self.need)

    def end(self, ports: FaultPorts) -> None:
        """Stop again."""
        ports.effects.unmet(self.device, self.need)


@dataclass(frozen=True, slots=True)
class Jog:
    """Somebody moves a joint by the pendant, rad or m, which a robot lets them do while its program is stopped."""

    kind: ClassVar[FaultKind] = FaultKind.JOG
    device: str
    joint: str
    distance: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Jog | None:
        """Return the fault of an entry; None where its target is no joint that a pendant moves."""
        for device in claim_needs(contract, Unmet.KEEPS_SET_POINTS):
            if entry.target in joints_of_device(contract, device):
                return cls(device, entry.target, JOGGED if entry.displacement is None else entry.displacement)
        return None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield nothing: a robot whose program runs cannot be jogged."""
        yield from ()

    def begin(self, ports: FaultPorts) -> None:
        """Jog."""
        if self.device not in ports.effects.silenced:
            raise FaultMissedError(f"the program of {self.device} is running, so its pendant moves nothing")
        ports.effects.jog(self.device, self.joint, self.distance)

    def end(self, ports: FaultPorts) -> None:
        """Nothing: the joint stays where it was moved to."""


@dataclass(frozen=True, slots=True)
class StaleSetPoints:
    """The program of a robot stops, somebody jogs its first joint, and starts the program again.

    Where a controller keeps its claim meanwhile, the arm jumps to where it was before.
    """

    kind: ClassVar[FaultKind] = FaultKind.STALE_SET_POINTS
    device: str
    joint: str
    need: Need

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> StaleSetPoints | None:
        """Return the fault of an entry; None where the set points of its target pass through no program."""
        joints, need = joints_of_device(contract, entry.target), _kept(contract, entry.target)
        return None if need is None or not joints else cls(entry.target, joints[0], need)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device that keeps set points over a stop of its program and that something moves."""
        for device in claim_needs(contract, Unmet.KEEPS_SET_POINTS):
            entry = FaultEntry(kind=cls.kind, target=device)
            if cls.of(entry, contract) is not None:
                yield fault_case(entry, contract, partial(_given_up, Bounds(contract)))

    def begin(self, ports: FaultPorts) -> None:
        """Stop the program, and let the rest follow."""
        ports.effects.unmet(self.device, self.need)
        now_ns = ports.schedule.now_ns
        ports.schedule.at(now_ns + JOG_AFTER_NS, partial(ports.effects.jog, self.device, self.joint, JOGGED))
        start = partial(ports.effects.met, self.device, self.need)
        ports.schedule.at(now_ns + START_AFTER_NS, start)

    def end(self, ports: FaultPorts) -> None:
        """Nothing: it is over by itself."""


class BrakesClosed:
    """The brakes of a device are closed: it stops where it was claimed, and a claim ends as it would on the robot."""

    kind: ClassVar[FaultKind] = FaultKind.BRAKES_CLOSED

    def __init__(self, device: str, stop: str, *, programmed: bool) -> None:
        """Bind the fault to a device; ``programmed`` where its set points pass through a program, which stops too.

        Args:
            stop: the state in which a device without a program stops.
        """
        self._device = device
        self._stop = stop
        self._needs = (Need.PROGRAM_RUNNING, Need.BRAKES_OPEN) if programmed else (Need.BRAKES_OPEN,)
        self._stops = not programmed
        self._stopped = False

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> BrakesClosed | None:
        """Return the fault of an entry; None where a claim of its target needs no open brakes."""
        stop = (
            None
            if entry.target not in _braked(contract)
            else stop_of(contract, entry.target, FaultKind.PROTECTIVE_STOP)
        )
        if stop is None:
            return None
        return cls(entry.target, stop, programmed=entry.target in claim_needs(contract, Unmet.KEEPS_SET_POINTS))

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device whose claim needs open brakes."""
        for device in _braked(contract):
            entry, bounds = FaultEntry(kind=cls.kind, target=device), Bounds(contract)
            if device in claim_needs(contract, Unmet.KEEPS_SET_POINTS):
                yield fault_case(entry, contract, partial(_given_up, bounds))
            else:
                state = stop_of(contract, device, FaultKind.PROTECTIVE_STOP)
                if state is not None:
                    yield fault_case(entry, contract, stopped_in(bounds, device, state), hits_running_step=True)

    def begin(self, ports: FaultPorts) -> None:
        """Close them."""
        claimed = ports.effects.is_claimed(self._device)
        for need in self._needs:
            ports.effects.unmet(self._device, need)
        self._stopped = claimed and self._stops
        if self._stopped:
            ports.effects.stop(self._device, self._stop)

    def end(self, ports: FaultPorts) -> None:
        """Open them, and start the program; the device stays stopped until that is acknowledged."""
        for need in self._needs:
            ports.effects.met(self._device, need)
        if self._stopped:
            ports.effects.end_stop(self._device, self._stop)


def _braked(contract: Contract) -> tuple[str, ...]:
    return tuple(device for device, needs in claim_needs(contract, *Unmet).items() if Need.BRAKES_OPEN in needs)


def _given_up(bounds: Bounds, step: CellStep) -> Ending:
    """Every step ends as soon as the claim is given up; one that asks for nothing may be over before."""
    within_s = WATCH_WITHIN_S + bounds.watched_s()
    quick = () if step.controllers else (AttemptOutcome.SUCCEEDED,)
    return ends_in(AttemptOutcome.CLAIM_FAILURE, *quick, within_s=within_s)
