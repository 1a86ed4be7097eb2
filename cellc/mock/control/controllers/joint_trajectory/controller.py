"""The joint trajectory controller.

One `update` is: take over a new trajectory, read the state, sample the trajectory now and one period ahead, check
tolerances, command, decide the goal. Blocks repeat the same arithmetic for many updates in which nothing is decided.
"""

from __future__ import annotations

import numpy as np

from cellc.mock.control.controllers.base import Context, Cycle, QuietController
from cellc.mock.control.controllers.joint_trajectory.acceptance import AcceptanceRules, in_local_order
from cellc.mock.control.controllers.joint_trajectory.commands import JointCommands, SpeedScaling
from cellc.mock.control.controllers.joint_trajectory.declaration import declare
from cellc.mock.control.controllers.joint_trajectory.goals import GoalBook, decide_failure, judge, tell_violation
from cellc.mock.control.controllers.joint_trajectory.interfaces import JointInterfaces
from cellc.mock.control.controllers.joint_trajectory.motion import (
    LastUpdate,
    Motion,
    PendingTrajectory,
    Samples,
    default_tolerances,
    held_point,
    regular_updates,
    start_of,
    stop_points,
)
from cellc.mock.control.controllers.joint_trajectory.recorder import Recorder
from cellc.mock.control.controllers.joint_trajectory.spline import Spline, StartState
from cellc.mock.control.interfaces import Array, Block
from cellc.mock.control.journal import Cause
from cellc.mock.control.messages import Trajectory, TrajectoryStateResponse
from cellc.mock.control.parameters import ParameterValue


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
        self._commands = JointCommands(context, self.interfaces)
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
        self._pending = PendingTrajectory(held_point(self.last.measured.position), 0, held=True, interrupts=True)

    def stop(self) -> None:
        """Queue a stop: with the configured deceleration where there is one, otherwise a plain hold."""
        measured = self.last.measured
        decelerates = self.context.parameters.flag("constraints.decelerate_on_cancel")
        if not decelerates or not (self._stop > 0.0).all() or measured.velocity is None:
            self.hold()
            return
        points = stop_points(measured.position, measured.velocity, self._stop, self._ahead_ns)
        self._pending = PendingTrajectory(points, 0, held=True, interrupts=True)

    def _hold_end(self, motion: Motion) -> None:
        """Queue holding the last point of a trajectory, even if it has a velocity."""
        self._pending = PendingTrajectory((motion.spline.last_point(),), 0, held=True)

    def _start(self, pending: PendingTrajectory, measured: StartState) -> Motion:
        now_ns = measured.time_ns
        cause = cause_of(pending, self._motion, measured.position, self._commands.present())
        if cause is not None:
            self.context.table.journal.note(now_ns, self.context.name, cause, _lasting_ns(pending, cause))
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
            self._command(motion, samples, cycle)
        else:
            self._supervise(motion, samples, cycle, first)
        if self.recorder is not None:
            state = self.context.table.state
            self.recorder.add_update(cycle.time_ns, samples, state, self._commands.present(), self._factor)

    def _supervise(self, motion: Motion, samples: Samples, cycle: Cycle, first: bool) -> None:
        """Check tolerances, command unless they are violated, decide the goal."""
        context, goals = self.context, self.goals
        verdict = judge(motion, samples, context.table.state, goals.tolerances, first, self._timeout_s)
        if verdict.timed_out:
            context.log.warn(context.name, "Aborted due to command timeout")
            self.hold()
        if verdict.commands:
            self._command(motion, samples, cycle)
        else:
            error = self.interfaces.difference(samples.desired[0], self.last.measured.position)
            tell_violation(context, error, goals, verdict)
            decide_failure(context, goals, verdict, cycle.time_ns)
            context.table.journal.note(cycle.time_ns, context.name, Cause.UNWRITTEN)
            self.stop()
        if verdict.reached and goals.running:
            goals.succeed(cycle.time_ns)
            context.log.info(context.name, "Goal reached, success!")
            self._hold_end(motion)

    def _command(self, motion: Motion, samples: Samples, cycle: Cycle) -> None:
        self._commands.write(motion, samples, self.last.measured, cycle)
        self._remember_command(motion, samples, 0)

    def _remember_command(self, motion: Motion, samples: Samples, row: int) -> None:
        """Keep the commanded state where a next trajectory starts from it."""
        if self._from_desired:
            ahead = samples.next_reached[row : row + 1], samples.next_into[row : row + 1]
            velocity, acceleration = motion.spline.velocities(*ahead)[0], motion.spline.accelerations(*ahead)[0]
            self._commanded = StartState(motion.time_ns, samples.next[row], velocity, acceleration)

    # -- blocks ------------------------------------------------------------------------------------------------------

    @property
    def decides_next(self) -> bool:
        """With a trajectory to take over, or with commands that depend on what is measured."""
        return self._motion is None or self._pending is not None or self._commands.depend_on_state

    def expected_updates(self) -> int | None:
        """Updates up to the end of the trajectory that is executed."""
        assert self._motion is not None, "asked of one whose next update decides nothing"
        return self._motion.updates_left(self.scaling.factor)

    def preview(self, block: Block) -> int:
        """Sample the trajectory for all cycles of the block."""
        motion = self._motion
        assert motion is not None, "a block has only updates that decide nothing"
        self._factor = self.scaling.factor
        step = int(block.period_ns * self._factor)
        times = motion.time_ns + step * np.arange(1, len(block) + 1, dtype=np.int64)
        samples = motion.sample(times)
        self._preview = samples
        self._commands.preview(motion, samples, block)
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
        time_ns = int(block.times_ns[row])
        self.last = LastUpdate(time_ns, self.interfaces.read_states(time_ns, block.state[row]), samples, row)
        self._remember_command(motion, samples, row)
        if self.recorder is not None:
            self.recorder.add_block(block, start, samples, self._commands.columns(), self._factor)

    # -- outside -----------------------------------------------------------------------------------------------------

    def next_monitor_ns(self) -> int | None:
        """The next tick of an action monitor with something to deliver."""
        return self.goals.next_monitor_ns()

    def monitor(self, now_ns: int) -> None:
        """Deliver results and feedback; a controller that was never active has neither goals nor a last update."""
        if self.goals.idle:
            return
        self.goals.deliver(now_ns, self.last, self._motion, self.interfaces)

    def query_state(self, time_ns: int) -> TrajectoryStateResponse:
        """Sample the running trajectory at a time; unsuccessful where none runs or the time lies outside it."""
        if not self.active:
            self.context.log.error(self.context.name, "Can't sample trajectory. Controller is not active.")
        if not self.active or self._motion is None:
            return TrajectoryStateResponse(False)
        return self._motion.query(time_ns)


def _lasting_ns(pending: PendingTrajectory, cause: Cause) -> int:
    """Return for how long a command need not be smooth: to the end of a stop, or to the first point of a plan.

    A joint that sank between plan and start is brought to that point in the time that the plan has for less.
    """
    times = [point.time_from_start_ns for point in pending.points]
    if pending.interrupts:
        return times[-1]
    return next((time for time in times if time > 0), 0) if cause is Cause.OFF_COMMAND else 0


_SAME = 1e-9
"""rad or m: a measured position nearer than this to the command is the commanded one."""


def cause_of(pending: PendingTrajectory, motion: Motion | None, measured: Array, commanded: Array) -> Cause | None:
    """Tell why the command may step as a trajectory is taken over; None where it must go on smoothly.

    Args:
        pending: what is taken over.
        motion: what it follows.
        measured: measured positions, which it starts from.
        commanded: present commands of the first kind of interface.
    """
    if pending.interrupts:
        return Cause.HOLD if len(pending.points) == 1 else Cause.DECELERATION
    if pending.held:
        return None
    if motion is not None and not motion.held:
        return Cause.REPLACED
    steps = np.abs(measured[: len(commanded)] - commanded)
    return None if bool((steps <= _SAME).all()) else Cause.OFF_COMMAND
