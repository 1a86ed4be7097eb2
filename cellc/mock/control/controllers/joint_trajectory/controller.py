"""The joint trajectory controller: facts/follow_joint_trajectory.md, row by row.

One `update` is: take over a new trajectory, read the state, sample the trajectory now and one period ahead, check
tolerances, command, decide the goal. Blocks repeat the same arithmetic for many updates in which nothing is decided.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellc.mock.control.block import Block
from cellc.mock.control.controllers.base import Context, Cycle, QuietController
from cellc.mock.control.controllers.joint_trajectory.declaration import declare
from cellc.mock.control.controllers.joint_trajectory.goals import GoalBook
from cellc.mock.control.controllers.joint_trajectory.interfaces import JointInterfaces
from cellc.mock.control.controllers.joint_trajectory.local_order import in_local_order
from cellc.mock.control.controllers.joint_trajectory.motion import (
    Motion,
    PendingTrajectory,
    Samples,
    held_point,
    regular_updates,
    start_of,
)
from cellc.mock.control.controllers.joint_trajectory.pid import Pid
from cellc.mock.control.controllers.joint_trajectory.recorder import Recorder
from cellc.mock.control.controllers.joint_trajectory.scaling import SpeedScaling
from cellc.mock.control.controllers.joint_trajectory.spline import Spline, StartState
from cellc.mock.control.controllers.joint_trajectory.stopping import stop_points
from cellc.mock.control.controllers.joint_trajectory.tolerances import default_tolerances
from cellc.mock.control.controllers.joint_trajectory.validation import AcceptanceRules
from cellc.mock.control.messages import Trajectory, TrajectoryStateResponse
from cellc.mock.control.parameters import ParameterValue


@dataclass(slots=True)
class LastUpdate:
    """What the last update saw, for feedback and for a hold."""

    time_ns: int
    measured: StartState
    samples: Samples | None = None
    row: int = 0


class JointTrajectoryController(QuietController):
    """A joint trajectory controller.

    Args:
        context: what the manager gives.
        scaled: whether speed scaling comes from the state interface that `speed_scaling_interface_name` names.

    Raises:
        ParameterError: from the declaration of the parameters.
    """

    def __init__(self, context: Context, scaled: bool) -> None:
        super().__init__(context)
        declare(context.parameters, context.distro, scaled)
        self._scaled = scaled
        self.recorder: Recorder | None = None

    @property
    def releases_itself(self) -> bool:
        """Done by the controller."""
        return True

    def configure(self) -> None:
        """Read the parameters."""
        context, parameters = self.context, self.context.parameters
        self.interfaces = JointInterfaces(context)
        self._ahead_ns = 1_000_000_000 // context.update_rate
        self.scaling = SpeedScaling(context, self._scaled)
        self.defaults = default_tolerances(parameters, self.interfaces.joints)
        self.goals = GoalBook(context, self.interfaces.joints, self.defaults)
        names = self.interfaces.joints
        self._pids = [Pid.of(parameters, f"gains.{name}.") for name in names] if self.interfaces.uses_pid else []
        self._interpolate = parameters.text("interpolation_method") != "none"
        self._from_desired = parameters.flag("interpolate_from_desired_state")
        self._stop = np.array([parameters.number(f"constraints.{j}.max_deceleration_on_cancel") for j in names])
        self.active = False
        self._clear()

    def _clear(self) -> None:
        self._motion: Motion | None = None
        self._pending: PendingTrajectory | None = None
        self._commanded: StartState | None = None
        self._preview: Samples | None = None
        self._factor = 1.0

    def command_interfaces(self) -> tuple[str, ...]:
        """The joints' commands, and the one of speed scaling."""
        return (*self.interfaces.command_names(), *self.scaling.command_names())

    def state_interfaces(self) -> tuple[str, ...]:
        """The joints' states, and the one of speed scaling."""
        return (*self.interfaces.state_names(), *self.scaling.state_names())

    def rules(self) -> AcceptanceRules:
        """What is allowed in a trajectory, by the present parameters."""
        parameters = self.context.parameters
        return AcceptanceRules(
            self.interfaces.joints,
            parameters.flag("allow_partial_joints_goal"),
            parameters.flag("allow_integration_in_goal_trajectories"),
            parameters.flag("allow_nonzero_velocity_at_trajectory_end"),
            "effort" in self.interfaces.command_kinds,
        )

    @property
    def _timeout_s(self) -> float:
        timeout = self.context.parameters.number("cmd_timeout")
        return timeout if timeout > self.defaults.goal_time_s else 0.0

    # -- transitions -------------------------------------------------------------------------------------------------

    def activate(self, now_ns: int) -> None:
        """Hold the last command, or the measured position."""
        self._clear()
        self.interfaces.bind()
        self.scaling.bind()
        self.goals.tolerances = self.defaults
        measured = self.interfaces.read_states(now_ns)
        parameters = self.context.parameters
        if parameters.flag("set_last_command_interface_value_as_state_on_activation"):
            measured = self.interfaces.read_commands(measured) or measured
        self.last = LastUpdate(now_ns, measured)
        self.active = True
        self.hold()

    def deactivate(self, now_ns: int) -> None:
        """Abort the goal; keep position commands, zero the others."""
        if self.goals.running:
            self.goals.abort(now_ns, -1, "Current goal cancelled during deactivate transition.")
        command = self.context.table.command
        for kind, columns in self.interfaces.commands.items():
            for column in columns.tolist():
                self.context.command(column, float(command[column]) if kind == "position" else 0.0)
        self.active = False
        self._clear()

    def parameter_changed(self, name: str, value: ParameterValue) -> None:
        """Tolerances are read again."""
        self.defaults = default_tolerances(self.context.parameters, self.interfaces.joints)
        self.goals.defaults = self.defaults

    # -- trajectories ------------------------------------------------------------------------------------------------

    def take(self, trajectory: Trajectory) -> None:
        """Queue an accepted trajectory for the next update."""
        points, warning = in_local_order(trajectory, self.interfaces.joints, self.interfaces.held_positions())
        if warning:
            self.context.log.warn(self.context.name, warning)
        self._pending = PendingTrajectory(points, trajectory.stamp_ns, held=False)

    def hold(self) -> None:
        """Queue holding the last measured position."""
        self._pending = PendingTrajectory(held_point(self.last.measured.position), 0, held=True)

    def stop(self) -> None:
        """Queue a stop: with the configured deceleration where there is one, otherwise a plain hold."""
        measured = self.last.measured
        decelerates = self.context.parameters.flag("constraints.decelerate_on_cancel")
        if not decelerates or not (self._stop > 0.0).all() or measured.velocity is None:
            self.hold()
            return
        points = stop_points(measured.position, measured.velocity, self._stop, self._ahead_ns)
        self._pending = PendingTrajectory(points, 0, held=True)

    def _hold_end(self, motion: Motion) -> None:
        """Queue holding the last point of a trajectory, even if it has a velocity."""
        reached = np.array([motion.spline.count], dtype=np.intp)
        position = motion.spline.positions(reached, np.zeros(1))[0]
        self._pending = PendingTrajectory(held_point(position), 0, held=True)

    def _start(self, pending: PendingTrajectory, measured: StartState) -> Motion:
        now_ns = measured.time_ns
        commanded = self._commanded if self._from_desired else None
        start = start_of(measured, commanded, pending, self.interfaces)
        spline = Spline(start, pending.points, pending.stamp_ns or now_ns, self._interpolate)
        return Motion(spline, now_ns, pending.held, self.interfaces, self._ahead_ns)

    # -- one update --------------------------------------------------------------------------------------------------

    def update(self, cycle: Cycle) -> None:
        """Do one cycle."""
        measured = self.interfaces.read_states(cycle.time_ns)
        self._factor = self.scaling.read()
        first = self._pending is not None
        if self._pending is not None:
            self._motion, self._pending = self._start(self._pending, measured), None
        motion = self._motion
        assert motion is not None, "an active controller always has a trajectory, at least one to hold"
        if not first:
            motion.time_ns += int(cycle.period_ns * self._factor)
        samples = motion.sample(np.array([motion.time_ns], dtype=np.int64))
        self.last = LastUpdate(cycle.time_ns, measured, samples)
        if motion.held:
            self._command(samples, cycle)
        else:
            self._supervise(motion, samples, cycle, first)
        if self.recorder is not None:
            self.recorder.add_update(cycle.time_ns, samples, measured.position, self._present_commands())

    def _supervise(self, motion: Motion, samples: Samples, cycle: Cycle, first: bool) -> None:
        """Check tolerances, command unless they are violated, decide the goal."""
        state, tolerances = self.context.table.state[None, :], self.goals.tolerances
        ended = samples.next_reached[0] == motion.spline.count
        overtime = float(motion.overtime_s(samples)[0])
        rows = slice(0, 1)
        if ended and 0.0 < self._timeout_s < overtime:
            self.context.log.warn(self.context.name, "Aborted due to command timeout")
            self.hold()
            # From here on nothing is checked any more, so that the goal counts as reached.
            self._command(samples, cycle)
            self._end(motion, cycle.time_ns, violated=False, ended=True, outside=False, late=0.0)
            return
        path = motion.violated(tolerances.path, samples, state, rows)[0]
        violated = bool((not ended or first) and path.any())
        outside = bool(ended and motion.violated(tolerances.goal, samples, state, rows).any())
        late = overtime if outside and tolerances.goal_time_s != 0.0 and overtime > tolerances.goal_time_s else 0.0
        if violated or late:
            self._tell_violation(samples, violated)
        else:
            self._command(samples, cycle)
        self._end(motion, cycle.time_ns, violated, bool(ended), outside, late)

    def _end(self, motion: Motion, now_ns: int, violated: bool, ended: bool, outside: bool, late: float) -> None:
        """Decide the goal, or hold where a trajectory of the topic failed."""
        log, name, goals = self.context.log, self.context.name, self.goals
        if violated:
            if goals.running:
                goals.abort(now_ns, -4, "Aborted due to path tolerance violation")
                log.warn(name, "Aborted due to state tolerance violation")
            else:
                log.error(name, "Holding position due to state tolerance violation")
            self.stop()
        elif ended and not outside and goals.running:
            goals.succeed(now_ns)
            log.info(name, "Goal reached, success!")
            self._hold_end(motion)
        elif ended and late:
            text = f"Aborted due to goal_time_tolerance exceeding by {late:f} seconds"
            if goals.running:
                goals.abort(now_ns, -5, text)
                log.warn(name, text)
            else:
                log.error(name, "Exceeded goal_time_tolerance: holding position...")
            self.stop()

    def _tell_violation(self, samples: Samples, path: bool) -> None:
        tolerance = self.goals.tolerances.path if path else self.goals.tolerances.goal
        error = self.interfaces.difference(samples.desired[0], self.last.measured.position)
        for index, value in enumerate(error.tolist()):
            if abs(value) > tolerance.position[index]:
                self.context.log.error("tolerances", f"State tolerances failed for joint {index}:")
                self.context.log.error(
                    "tolerances",
                    f"Position Error: {value:f}, Position Tolerance: {tolerance.position[index]:f}",
                )

    def _command(self, samples: Samples, cycle: Cycle) -> None:
        motion, places = self._motion, self.interfaces.commands
        assert motion is not None
        velocity = motion.spline.velocities(samples.next_reached, samples.next_into)[0]
        acceleration = motion.spline.accelerations(samples.next_reached, samples.next_into)[0]
        if self._pids:
            self._command_pid(samples, velocity, cycle)
        else:
            values = {"position": samples.next[0], "velocity": velocity, "acceleration": acceleration}
            for kind, columns in places.items():
                wanted = values.get(kind, np.zeros(len(columns)))
                for column, value in zip(columns.tolist(), wanted.tolist(), strict=False):
                    self.context.command(column, value)
        self._commanded = StartState(motion.time_ns, samples.next[0], velocity, acceleration)

    def _command_pid(self, samples: Samples, velocity: Sequence[float], cycle: Cycle) -> None:
        measured = self.last.measured
        error = self.interfaces.difference(samples.desired[0], measured.position)
        rate = samples.desired_velocity[0] - (0.0 if measured.velocity is None else measured.velocity)
        ((_, columns),) = self.interfaces.commands.items()
        for index, column in enumerate(columns.tolist()):
            pid = self._pids[index]
            correction = pid.command(float(error[index]), float(rate[index]), cycle.period_ns / 1e9)
            self.context.command(column, float(velocity[index]) * pid.feed_forward + correction)

    def _present_commands(self) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        columns = next(iter(self.interfaces.commands.values()))
        return self.context.table.command[columns]

    # -- blocks ------------------------------------------------------------------------------------------------------

    def preview(self, block: Block) -> int:
        """Sample the trajectory for all cycles of the block."""
        motion = self._motion
        if motion is None or self._pending is not None or self._pids:
            return 0
        self._factor = self.scaling.factor
        step = int(block.period_ns * self._factor)
        times = motion.time_ns + step * np.arange(1, len(block) + 1, dtype=np.int64)
        samples = motion.sample(times)
        self._preview = samples
        for kind, columns in self.interfaces.commands.items():
            if kind == "position":
                block.command[:, columns] = samples.next[:, : len(columns)]
            elif kind == "velocity":
                block.command[:, columns] = motion.spline.velocities(samples.next_reached, samples.next_into)
            elif kind == "acceleration":
                block.command[:, columns] = motion.spline.accelerations(samples.next_reached, samples.next_into)
            else:
                block.command[:, columns] = 0.0
        return len(block)

    def regular(self, block: Block) -> int:
        """Cycles before a tolerance is violated, a goal ends or the speed scaling changes."""
        motion, samples = self._motion, self._preview
        assert motion is not None
        assert samples is not None
        cycles = self.scaling.unchanged(block)
        if motion.held or cycles == 0:
            return cycles
        return min(
            cycles,
            regular_updates(motion, samples, block.state, self.goals.tolerances, self.goals.running, self._timeout_s),
        )

    def commit(self, block: Block, start: int) -> None:
        """Adopt the previewed updates of the block."""
        motion, samples = self._motion, self._preview
        assert motion is not None
        assert samples is not None
        row = len(block) - 1
        motion.time_ns = int(samples.times_ns[row])
        places, state = self.interfaces.states, block.state[row]
        time_ns = int(block.times_ns[row])
        measured = StartState(
            time_ns,
            state[places["position"]],
            state[places["velocity"]] if "velocity" in places else None,
            state[places["acceleration"]] if "acceleration" in places else None,
        )
        self.last = LastUpdate(time_ns, measured, samples, row)
        if self._from_desired:
            reached, into = samples.next_reached[row : row + 1], samples.next_into[row : row + 1]
            velocity = motion.spline.velocities(reached, into)[0]
            acceleration = motion.spline.accelerations(reached, into)[0]
            self._commanded = StartState(motion.time_ns, samples.next[row], velocity, acceleration)
        if self.recorder is not None:
            columns = next(iter(self.interfaces.commands.values()))
            self.recorder.add_block(block, start, samples, places["position"], columns)

    # -- outside -----------------------------------------------------------------------------------------------------

    def next_monitor_ns(self) -> int | None:
        """The next tick of an action monitor with something to deliver."""
        return self.goals.next_monitor_ns()

    def monitor(self, now_ns: int) -> None:
        """Deliver results and feedback."""
        self.goals.deliver(now_ns, self.last, self._motion, self.interfaces)

    def query_state(self, time_ns: int) -> TrajectoryStateResponse:
        """Sample the running trajectory at a time; unsuccessful where none runs or the time lies outside it."""
        motion = self._motion
        if not self.active or motion is None or motion.held or time_ns < motion.spline.before_ns:
            if not self.active:
                self.context.log.error(self.context.name, "Can't sample trajectory. Controller is not active.")
            return TrajectoryStateResponse(False)
        reached, into = motion.spline.locate(np.array([time_ns], dtype=np.int64))
        if reached[0] == motion.spline.count:
            return TrajectoryStateResponse(False)
        return TrajectoryStateResponse(
            True,
            self.interfaces.joints,
            tuple(motion.spline.positions(reached, into)[0].tolist()),
            tuple(motion.spline.velocities(reached, into)[0].tolist()),
            tuple(motion.spline.accelerations(reached, into)[0].tolist()),
        )
