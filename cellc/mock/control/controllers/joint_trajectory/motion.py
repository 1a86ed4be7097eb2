"""The trajectory that is being executed: its time, its samples, its tolerances, and how it is stopped."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.mock.control.controllers.joint_trajectory.interfaces import JointInterfaces
from cellc.mock.control.controllers.joint_trajectory.spline import Indices, Spline, StartState
from cellc.mock.control.interfaces import Array, Flags, Times
from cellc.mock.control.log import Log
from cellc.mock.control.messages import JointTolerance, TrajectoryGoal, TrajectoryPoint, TrajectoryStateResponse
from cellc.mock.control.parameters import ParameterSet
from cellc.mock.errors import LimitReachedError


@dataclass(frozen=True, slots=True)
class PendingTrajectory:
    """A trajectory that the next update takes over.

    Attributes:
        held: the controller holds a position with it.
        interrupts: it ends what was going on, wherever that was.
    """

    points: tuple[TrajectoryPoint, ...]
    stamp_ns: int
    held: bool
    interrupts: bool = False


class Samples:
    """Desired states now and one period ahead, for successive updates.

    Args:
        spline: what is sampled.
        times_ns: trajectory times of the updates.
        reached: points that are reached at each, and the time into the segment.
        desired: desired positions.
        ahead: the same one period ahead: points that are reached, time into the segment, positions.
    """

    def __init__(
        self,
        spline: Spline,
        times_ns: Times,
        reached: tuple[Indices, Array],
        desired: Array,
        ahead: tuple[Indices, Array, Array],
    ) -> None:
        self.times_ns = times_ns
        self.desired = desired
        self.next_reached, self.next_into, self.next = ahead
        self._spline = spline
        self._reached = reached
        self._velocity: Array | None = None

    @property
    def desired_velocity(self) -> Array:
        """Desired velocities now, computed only where they are asked for."""
        if self._velocity is None:
            self._velocity = self._spline.velocities(*self._reached)
        return self._velocity


@dataclass(slots=True)
class LastUpdate:
    """What the last update saw, for feedback and for a hold."""

    time_ns: int
    measured: StartState
    samples: Samples | None = None
    row: int = 0


class Motion:
    """Samples one trajectory.

    Args:
        spline: the trajectory.
        time_ns: trajectory time of the first update.
        held: whether the trajectory only holds a position.
        interfaces: the controller's interfaces.
        ahead_ns: how far ahead commands are sampled: the period of the controller.
    """

    def __init__(self, spline: Spline, time_ns: int, held: bool, interfaces: JointInterfaces, ahead_ns: int) -> None:
        self.spline = spline
        self.time_ns = time_ns
        self.held = held
        self._interfaces = interfaces
        self._ahead_ns = ahead_ns

    def sample(self, times_ns: Times) -> Samples:
        """Sample the trajectory at evenly spaced trajectory times."""
        spline, count = self.spline, len(times_ns)
        if count == 1 or int(times_ns[1] - times_ns[0]) == self._ahead_ns:
            # What is one period ahead now is pending in the next update: sample it once.
            longer = np.empty(count + 1, dtype=np.int64)
            longer[:-1], longer[-1] = times_ns, times_ns[-1] + self._ahead_ns
            reached, into = spline.locate(longer)
            positions = spline.positions(reached, into)
            now, ahead = (reached[:-1], into[:-1]), (reached[1:], into[1:], positions[1:])
            return Samples(spline, times_ns, now, positions[:-1], ahead)
        reached, into = spline.locate(times_ns)
        later, later_into = spline.locate(times_ns + self._ahead_ns)
        ahead = (later, later_into, spline.positions(later, later_into))
        return Samples(spline, times_ns, (reached, into), spline.positions(reached, into), ahead)

    def updates_left(self, factor: float) -> int | None:
        """Return how many updates are left up to the last point, at one speed; None for a hold and beyond the point."""
        step_ns = int(self._ahead_ns * factor)
        left_ns = int(self.spline.point_times_ns[-1]) - self.time_ns
        return None if self.held or step_ns <= 0 or left_ns <= 0 else -(-left_ns // step_ns)

    def overtime_s(self, samples: Samples) -> Array:
        """Time since the point that the next sample's segment starts with was due; negative before it is (s)."""
        start = np.maximum(samples.next_reached - 1, 0)
        return (samples.times_ns - self.spline.point_times_ns[start]) / 1e9

    def violated(self, tolerance: StateTolerance, samples: Samples, state: Array, rows: slice) -> Flags:
        """Which joints are outside a tolerance in which updates, shape (updates, joints) of bool."""
        interfaces = self._interfaces
        error = interfaces.difference(samples.desired[rows], state[:, interfaces.states["position"]])
        outside: Flags = np.abs(error) > tolerance.position
        if interfaces.checks_velocity:
            rates = samples.desired_velocity[rows] - state[:, interfaces.states["velocity"]]
            outside |= np.abs(rates) > tolerance.velocity
        return outside

    def query(self, time_ns: int) -> TrajectoryStateResponse:
        """Sample at a time; unsuccessful while only holding, and for a time outside the trajectory."""
        spline = self.spline
        reached, into = spline.locate(np.array([time_ns], dtype=np.int64))
        if self.held or time_ns < spline.before_ns or reached[0] == spline.count:
            return TrajectoryStateResponse(False)
        values = (spline.positions, spline.velocities, spline.accelerations)
        states = [tuple(value(reached, into)[0].tolist()) for value in values]
        return TrajectoryStateResponse(True, self._interfaces.joints, *states)


