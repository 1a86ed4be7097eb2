"""Trajectories, and how they are followed with bounded commands, one for each period."""

from __future__ import annotations

from bisect import bisect_right
from enum import Enum
from itertools import pairwise

from cellc.contract.adapter.device import DeviceAdapter, DeviceState, JointCommand, Phase
from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True)
class Waypoint:
    """Joint positions, velocities and accelerations at a time from the start; rad or m, per second, per second²."""

    time_s: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    accelerations: tuple[float, ...]


class Trajectory:
    """Waypoints joined by polynomials of fifth degree, which meet position, velocity and acceleration at both ends."""

    def __init__(self, waypoints: tuple[Waypoint, ...]) -> None:
        """Bind at least two waypoints in rising order of time.

        Raises:
            ValueError: there are fewer, or time does not rise.
        """
        if len(waypoints) < 2:
            raise ValueError("a trajectory needs a start and an end")
        if any(after.time_s <= before.time_s for before, after in pairwise(waypoints)):
            raise ValueError("the times of a trajectory must rise")
        self.waypoints = waypoints
        self._times = [waypoint.time_s for waypoint in waypoints]

    @property
    def duration_s(self) -> float:
        """Time of the last waypoint."""
        return self._times[-1]

    def positions(self, time_s: float) -> tuple[float, ...]:
        """Return the joint positions at a time; those of the ends outside."""
        if time_s <= self._times[0]:
            return self.waypoints[0].positions
        if time_s >= self._times[-1]:
            return self.waypoints[-1].positions
        index = bisect_right(self._times, time_s)
        before, after = self.waypoints[index - 1], self.waypoints[index]
        span_s = after.time_s - before.time_s
        share = (time_s - before.time_s) / span_s
        return tuple(_quintic(before, after, joint, span_s, share) for joint in range(len(before.positions)))


def _quintic(before: Waypoint, after: Waypoint, joint: int, span_s: float, share: float) -> float:
    """Return one joint at a share of a segment, by the six Hermite polynomials of fifth degree."""
    s2 = share * share
    s3 = s2 * share
    s4 = s3 * share
    s5 = s4 * share
    return (
        before.positions[joint] * (1.0 - 10.0 * s3 + 15.0 * s4 - 6.0 * s5)
        + after.positions[joint] * (10.0 * s3 - 15.0 * s4 + 6.0 * s5)
        + span_s * before.velocities[joint] * (share - 6.0 * s3 + 8.0 * s4 - 3.0 * s5)
        + span_s * after.velocities[joint] * (-4.0 * s3 + 7.0 * s4 - 3.0 * s5)
        + span_s * span_s * before.accelerations[joint] * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5)
        + span_s * span_s * after.accelerations[joint] * (0.5 * s3 - s4 + 0.5 * s5)
    )


class FollowerStatus(str, Enum):
    """State of a trajectory; the last four are terminal."""

    FOLLOWING = "following"
    HOLDING = "holding"  # canceled or given up, and not at standstill yet
    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    PATH_TOLERANCE_VIOLATED = "path tolerance violated"
    STOPPED = "stopped"  # the device stopped or refused


@dataclass(frozen=True, slots=True)
class FollowerResult:
    """The end of a trajectory, with the reason in words."""

    status: FollowerStatus
    text: str = ""


class TrajectoryFollower:
    """Streams a trajectory; call ``step`` once each command period until there is a result.

    Attributes:
        result: None while the trajectory runs.
    """

    def __init__(
        self, adapter: DeviceAdapter, trajectory: Trajectory, *, path_tolerance: float, goal_time_s: float
    ) -> None:
        """Bind a trajectory that begins where the device is.

        Args:
            path_tolerance: rad or m by which a joint may be away from its command.
            goal_time_s: time after the end within which the joints have to be within ``path_tolerance`` of it.
        """
        self.result: FollowerResult | None = None
        self._adapter = adapter
        self._trajectory = trajectory
        self._path_tolerance = path_tolerance
        self._goal_time_s = goal_time_s
        self._begun_ns = adapter.now_ns()
        self._commanded = trajectory.positions(0.0)
        self._ending: FollowerResult | None = None

    def step(self) -> FollowerResult | None:
        """Look at the device, send the pending command, and return the result once there is one."""
        if self.result is not None:
            return self.result
        state = self._adapter.read()
        if state.phase is not Phase.ACTIVE:
            self.result = FollowerResult(FollowerStatus.STOPPED, state.fault or f"device is {state.phase.value}")
        elif self._ending is not None:
            self.result = self._ending if _is_at_standstill(state) else None
        else:
            self._follow(state)
        return self.result

    def cancel(self) -> None:
        """Hold; the result comes with standstill."""
        self._give_up(FollowerResult(FollowerStatus.CANCELED))

    def _follow(self, state: DeviceState) -> None:
        away, joint = self._worst(state)
        if away > self._path_tolerance:
            model, allowed = self._adapter.model, self._path_tolerance
            name, unit = model.joint_names[joint], model.joints[joint].unit.value
            text = f"`{name}` is {away:.4f} {unit} away from its command, {allowed:.4f} {unit} allowed"
            self._give_up(FollowerResult(FollowerStatus.PATH_TOLERANCE_VIOLATED, text))
            return
        now_ns = self._adapter.now_ns()
        elapsed_s = (now_ns - self._begun_ns) / 1e9
        # After two periods the end was commanded twice: what is left is no motion that a hold would have to brake.
        settled_s = self._trajectory.duration_s + 2.0 * self._adapter.model.command_period_s
        if elapsed_s > settled_s and _is_at_standstill(state):
            self._adapter.hold()
            self.result = FollowerResult(FollowerStatus.SUCCEEDED)
            return
        if elapsed_s > self._trajectory.duration_s + self._goal_time_s:
            self._give_up(FollowerResult(FollowerStatus.PATH_TOLERANCE_VIOLATED, "not at standstill within goal time"))
            return
        positions = self._trajectory.positions(elapsed_s)
        refusal = self._adapter.command(JointCommand(now_ns, positions))
        if refusal is None:
            self._commanded = positions
        else:
            self._give_up(FollowerResult(FollowerStatus.STOPPED, refusal.text))

    def _give_up(self, result: FollowerResult) -> None:
        if self.result is None and self._ending is None:
            self._adapter.hold()
            self._ending = result

    def _worst(self, state: DeviceState) -> tuple[float, int]:
        """Return how far the joint is away that is farthest from its last command, and which one it is."""
        distances = [abs(at - sent) for at, sent in zip(state.positions, self._commanded, strict=True)]
        worst = max(range(len(distances)), key=distances.__getitem__)
        return distances[worst], worst


def _is_at_standstill(state: DeviceState, below: float = 1e-3) -> bool:
    """Tell whether every joint is slower than ``below`` rad/s or m/s."""
    return all(abs(velocity) < below for velocity in state.velocities)
