"""Follows a bag once from its begin to its end, and keeps what the record, the layer and the page are made from.

Memory does not grow with the length of the bag but with the number of its goals, lines and changes, each bounded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from cellc.contract.contract import Contract
from cellc.tools.attempt.heard import (
    ControllerSample,
    Edges,
    Fields,
    GoalStates,
    Heard,
    JointSample,
    ObservedPose,
    Said,
    Statuses,
)
from cellc.tools.attempt.motion import Motion
from cellc.tools.attempt.topics import Action, Sources

EXECUTING, CANCELING, SUCCEEDED, CANCELED, ABORTED = 2, 3, 4, 5, 6
"""States of action_msgs/msg/GoalStatus."""
_ERROR = 40
HOLDS = "holds"
_MOST_SNAPSHOTS = 500
"""Errors that are kept with what had arrived by then."""
_JUMP_NS = 50_000_000
"""By how much a stamp must be ahead of its arrival, and of the one before, for a clock that was set."""
_MOST = 10_000
"""Goals, lines, changes and observations that are kept of each kind; later ones are counted."""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """What had arrived by an instant.

    Attributes:
        joints_ns: of the newest state of each joint of the cell, the oldest stamp.
        observed: stamp of the newest observation, by frame.
        edges: stamp of the newest transform, by its child.
        positions: rad or m, by joint.
        missed: update cycles that managers had missed by then, as their diagnostics say.
        gaps: joint states that were missing by then, by the shortest time between two of one topic.
    """

    at_ns: int
    joints_ns: int | None
    observed: Mapping[str, int]
    edges: Mapping[str, int]
    positions: Mapping[str, float]
    missed: int
    gaps: int


@dataclass(slots=True)
class Goal:
    """A goal of an action, from its acceptance to its end; times on the clock of the recording computer."""

    action: Action
    goal_id: str
    accepted_ns: int
    before: Snapshot
    motion: Motion
    status: int = EXECUTING
    canceling: Snapshot | None = None
    ended: Snapshot | None = None
    written_ns: int | None = None
    scaling: float | None = None
    worst_error: float = 0.0

    @property
    def ended_ns(self) -> int | None:
        """When its last state was published."""
        return None if self.ended is None else self.ended.at_ns

    @property
    def is_over(self) -> bool:
        """Tell whether its state is a terminal one."""
        return self.status >= SUCCEEDED


@dataclass(frozen=True, slots=True)
class Change:
    """Something became something else: a hardware component, a controller, what a device needs to listen."""

    at_ns: int
    kind: str
    subject: str
    state: str
    topic: str = "/diagnostics"


@dataclass(frozen=True, slots=True)
class Line:
    """An error on /rosout, and whatever a controller or a hardware component said.

    Attributes:
        before: what had arrived by then, for an error of another node: it may tell of it.
    """

    at_ns: int
    level: int
    node: str
    text: str
    before: Snapshot | None = None


@dataclass(frozen=True, slots=True)
class Jump:
    """Joint states whose age changed from one to the next, in s: a clock was set."""

    at_ns: int
    topic: str
    by_s: float


Kept = TypeVar("Kept", Line, Change, Jump)


@dataclass(slots=True)
class Followed:
    """All that is kept of a bag."""

    goals: list[Goal] = field(default_factory=list)
    plans: list[Goal] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    jumps: list[Jump] = field(default_factory=list)
    observed: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    allowed: Mapping[str, tuple[str, float | None]] = field(default_factory=dict)
    begin_ns: int = 0
    end: Snapshot = field(default_factory=lambda: Snapshot(0, None, {}, {}, {}, 0, 0))
    positions: dict[str, float] = field(default_factory=dict)
    dropped: int = 0
    heard: int = 0


class Follower:
    """Takes the messages of a bag in the order of their arrival."""

    def __init__(self, contract: Contract, sources: Sources) -> None:
        """Begin before the first message."""
        self.followed = Followed(allowed=sources.observations)
        self.contract = contract
        self.sources = sources
        self._cell = frozenset(joint for each in sources.actions.values() for joint in each.joints)
        self._nodes = {*(each.controller for each in sources.actions.values()), *_components(contract)}
        self._now_ns = 0
        self._gaps = 0
        self._periods: dict[tuple[str, ...], tuple[int, int]] = {}
        self._scaling: dict[str, float | None] = {}
        self._ages: dict[str, int] = {}
        self._joints: dict[str, int] = {}
        self._edges: dict[str, int] = {}
        self._observed: dict[str, int] = {}
        self._states: dict[tuple[str, str], str] = {}
        self._missed: dict[str, int] = {}
        self._due: list[tuple[int, Action, GoalStates]] = []
        self._open: dict[tuple[str, str, int], Goal] = {}

    def take(self, log_ns: int, topic: str, heard: Heard) -> None:
        """Take a message."""
        if not self.followed.heard:
            self.followed.begin_ns = log_ns
        self.followed.heard += 1
        self._settle(log_ns)
        self._now_ns = max(self._now_ns, log_ns)
        if isinstance(heard, JointSample):
            self._joint_states(log_ns, topic, heard)
        elif isinstance(heard, ControllerSample):
            self._controller(self.sources.states.get(topic, ""), heard)
        elif isinstance(heard, Edges) and topic == "/tf":
            self._edges |= {child: stamp_ns for stamp_ns, child in heard.edges}
        elif isinstance(heard, ObservedPose) and topic in self.sources.observations:
            self._observation(log_ns, self.sources.observations[topic][0], heard.stamp_ns)
        elif isinstance(heard, GoalStates) and topic in self.sources.actions:
            self._due.append((log_ns, self.sources.actions[topic], heard))
        elif isinstance(heard, Statuses):
            self._diagnostics(log_ns, heard)
        elif isinstance(heard, Fields) and topic in self.sources.watched:
            self._needs(log_ns, topic, heard)
        elif isinstance(heard, Said) and (heard.level >= _ERROR or heard.node in self._nodes):
            self._say(log_ns, heard)

    def finish(self) -> Followed:
        """Return what was kept; a goal that never ended stays open."""
        self._settle(None)
        self.followed.end = self._snapshot(self._now_ns)
        return self.followed

    def _settle(self, now_ns: int | None) -> None:
        """Take the states of goals once all that had arrived by then was taken."""
        while self._due and (now_ns is None or self._due[0][0] < now_ns):
            at_ns, action, states = self._due.pop(0)
            for goal_id, accepted_ns, status in states.goals:
                self._goal(at_ns, action, goal_id, accepted_ns, status)

    def _goal(self, at_ns: int, action: Action, goal_id: str, accepted_ns: int, status: int) -> None:
        key = (action.name, goal_id, accepted_ns)
        goal = self._open.get(key)
        if goal is None:
            if len(self._open) >= _MOST:
                self.followed.dropped += 1
                return
            goal = Goal(action, goal_id, accepted_ns, self._snapshot(at_ns), Motion(action.joints, at_ns))
            goal.motion.begin(self.followed.positions, self._joints)
            goal.scaling = self._scaling.get(action.controller)
            self._open[key] = goal
            (self.followed.goals if action.controller else self.followed.plans).append(goal)
        if status == CANCELING and goal.canceling is None:
            goal.canceling = self._snapshot(at_ns)
            goal.motion.cancel(at_ns)
        if status >= SUCCEEDED and not goal.is_over:
            goal.ended = self._snapshot(at_ns)
        goal.status = max(goal.status, status)

    def _snapshot(self, at_ns: int) -> Snapshot:
        return Snapshot(
            at_ns=at_ns,
            joints_ns=min((self._joints[joint] for joint in self._cell & self._joints.keys()), default=None),
            observed=dict(self._observed),
            edges=dict(self._edges),
            positions=dict(self.followed.positions),
            missed=sum(self._missed.values()),
            gaps=self._gaps,
        )

    def _say(self, log_ns: int, said: Said) -> None:
        before = None
        if said.node not in self._nodes and len(self.followed.lines) < _MOST_SNAPSHOTS:
            before = self._snapshot(log_ns)
        self._keep(self.followed.lines, Line(log_ns, said.level, said.node, said.text, before))

    def _joint_states(self, log_ns: int, topic: str, sample: JointSample) -> None:
        age_ns = log_ns - sample.stamp_ns
        before_ns = self._ages.setdefault(topic, age_ns) if len(self._ages) < _MOST else age_ns
        if age_ns < min(0, before_ns) - _JUMP_NS:
            self._keep(self.followed.jumps, Jump(log_ns, topic, (before_ns - age_ns) / 1e9))
        if topic in self._ages:
            self._ages[topic] = age_ns
        if len(self._joints) < _MOST and len(self._periods) < _MOST:
            self._count_gaps((topic, *sample.names), sample.stamp_ns)
            self._joints |= dict.fromkeys(sample.names, sample.stamp_ns)
        positions = dict(zip(sample.names, sample.positions.tolist(), strict=False))
        self.followed.positions |= positions
        for goal in self._active():
            goal.motion.move(min(sample.stamp_ns, log_ns), positions)
            mine = not positions.keys().isdisjoint(goal.action.joints)
            if goal.written_ns is None and mine and sample.stamp_ns > goal.accepted_ns:
                goal.written_ns = sample.stamp_ns

    def _count_gaps(self, stream: tuple[str, ...], stamp_ns: int) -> None:
        """Count the joint states that are missing in a stream: those of one topic with the same joints."""
        last_ns, shortest_ns = self._periods.get(stream, (stamp_ns, 0))
        period_ns = stamp_ns - last_ns
        if period_ns > 0:
            shortest_ns = min(period_ns, shortest_ns or period_ns)
            self._gaps += round(period_ns / shortest_ns) - 1
        self._periods[stream] = stamp_ns, shortest_ns

    def _controller(self, controller: str, sample: ControllerSample) -> None:
        self._scaling[controller] = sample.scaling
        for goal in self._active():
            if goal.action.controller == controller:
                if goal.scaling is None:
                    goal.scaling = sample.scaling
                if len(sample.error):
                    goal.worst_error = max(goal.worst_error, float(np.abs(sample.error).max()))

    def _active(self) -> list[Goal]:
        """Return the goals that are followed still: those without an end, and the last ones of each kind."""
        return [goal for goal in self.followed.goals[-8:] if not goal.is_over or goal.motion.is_canceled]

    def _observation(self, log_ns: int, frame: str, stamp_ns: int) -> None:
        self._observed[frame] = stamp_ns
        history = self.followed.observed.setdefault(frame, [])
        history.append((log_ns, stamp_ns))
        if len(history) > 2 * _MOST:
            del history[:_MOST]

    def _diagnostics(self, log_ns: int, heard: Statuses) -> None:
        for _, name, _, values in heard.statuses:
            kind = next((each for each in ("Controllers", "Hardware Components") if f"{each} Activity" in name), None)
            if kind is not None:
                for subject, state in values.items():
                    if self._states.get((kind, subject)) != state:
                        self._keep(self.followed.changes, Change(log_ns, kind, subject, state))
                    self._states[(kind, subject)] = state
            if values.get("missed_cycles", "").isdecimal():
                self._missed[name] = int(values["missed_cycles"])

    def _needs(self, log_ns: int, topic: str, heard: Fields) -> None:
        for watched in self.sources.watched[topic]:
            holds, field = watched.holds(heard.values), watched.proof.field or ""
            if holds is None:
                continue
            state = HOLDS if holds else f"{field} is {heard.values.get(field, 0):g}"
            key = (watched.need, watched.device)
            if self._states.get(key) != state:
                self._keep(self.followed.changes, Change(log_ns, watched.need, watched.device, state, topic))
            self._states[key] = state

    def _keep(self, into: list[Kept], item: Kept) -> None:
        if len(into) < _MOST:
            into.append(item)
        else:
            self.followed.dropped += 1


def _components(contract: Contract) -> set[str]:
    return {each.hardware_component for each in contract.devices.values() if each.hardware_component is not None}
