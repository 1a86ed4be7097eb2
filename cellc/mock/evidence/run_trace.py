"""What is kept of one rehearsal for its report, in memory that does not grow with its length."""

from __future__ import annotations

from typing import Literal

import numpy as np

from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import TRAJECTORIES
from cellc.mock.bus.stream import NEVER_NS
from cellc.mock.control import ControllerChanged, HardwareChanged, JointStateBlock, Recording
from cellc.mock.evidence.envelope import AgeBuilder, AgeTrace, Array, Envelope, EnvelopeBuilder
from cellc.mock.evidence.run_bag import TransformMessage
from cellc.mock.nodes.perception import ObjectPose
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import joint_state_age_s


@dataclass(frozen=True, slots=True)
class Claim:
    """A controller owned a command interface from one instant to another."""

    interface: str
    controller: str
    from_ns: int
    until_ns: int
    by_contract: bool


@dataclass(frozen=True, slots=True)
class StateChange:
    """A controller or hardware component was in a state from an instant on, or reported a stop while it stayed active.

    The reason is empty where it was asked.
    """

    stamp_ns: int
    kind: Literal["controller", "hardware component", "stop"]
    subject: str
    state: str
    reason: str


class ClaimBook:
    """Follows the owners of all command interfaces; looked at after every change of a controller."""

    def __init__(self, plant: Plant) -> None:
        """Bind the book to a plant."""
        self._plant = plant
        self._open: dict[str, tuple[str, int]] = {}
        self._closed: list[Claim] = []
        self._owners = _owners(plant.contract)

    def look(self, now_ns: int) -> None:
        """Note who owns what now."""
        present = {
            interface: controller.name
            for manager in self._plant.control.managers.values()
            for controller in manager.list_controllers()
            for interface in controller.claimed_interfaces
        }
        for interface, (owner, _) in list(self._open.items()):
            if present.get(interface) != owner:
                self._close(interface, now_ns)
        for interface, owner in present.items():
            self._open.setdefault(interface, (owner, now_ns))

    def claims(self, now_ns: int) -> tuple[Claim, ...]:
        """Close what is open and return everything, by interface and time."""
        for interface in list(self._open):
            self._close(interface, now_ns)
        return tuple(sorted(self._closed, key=lambda claim: (claim.interface, claim.from_ns)))

    def _close(self, interface: str, now_ns: int) -> None:
        owner, from_ns = self._open.pop(interface)
        by_contract = owner in self._owners.get(interface, ())
        self._closed.append(Claim(interface, owner, from_ns, now_ns, by_contract))


def _owners(contract: Contract) -> dict[str, set[str]]:
    """Return the controllers that may claim each interface: several where a switch is declared between them."""
    owners: dict[str, set[str]] = {}
    for manager in contract.managers.values():
        for name, controller in manager.controllers.items():
            for interface in controller.command_interfaces:
                owners.setdefault(interface, set()).add(name)
    return owners


@dataclass(frozen=True, slots=True)
class JointTrace:
    """Signals of one joint of a trajectory controller; each is an envelope of one signal.

    Attributes:
        unit: rad or m.
        command: commanded positions; None where the controller commands something else.
        worst_error: greatest magnitude of desired - actual.
    """

    joint: str
    controller: str
    unit: str
    desired: Envelope
    actual: Envelope
    command: Envelope | None
    error: Envelope
    worst_error: float


@dataclass(frozen=True, slots=True)
class StateTrace:
    """Measured positions of a joint that no trajectory controller drives: a gripper's, or one behind an adapter."""

    joint: str
    source: str
    unit: str
    state: Envelope


@dataclass(frozen=True, slots=True)
class TraceResult:
    """All that was kept of a run, to its end at ``ended_ns``."""

    joints: tuple[JointTrace, ...]
    states: tuple[StateTrace, ...]
    ages: tuple[AgeTrace, ...]
    claims: tuple[Claim, ...]
    changes: tuple[StateChange, ...]
    missed_cycles: int
    ended_ns: int


