"""The action server in front of an adapter: goals are refused before motion where a command of theirs would be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from cellc.contract.adapter import (
    AdapterModel,
    DeviceState,
    FollowerResult,
    FollowerStatus,
    JointCommand,
    JointModel,
    Phase,
    Trajectory,
    TrajectoryFollower,
    Unit,
    Waypoint,
    check_command,
)
from cellc.contract.contract import ContractJointLimits
from cellc.contract.devices import ContractAdapter
from cellc.mock.adapter.simulated import AdapterDisturbances, SimulatedAdapter
from cellc.mock.control import (
    CancelResponse,
    ControlEvent,
    GoalResponse,
    GoalStatus,
    GripperGoal,
    HardwareChanged,
    JointStateBlock,
    TrajectoryEnded,
    TrajectoryGoal,
    TrajectoryPoint,
)
from cellc.mock.control.hardware.forces import Forces
from cellc.mock.control.journal import Cause, CommandJournal

START_TOLERANCE = 0.01
"""rad or m by which the first point may be away from where the joints stand, where it is scheduled immediately."""
_UNBOUNDED = float("inf")


def adapter_model(
    device: str, facts: ContractAdapter, limits: Mapping[str, ContractJointLimits], clock: str
) -> AdapterModel:
    """Return what the adapter of a device states, with the limits of the cell as bounds of its commands."""
    joints: list[JointModel] = []
    for name, unit in zip(facts.joints, facts.units, strict=True):
        limit = limits.get(name)
        lower = -_UNBOUNDED if limit is None or limit.lower is None else limit.lower
        upper = _UNBOUNDED if limit is None or limit.upper is None else limit.upper
        joints.append(JointModel(name, Unit(unit), lower, upper, _UNBOUNDED if limit is None else limit.velocity))
    return AdapterModel(
        device, tuple(joints), clock, facts.command_period_s, facts.command_timeout_s, facts.stop_time_s
    )


def read_goal(goal: TrajectoryGoal, model: AdapterModel, state: DeviceState) -> Trajectory:
    """Return the trajectory of a goal, from where the joints stand.

    Raises:
        ValueError: a joint or a value is missing, the times do not rise, or a first point scheduled immediately is
            elsewhere.
    """
    if sorted(goal.joint_names) != sorted(model.joint_names):
        raise ValueError(f"the goal names {', '.join(goal.joint_names)}; `{model.device}` moves all of its joints")
    order = [goal.joint_names.index(name) for name in model.joint_names]
    points = [_waypoint(point, order) for point in goal.points]
    if points and points[0].time_s == 0.0:
        away = max(abs(a - b) for a, b in zip(points[0].positions, state.positions, strict=True))
        if away > START_TOLERANCE:
            raise ValueError(f"the trajectory begins {away:.4g} away from where the joints stand")
        start, points = points[0], points[1:]
        # A goal that is reached already is a trajectory of one period.
        points = points or [replace(start, time_s=model.command_period_s)]
    zero = (0.0,) * len(order)
    return Trajectory((Waypoint(0.0, state.positions, zero, zero), *points))


def first_refusal(trajectory: Trajectory, model: AdapterModel) -> str:
    """Return why a command of a trajectory would be refused; empty where each one is within bounds."""
    last = trajectory.positions(0.0)
    for period in range(1, int(trajectory.duration_s / model.command_period_s) + 2):
        positions = trajectory.positions(period * model.command_period_s)
        refusal = check_command(model, JointCommand(0, positions), phase=Phase.ACTIVE, last=last, now_ns=0)
        if refusal is not None:
            return refusal.text
        last = positions
    return ""


def _waypoint(point: TrajectoryPoint, order: list[int]) -> Waypoint:
    values = (point.positions, point.velocities, point.accelerations)
    if any(len(each) != len(order) for each in values):
        raise ValueError("a point lacks positions, velocities or accelerations")
    positions, velocities, accelerations = (tuple(each[index] for index in order) for each in values)
    return Waypoint(point.time_from_start_ns / 1e9, positions, velocities, accelerations)


_SAME = 1e-9
"""rad or m: a position nearer than this to the last command is the commanded one."""
_ENDINGS = {
    FollowerStatus.SUCCEEDED: (GoalStatus.SUCCEEDED, 0),
    FollowerStatus.CANCELED: (GoalStatus.CANCELED, 0),
    FollowerStatus.PATH_TOLERANCE_VIOLATED: (GoalStatus.ABORTED, -4),
    FollowerStatus.STOPPED: (GoalStatus.ABORTED, -4),
}
"""Status and error code of FollowJointTrajectory."""


class AdapterServer:
    """Runs a simulated device in simulated time, and offers what the task asks of a controller.

    Attributes:
        adapter: the device.
        disturbances: its faults.
        journal: of the commands that it took.
        period_ns: of commands and states.
        now_ns: time that is reached.
    """

    def __init__(
        self,
        device: str,
        facts: ContractAdapter,
        limits: Mapping[str, ContractJointLimits],
        clock: str,
        forces: Forces | None = None,
    ) -> None:
        """Bind the device, which is not connected yet; ``forces`` moves its joints, None where they are led alone."""
        self._forces = forces
        self.now_ns = 0
        self.period_ns = round(facts.command_period_s * 1e9)
        model = adapter_model(device, facts, limits, clock)
        self.adapter = SimulatedAdapter(model, facts.start_positions, lambda: self.now_ns, forces)
        self.disturbances = AdapterDisturbances(self.adapter)
        self.journal = CommandJournal()
        self.journal.interface_names += [f"{name}/position" for name in facts.joints]
        self._device = device
        self._goal_time_s, self._path_tolerance = facts.goal_time_s, facts.path_tolerance
        self._next_ns = 0
        self._commanded = facts.start_positions
        self._events: list[ControlEvent] = []
        self._goals = 0
        self._follower: TrajectoryFollower | None = None
        self._phase = Phase.UNCONFIGURED
        self._stamps: list[int] = []
        self._positions: list[tuple[float, ...]] = []

    def send_goal(self, controller: str, goal: TrajectoryGoal | GripperGoal) -> GoalResponse:
        """Take a trajectory whose every command will be within bounds, or reject it with the reason."""
        if not isinstance(goal, TrajectoryGoal):
            return GoalResponse(False, log_reason=f"`{controller}` takes trajectories only")
        if self._follower is not None:
            return GoalResponse(False, log_reason=f"`{controller}` executes another goal")
        if self._phase is not Phase.ACTIVE:
            return GoalResponse(False, log_reason=f"`{controller}` is {self._phase.value}")
        model = self.adapter.model
        try:
            trajectory = read_goal(goal, model, self.adapter.read())
        except ValueError as problem:
            return GoalResponse(False, log_reason=str(problem))
        refused = first_refusal(trajectory, model)
        if refused:
            return GoalResponse(False, log_reason=refused)
        times_ns = (point.time_from_start_ns for point in goal.points)
        self._note_start(trajectory.positions(0.0), next((time for time in times_ns if time > 0), 0))
        self._goals += 1
        self._follower = TrajectoryFollower(
            self.adapter, trajectory, path_tolerance=self._path_tolerance, goal_time_s=self._goal_time_s
        )
        return GoalResponse(True, self._goals)

    def cancel_goal(self, goal_id: int) -> CancelResponse:
        """Cancel a goal; the answer has the codes of action_msgs/srv/CancelGoal."""
        if not 0 < goal_id <= self._goals:
            return CancelResponse(2)
        if self._follower is None or goal_id != self._goals:
            return CancelResponse(3)
        self._follower.cancel()
        return CancelResponse(0, (goal_id,))

    def cancel_all(self, controller: str) -> CancelResponse:
        """Cancel the goal that executes, if there is one."""
        return CancelResponse(0) if self._follower is None else self.cancel_goal(self._goals)

    def joint_positions(self) -> dict[str, float]:
        """Return where the joints stand."""
        return dict(zip(self.adapter.model.joint_names, self.adapter.read().positions, strict=True))

    def advance(self, until_ns: int) -> int:
        """Run the periods up to ``until_ns``, or up to the first that has something to tell."""
        published = len(self._events)
        while self._next_ns <= until_ns and len(self._events) == published:
            if self._follower is None and self.adapter.phase is self._phase and self.adapter.settled:
                self._rest(until_ns)
            else:
                self._tick()
        if len(self._events) == published:
            self.now_ns = until_ns
        return self.now_ns

    def skip_cycles(self, count: int) -> None:
        """Neither read nor command the device for a number of periods."""
        self._next_ns += count * self.period_ns

    def take_events(self) -> tuple[ControlEvent, ...]:
        """Return what has happened since the last call."""
        events, self._events = tuple(self._events), []
        return events

    def take_joint_states(self) -> JointStateBlock:
        """Return the states that were published since the last call."""
        stamps, positions = self._stamps, self._positions
        self._stamps, self._positions = [], []
        names = self.adapter.model.joint_names
        values = np.array(positions, dtype=np.float64).reshape(len(stamps), len(names))
        nothing = np.zeros_like(values)
        return JointStateBlock(np.array(stamps, dtype=np.int64), names, values, nothing, nothing)

    def _rest(self, until_ns: int) -> None:
        """Publish the same state in every period: without commands the joints are at standstill."""
        count = (until_ns - self._next_ns) // self.period_ns + 1
        if self._phase not in (Phase.UNCONFIGURED, Phase.FINALIZED):
            stamps = range(self._next_ns, self._next_ns + count * self.period_ns, self.period_ns)
            self._stamps += stamps
            self._positions += self._standing(stamps)
        self._next_ns += count * self.period_ns
        self.now_ns = self._next_ns - self.period_ns

    def _standing(self, stamps: range) -> list[tuple[float, ...]]:
        """Return what is measured of joints at standstill; it differs from period to period only if it is disturbed."""
        positions: list[tuple[float, ...]] = []
        for stamp_ns in stamps if self.adapter.joints else stamps[:1]:
            self.now_ns = stamp_ns
            positions.append(self.adapter.read().positions)
        return positions * (len(stamps) // len(positions))

    def _tick(self) -> None:
        """Publish the state of one period and send the pending command."""
        self.now_ns = self._next_ns
        self._next_ns += self.period_ns
        if self._forces is not None:
            self.adapter.aim(self._forces)
            self._forces.advance(np.array([self.now_ns], dtype=np.int64))
            self._forces.commit(1)
        result = None if self._follower is None else self._follower.step()
        self._keep_command()
        state = self.adapter.read()
        self._stamps.append(self.now_ns)
        self._positions.append(state.positions)
        if state.phase is not self._phase:
            self._tell_phase(state.phase, state.fault)
        if result is not None:
            self._tell_result(result)

    def _keep_command(self) -> None:
        command = self.adapter.fresh_command
        if command is None:
            return
        self._commanded = command
        if self.journal.listening:
            stamps = np.array([self.now_ns], dtype=np.int64)
            self.journal.add(self._device, range(len(command)), stamps, np.array([command]))

    def _note_start(self, start: tuple[float, ...], first_ns: int) -> None:
        """Note where a trajectory starts beside the last command: after a stop, or from a joint that did not follow.

        Args:
            first_ns: time to the first point of the plan, up to which the command need not be smooth.
        """
        if any(abs(a - b) > _SAME for a, b in zip(start, self._commanded, strict=True)):
            cycles_ns = round(2e9 * self.adapter.model.command_period_s)  # its loop takes the plan over in the next
            self.journal.note(self.now_ns + 1, self._device, Cause.OFF_COMMAND, first_ns + cycles_ns)

    def _tell_phase(self, phase: Phase, fault: str) -> None:
        stopped = Phase.STOPPED in (phase, self._phase)
        self._phase = phase
        if stopped:
            state = "active" if phase is Phase.ACTIVE else "inactive"
            self._events.append(HardwareChanged(self.now_ns, self._device, state, fault))

    def _tell_result(self, result: FollowerResult) -> None:
        self._follower = None
        status, error_code = _ENDINGS[result.status]
        ended = TrajectoryEnded(self.now_ns, self.now_ns, self._device, self._goals, status, error_code, result.text)
        self._events.append(ended)
