"""What a bag measures of a cell: figures that its spec states or assumes, each with its source and number of values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from cellc.contract.contract import Contract
from cellc.contract.devices import ContractGripper
from cellc.mock.report_page.html import seconds, small
from cellc.mock.task.bounds import joint_state_age_s
from cellc.tools.attempt.follow import SUCCEEDED, Followed
from cellc.tools.attempt.heard import ControllerSample, Edges, Heard, JointSample, ObservedPose, Vector
from cellc.tools.attempt.motion import MOVED, STANDSTILL
from cellc.tools.attempt.record import JOINT
from cellc.tools.attempt.topics import Sources

_MOST = 4096
_MOST_STREAMS = 200
_NO_STATES = "states of the controller, `controller_state`"


@dataclass(frozen=True, slots=True)
class Measure:
    """One figure of a bag.

    Attributes:
        of: what was measured: a controller, a topic or a gripper.
        median, worst: None where the bag does not show it.
        count: number of values.
        source: what it was measured from, or, where there is no value, what would have to be recorded.
        stated: of the contract; empty where it states nothing.
        spec: key of the spec that the figure is for.
    """

    name: str
    of: str
    unit: str
    median: float | None
    worst: float | None
    count: int
    source: str
    stated: str
    spec: str


@dataclass(slots=True)
class Spread:
    """Count, extremes and median of values in bounded memory; beyond 4096 every second, fourth, … one is kept."""

    count: int = 0
    least: float = float("inf")
    most: float = float("-inf")
    _kept: list[float] = field(default_factory=list)
    _stride: int = 1

    def add(self, value: float) -> None:
        """Take a value; what is no number counts for nothing."""
        if value != value:
            return
        if self.count % self._stride == 0:
            self._kept.append(value)
            if len(self._kept) > _MOST:
                self._kept = self._kept[::2]
                self._stride *= 2
        self.count += 1
        self.least = min(self.least, value)
        self.most = max(self.most, value)

    @property
    def median(self) -> float:
        """The middle one of the values; that of two which is larger."""
        return sorted(self._kept)[len(self._kept) // 2]


@dataclass(slots=True)
class _Stream:
    """Stamps of one topic: how far apart, and how old at arrival."""

    periods: Spread = field(default_factory=Spread)
    ages: Spread = field(default_factory=Spread)
    stamp_ns: int | None = None

    def take(self, log_ns: int, stamp_ns: int) -> None:
        """Take a message; a stamp that is not later than the one before is no period."""
        if self.stamp_ns is not None and stamp_ns > self.stamp_ns:
            self.periods.add((stamp_ns - self.stamp_ns) / 1e9)
        self.stamp_ns = stamp_ns
        self.ages.add((log_ns - stamp_ns) / 1e9)


@dataclass(slots=True)
class _Controller:
    """States of one controller: its error, and how long joints move on after the reference has ended."""

    errors: Spread = field(default_factory=Spread)
    settling: Spread = field(default_factory=Spread)
    last: ControllerSample | None = None
    ended_ns: int | None = None

    def take(self, sample: ControllerSample) -> None:
        """Take a state."""
        if len(sample.error):
            self.errors.add(float(np.abs(sample.error).max()))
        before, self.last = self.last, sample
        if before is None or sample.stamp_ns <= before.stamp_ns:
            return
        if _farthest(sample.reference, before.reference) > MOVED:
            self.ended_ns = sample.stamp_ns
        elif self.ended_ns is not None:
            period_s = (sample.stamp_ns - before.stamp_ns) / 1e9
            if _farthest(sample.feedback, before.feedback) / period_s <= STANDSTILL:
                self.settling.add(max(0, before.stamp_ns - self.ended_ns) / 1e9)
                self.ended_ns = None


def _farthest(one: Vector, other: Vector) -> float:
    return float(np.abs(one - other).max()) if len(one) and one.shape == other.shape else 0.0


class MeasureBuilder:
    """Takes the messages of a bag in the order of their arrival."""

    def __init__(self, contract: Contract, sources: Sources, tolerances: Mapping[str, float]) -> None:
        """Begin with nothing.

        Args:
            tolerances: path tolerance of each joint that has one, rad or m.
        """
        self._contract = contract
        self._sources = sources
        self._tolerances = tolerances
        self._streams: dict[str, _Stream] = {}
        self._controllers = {name: _Controller() for name in sources.states.values()}

    def take(self, log_ns: int, topic: str, heard: Heard) -> None:
        """Take a message."""
        if isinstance(heard, ControllerSample) and topic in self._sources.states:
            self._controllers[self._sources.states[topic]].take(heard)
        if isinstance(heard, (ControllerSample, JointSample)) or (
            isinstance(heard, ObservedPose) and topic in self._sources.observations
        ):
            self._stream(log_ns, topic, heard.stamp_ns)
        elif isinstance(heard, Edges) and topic == "/tf" and heard.edges:
            self._stream(log_ns, topic, max(ns for ns, _ in heard.edges))

    def measures(self, followed: Followed) -> tuple[Measure, ...]:
        """Return what was measured; what the bag does not show has no value."""
        return (
            *self._of_controllers(),
            *(each for topic, stream in self._streams.items() for each in self._of_stream(topic, stream)),
            *self._of_grippers(followed),
        )

    def _stream(self, log_ns: int, topic: str, stamp_ns: int) -> None:
        if topic in self._streams or len(self._streams) < _MOST_STREAMS:
            self._streams.setdefault(topic, _Stream()).take(log_ns, stamp_ns)

    def _of_controllers(self) -> Iterator[Measure]:
        joints = {each.controller: each.joints for each in self._sources.actions.values()}
        for name, each in self._controllers.items():
            bounds = [self._tolerances[joint] for joint in joints.get(name, ()) if joint in self._tolerances]
            stated = f"path tolerance {small(min(bounds), JOINT)}" if bounds else ""
            key = f"path tolerance of {name}"
            yield _measure("following error", name, JOINT, each.errors, _NO_STATES, stated, key)
            yield _measure("settling time", name, "s", each.settling, _NO_STATES, "", f"goal time of {name}")

    def _of_stream(self, topic: str, stream: _Stream) -> Iterator[Measure]:
        facts = self._contract.interfaces.get(topic)
        rate = "" if facts is None or facts.rate_hz is None else f"{facts.rate_hz:g} Hz"
        periods, source = stream.periods, f"stamps of {topic}"
        if periods.count:
            figures = 1.0 / periods.median, 1.0 / periods.most
            yield Measure("rate", topic, "Hz", *figures, periods.count, source, rate, f"rate of {topic}")
        if topic not in self._sources.states:
            bound_s = self._oldest_s(topic)
            oldest, source = "" if bound_s is None else seconds(bound_s), f"arrival less stamp of {topic}"
            yield _measure("age at arrival", topic, "s", stream.ages, source, oldest, f"max_age of {topic}", source)
        if topic in self._sources.observations or self._is_of_joints(topic):
            yield _offset(topic, stream.ages)

    def _is_of_joints(self, topic: str) -> bool:
        facts = self._contract.interfaces.get(topic)
        return facts is not None and facts.type.endswith("/JointState")

    def _oldest_s(self, topic: str) -> float | None:
        if topic in self._sources.observations:
            return self._sources.observations[topic][1]
        if self._is_of_joints(topic):
            return joint_state_age_s(self._contract)
        facts = self._contract.interfaces.get(topic)
        return None if facts is None else facts.max_age_s

    def _of_grippers(self, followed: Followed) -> Iterator[Measure]:
        for device, facts in self._contract.devices.items():
            if facts.gripper is not None and facts.gripper.controller is not None:
                yield self._grip(device, facts.gripper, followed)

    def _grip(self, device: str, gripper: ContractGripper, followed: Followed) -> Measure:
        """Return how far its jaws were apart as goals ended that left it neither open nor closed on nothing."""
        widths, near = Spread(), max(gripper.goal_tolerance, 1e-6)
        for goal in followed.goals:
            if goal.action.controller == gripper.controller and goal.status == SUCCEEDED and goal.ended is not None:
                at = goal.ended.positions.get(gripper.joint)
                if at is not None and min(abs(at - gripper.open), abs(at - gripper.closed)) > near:
                    widths.add(width_m(gripper, at))
        bands = {
            f"{frame} {small(facts.grasp.width_m, 'm')}"
            for frame, facts in self._contract.frames.items()
            if facts.grasp is not None and facts.grasp.width_m is not None and device in facts.grasp.bands
        }
        needed = f"ends of goals of {gripper.controller} on a part, and joint states with {gripper.joint}"
        key = "width in the grasp of the part"
        return _measure("grip width", device, "m", widths, needed, ", ".join(sorted(bands)), key, gripper.joint)


def _offset(topic: str, ages: Spread) -> Measure:
    """Return how far the clock of a stream is ahead of the recording computer's at least, where a stamp shows it."""
    key = "max_offset of clocks"
    if ages.least < 0.0:
        text = f"earliest arrival less stamp of {topic}: its clock is ahead by at least that"
        return Measure("clock offset", topic, "s", -ages.least, -ages.least, ages.count, text, "", key)
    least = seconds(ages.least)
    text = f"offsets as chrony or PTP measure them; {topic} arrives {least} after its stamp at the earliest"
    return Measure("clock offset", topic, "s", None, None, ages.count, text, "", key)


def width_m(gripper: ContractGripper, position: float) -> float:
    """Return how far the jaws are apart with the joint at a position: the inverse of its position at a width."""
    low, high = 0.0, gripper.stroke_m
    rises = gripper.position(high) > gripper.position(low)
    for _ in range(60):
        middle = (low + high) / 2.0
        if (gripper.position(middle) < position) == rises:
            low = middle
        else:
            high = middle
    return (low + high) / 2.0


def _measure(
    name: str, of: str, unit: str, spread: Spread, needed: str, stated: str, spec: str, source: str = ""
) -> Measure:
    """Return a figure of some values; without one, what would have to be recorded."""
    if not spread.count:
        return Measure(name, of, unit, None, None, 0, needed, stated, spec)
    return Measure(name, of, unit, spread.median, spread.most, spread.count, source or needed, stated, spec)