def first_true(flags: Flags) -> int:
    """Index of the first true flag, the length if none is."""
    if not len(flags):
        return 0
    index = int(flags.argmax())
    return index if flags[index] else len(flags)


def regular_updates(
    motion: Motion, samples: Samples, state: Array, tolerances: Tolerances, has_goal: bool, timeout_s: float
) -> int:
    """How many leading updates go by without anything being decided.

    Args:
        motion: the motion that is executed, not a held one.
        samples: its samples.
        state: measured states of the same updates.
        tolerances: tolerances in force.
        has_goal: whether an action goal is being executed.
        timeout_s: command timeout, 0 for none.
    """
    count = len(state)
    ended = samples.next_reached[:count] == motion.spline.count
    end = first_true(ended)
    if end:
        moving = np.logical_or.reduce(motion.violated(tolerances.path, samples, state[:end], slice(0, end)), axis=1)
        first = first_true(moving)
        if first < end or end == len(ended):
            return first
    rows = slice(end, count)
    outside = np.logical_or.reduce(motion.violated(tolerances.goal, samples, state[end:], rows), axis=1)
    overtime = motion.overtime_s(samples)[rows]
    decided: Flags = np.zeros(len(outside), dtype=np.bool_)
    if has_goal:
        decided |= ~outside
    if tolerances.goal_time_s != 0.0:
        decided |= outside & (overtime > tolerances.goal_time_s)
    if timeout_s > 0.0:
        decided |= overtime > timeout_s
    return end + first_true(decided)


def held_point(position: Array) -> tuple[TrajectoryPoint, ...]:
    """The trajectory that holds a position."""
    return (TrajectoryPoint(tuple(position.tolist())),)


def start_of(
    measured: StartState, commanded: StartState | None, pending: PendingTrajectory, interfaces: JointInterfaces
) -> StartState:
    """The state that a trajectory starts from, continuous joints turned next to its first point."""
    state = measured if commanded is None else commanded
    first = pending.points[0].positions
    if not first:
        return state
    position = interfaces.unwrap(state.position, np.array(first[: len(state.position)]))
    return StartState(state.time_ns, position, state.velocity, state.acceleration)


_ERASE = -1.0


@dataclass(frozen=True, slots=True)
class StateTolerance:
    """Tolerances of all joints; infinite where nothing is checked."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True, slots=True)
class Tolerances:
    """Tolerances on the way, at the end, and of the time at the end (s, 0 waits for ever)."""

    path: StateTolerance
    goal: StateTolerance
    goal_time_s: float


def _enforced(values: Sequence[float]) -> Array:
    """A stored tolerance of 0 or less is not checked."""
    array = np.array(values, dtype=float)
    return np.where(array > 0.0, array, np.inf)


def default_tolerances(parameters: ParameterSet, joints: Sequence[str]) -> Tolerances:
    """The controller's tolerances, from its parameters."""
    unchecked = np.full(len(joints), np.inf)
    stopped = parameters.number("constraints.stopped_velocity_tolerance")
    path = _enforced([parameters.number(f"constraints.{joint}.trajectory") for joint in joints])
    goal = _enforced([parameters.number(f"constraints.{joint}.goal") for joint in joints])
    return Tolerances(
        StateTolerance(path, unchecked, unchecked),
        StateTolerance(goal, _enforced([stopped] * len(joints)), unchecked),
        parameters.number("constraints.goal_time"),
    )