class RunTrace:
    """Collects envelopes, ages, claims and changes of a plant."""

    def __init__(self, plant: Plant) -> None:
        """Bind the trace to a plant in which nothing has run yet."""
        self._plant = plant
        self._book = ClaimBook(plant)
        self._changes: list[StateChange] = []
        self._signals: dict[tuple[str, str], EnvelopeBuilder] = {}
        self._states: dict[tuple[str, str], EnvelopeBuilder] = {}
        self._ages: dict[str, AgeBuilder] = {}
        self._claims: tuple[Claim, ...] = ()
        self._ended_ns = 0
        self._missed = 0
        controllers = [each for manager in plant.contract.managers.values() for each in manager.controllers.values()]
        self._followed = {joint for each in controllers if each.behavior in TRAJECTORIES for joint in each.joints}
        self._commanded = {interface for each in controllers for interface in each.command_interfaces}

    def joint_states(self, manager: str, broadcaster: str, block: JointStateBlock) -> None:
        """Take joint states as the task receives them."""
        history = self._plant.control.histories[(manager, broadcaster)]
        feed = next((feed for feed in self._plant.task.feeds if feed.history is history), None)
        if feed is not None:
            self._age_states(broadcaster, block, feed.last_arrivals(len(block.stamps_ns)).tolist())
        for each in self._ages.values():
            each.advance(int(block.stamps_ns[0]))
        for name in history.names:
            if name not in self._followed:
                builder = self._states.setdefault((broadcaster, name), EnvelopeBuilder(1))
                builder.add(block.stamps_ns, block.positions[:, [block.names.index(name)]])

    def _age_states(self, broadcaster: str, block: JointStateBlock, arrivals: list[int]) -> None:
        ages = self._age(f"joint states of {broadcaster}", joint_state_age_s(self._plant.contract))
        clock = self._plant.clocks.of(broadcaster)
        for taken_ns, arrived_ns in zip(block.stamps_ns.tolist(), arrivals, strict=True):
            if arrived_ns < NEVER_NS:
                ages.sent(arrived_ns, clock.read(taken_ns))

    def transforms(self, message: TransformMessage) -> None:
        """Take moving edges as a listener receives them."""
        ages = self._age("transforms of moving links", None)
        ages.sent(message.published_ns, message.transforms[0].stamp_ns)

    def observation(self, frame: str, pose: ObjectPose) -> None:
        """Take an observation that has reached the task."""
        max_age_s = self._plant.task.observations[frame].max_age_s
        ages = self._age(f"observations of {frame}", max_age_s)
        ages.sent(self._plant.now_ns, pose.stamp_ns)
        ages.advance(self._plant.now_ns)

    def controller_states(self, controller: str, recording: Recording) -> None:
        """Take states of a trajectory controller."""
        for column, joint in enumerate(recording.joints):
            signals = (recording.desired, recording.actual, recording.command, recording.error)
            values = np.stack([_column(signal, column) for signal in signals], axis=1)
            builder = self._signals.setdefault((controller, joint), EnvelopeBuilder(len(signals)))
            builder.add(recording.stamps_ns, values)

    def changed(self, event: ControllerChanged | HardwareChanged) -> None:
        """Take a change of a controller or of a hardware component."""
        if isinstance(event, ControllerChanged):
            change = StateChange(event.stamp_ns, "controller", event.controller, event.state, event.reason)
        else:
            change = StateChange(event.stamp_ns, "hardware component", event.component, event.state, event.reason)
        self._changes.append(change)
        self._book.look(event.stamp_ns)

    def end(self, now_ns: int) -> None:
        """Close what is open."""
        for ages in self._ages.values():
            ages.advance(now_ns)
        self._missed = sum(history.missed_until(now_ns) for history in self._plant.control.histories.values())
        self._claims = self._book.claims(now_ns)
        self._ended_ns = now_ns
        reported = (
            StateChange(stop.stamp_ns, "stop", stop.component, stop.state, "") for stop in self._plant.stops.changes
        )
        self._changes = sorted([*self._changes, *reported], key=lambda change: change.stamp_ns)

    def result(self) -> TraceResult:
        """Return everything; the run must have ended."""
        return TraceResult(
            joints=tuple(self._joint(*key, builder.envelope()) for key, builder in self._signals.items()),
            states=tuple(
                StateTrace(joint, source, self._unit(joint), builder.envelope())
                for (source, joint), builder in self._states.items()
            ),
            ages=tuple(ages.trace() for ages in self._ages.values()),
            claims=self._claims,
            changes=tuple(self._changes),
            missed_cycles=self._missed,
            ended_ns=self._ended_ns,
        )

    def _joint(self, controller: str, joint: str, envelope: Envelope) -> JointTrace:
        desired, actual, command, error = (
            Envelope(envelope.width_ns, envelope.starts_ns, envelope.lowest[:, [index]], envelope.highest[:, [index]])
            for index in range(4)
        )
        extremes = np.abs(np.concatenate([error.lowest, error.highest]))
        worst = float(np.nanmax(extremes)) if np.isfinite(extremes).any() else 0.0
        positions = f"{joint}/position" in self._commanded and np.isfinite(command.lowest).any()
        shown = command if positions else None
        return JointTrace(joint, controller, self._unit(joint), desired, actual, shown, error, worst)

    def _unit(self, joint: str) -> str:
        links = self._plant.robot_state_publisher.links.joints.values()
        return "m" if any(each.name == joint and each.slides for each in links) else "rad"

    def _age(self, source: str, max_age_s: float | None) -> AgeBuilder:
        if source not in self._ages:
            task = self._plant.task.name
            self._ages[source] = AgeBuilder(source, task, self._plant.clocks.of(task), max_age_s)
        return self._ages[source]


def _column(signal: Array, column: int) -> Array:
    """Return a column; NaN where the controller commands fewer joints than it measures."""
    return signal[:, column] if column < signal.shape[1] else np.full(len(signal), np.nan)