class _RefusedError(Exception):
    """A tolerance that makes the whole goal run with the defaults."""


def _resolve(default: float, given: float, what: str) -> float:
    if given > 0.0:
        return given
    if given == 0.0:
        return default
    if given == _ERASE:
        return np.inf
    raise _RefusedError(f"Illegal {what} tolerance {given:f}, must be -1, 0, or positive. Using default tolerances.")


def _merge(
    default: StateTolerance, given: Sequence[JointTolerance], joints: Sequence[str], field: str
) -> StateTolerance:
    merged = StateTolerance(default.position.copy(), default.velocity.copy(), default.acceleration.copy())
    for tolerance in given:
        if tolerance.name not in joints:
            raise _RefusedError(
                f"joint '{tolerance.name}' specified in goal.{field} does not exist. Using default tolerances."
            )
        index = list(joints).index(tolerance.name)
        merged.position[index] = _resolve(default.position[index], tolerance.position, "position")
        merged.velocity[index] = _resolve(default.velocity[index], tolerance.velocity, "velocity")
        merged.acceleration[index] = _resolve(default.acceleration[index], tolerance.acceleration, "acceleration")
    return merged


def goal_tolerances(
    default: Tolerances, goal: TrajectoryGoal, joints: Sequence[str], log: Log, logger: str
) -> Tolerances:
    """Tolerances of one goal; any mistake in it makes all of its tolerances the defaults."""
    seconds = goal.goal_time_tolerance_ns / 1e9
    goal_time = default.goal_time_s
    try:
        path = _merge(default.path, goal.path_tolerance, joints, "path_tolerance")
        end = _merge(default.goal, goal.goal_tolerance, joints, "goal_tolerance")
    except _RefusedError as refused:
        log.error(f"{logger}.tolerance", str(refused))
        return default
    if seconds > 0.0:
        goal_time = seconds
    elif seconds == _ERASE:
        goal_time = 0.0
    elif seconds < 0.0:
        text = f"Specified illegal goal_time_tolerance: {seconds:f}. Using default tolerances"
        log.error(f"{logger}.tolerance", text)
    return replace(default, path=path, goal=end, goal_time_s=goal_time)


def stop_points(position: Array, velocity: Array, deceleration: Array, period_ns: int) -> tuple[TrajectoryPoint, ...]:
    """Points of a stop from a measured state, one per period.

    Args:
        position: measured positions.
        velocity: measured velocities.
        deceleration: magnitude of each joint's deceleration, > 0.
        period_ns: period of the controller.

    Returns:
        Points with positions, velocities and accelerations, from the present state to rest of the last joint.
    """
    stop_s = np.abs(velocity) / deceleration
    longest = float(stop_s.max()) * 1e9 / period_ns
    if not longest <= limits().mock_stop_cycles:
        text = f"a stop takes {longest:.3g} update cycles, at most {limits().mock_stop_cycles} are simulated"
        raise LimitReachedError(text)
    count = math.ceil(longest) + 1
    rest = position + velocity * np.abs(velocity) / (2.0 * deceleration)
    points = []
    for index in range(count + 1):
        time_s = index * period_ns / 1e9
        moving = time_s < stop_s
        acceleration = np.where(moving, -np.sign(velocity) * deceleration, 0.0)
        way = position + velocity * time_s + 0.5 * acceleration * time_s * time_s
        points.append(
            TrajectoryPoint(
                tuple(np.where(moving, way, rest).tolist()),
                tuple(np.where(moving, velocity + acceleration * time_s, 0.0).tolist()),
                tuple(acceleration.tolist()),
                time_from_start_ns=index * period_ns,
            )
        )
    return tuple(points)
