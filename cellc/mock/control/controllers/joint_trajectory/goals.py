"""Goals of the FollowJointTrajectory action, and what each update finds of the running one.

A goal is decided in an update (on the way, a tolerance violated, the end reached, too late); its result waits for a
tick of the action monitor.
"""

from __future__ import annotations

from collections.abc import Sequence

from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Feature, features
from cellc.mock.control.controllers.base import Context, GoalMonitor
from cellc.mock.control.controllers.joint_trajectory.interfaces import JointInterfaces
from cellc.mock.control.controllers.joint_trajectory.motion import (
    LastUpdate,
    Motion,
    Samples,
    Tolerances,
    goal_tolerances,
)
from cellc.mock.control.interfaces import Array
from cellc.mock.control.messages import ControlEvent, GoalStatus, TrajectoryEnded, TrajectoryFeedback, TrajectoryGoal


class GoalBook:
    """The goals of one controller.

    Args:
        context: the controller's context.
        joints: its joints.
        defaults: the controller's tolerances.
    """

    def __init__(self, context: Context, joints: Sequence[str], defaults: Tolerances) -> None:
        self._context = context
        self._joints = joints
        self.defaults = defaults
        self.tolerances = defaults
        self._period_ns = context.parameters.period_ns("action_monitor_rate")
        self._active: GoalMonitor | None = None
        self._waiting: list[GoalMonitor] = []

    @property
    def running(self) -> bool:
        """Whether a goal is being executed."""
        return self._active is not None

    @property
    def running_id(self) -> int:
        """Number of the running goal, 0 for none."""
        return 0 if self._active is None else self._active.goal_id

    def accept(self, goal_id: int, goal: TrajectoryGoal, now_ns: int, listened: bool) -> None:
        """Make a goal the running one; a goal that runs is aborted immediately."""
        if self._active is not None:
            known = features(self._context.distro)
            verb = "preempted by" if Feature.PREEMPTED_GOALS in known else "cancelled due to"
            preempted = self._active
            self._active = None
            text = f"Current goal {verb} new incoming action."
            self._emit(self._ended(preempted, now_ns, GoalStatus.ABORTED, -1, text, now_ns))
        self.tolerances = goal_tolerances(self.defaults, goal, self._joints, self._context.log, self._context.name)
        self._active = GoalMonitor(goal_id, now_ns, self._period_ns, listened)

    def succeed(self, now_ns: int) -> None:
        """Decide that the running goal succeeded."""
        self._decide(now_ns, GoalStatus.SUCCEEDED, 0, "Goal successfully reached!")

    def abort(self, now_ns: int, code: int, text: str) -> None:
        """Decide that the running goal is aborted."""
        self._decide(now_ns, GoalStatus.ABORTED, code, text)

    def cancel(self, now_ns: int) -> None:
        """Decide that the running goal is canceled."""
        self._decide(now_ns, GoalStatus.CANCELED, 0, "")

    def _decide(self, now_ns: int, status: GoalStatus, code: int, text: str) -> None:
        monitor = self._active
        assert monitor is not None, "only a running goal is decided"
        self._active = None
        monitor.decide(now_ns, lambda stamp_ns: self._ended(monitor, stamp_ns, status, code, text, now_ns))
        self._waiting.append(monitor)

    def _ended(
        self, monitor: GoalMonitor, stamp_ns: int, status: GoalStatus, code: int, text: str, decided_ns: int
    ) -> TrajectoryEnded:
        return TrajectoryEnded(stamp_ns, decided_ns, self._context.name, monitor.goal_id, status, code, text)

    def _emit(self, event: ControlEvent) -> None:
        self._context.events.append(event)

    def is_waiting(self, goal_id: int) -> bool:
        """Whether a goal is decided and its result not delivered yet."""
        return any(monitor.goal_id == goal_id for monitor in self._waiting)

    def next_monitor_ns(self) -> int | None:
        """The next time at which a result or feedback is pending."""
        if self.idle:
            return None
        monitors = [*self._waiting, *([self._active] if self._active else [])]
        due = [time for monitor in monitors if (time := monitor.next_ns()) is not None]
        return min(due, default=None)

    @property
    def idle(self) -> bool:
        """Whether no goal runs and no result waits for its tick."""
        return self._active is None and not self._waiting

    def deliver(self, now_ns: int, last: LastUpdate, motion: Motion | None, interfaces: JointInterfaces) -> None:
        """Deliver what is pending now."""
        for monitor in [m for m in self._waiting if m.next_ns() == now_ns]:
            event = monitor.tick(now_ns)
            self._waiting.remove(monitor)
            if event is not None:
                self._emit(event)
        monitor_active = self._active
        if monitor_active is not None and monitor_active.listened and monitor_active.next_ns() == now_ns:
            monitor_active.tick(now_ns)
            if last.samples is not None and motion is not None and last.time_ns >= monitor_active.accepted_ns:
                self._emit(self._feedback(monitor_active, now_ns, last, last.samples, motion, interfaces))

    def _feedback(
        self,
        monitor: GoalMonitor,
        now_ns: int,
        last: LastUpdate,
        samples: Samples,
        motion: Motion,
        interfaces: JointInterfaces,
    ) -> TrajectoryFeedback:
        desired, actual = samples.desired[last.row], last.measured.position
        return TrajectoryFeedback(
            now_ns,
            last.time_ns,
            self._context.name,
            monitor.goal_id,
            max(int(samples.next_reached[last.row]) - 1, 0),
            int(samples.times_ns[last.row]) - motion.spline.start_ns,
            tuple(desired.tolist()),
            tuple(actual.tolist()),
            tuple(interfaces.difference(desired, actual).tolist()),
        )


@dataclass(frozen=True, slots=True)
class Verdict:
    """The finding of one update.

    Attributes:
        violated: a path tolerance is violated.
        reached: the end is reached, inside the goal tolerances.
        late_s: time by which the goal time is exceeded, counted from the last point; 0 where it is not.
        timed_out: the command timeout has passed.
    """

    violated: bool = False
    reached: bool = False
    late_s: float = 0.0
    timed_out: bool = False

    @property
    def commands(self) -> bool:
        """Whether commands are written in this update."""
        return not self.violated and self.late_s == 0.0


def judge(
    motion: Motion, samples: Samples, state: Array, tolerances: Tolerances, first: bool, timeout_s: float
) -> Verdict:
    """Judge one update.

    Args:
        motion: the motion that is executed.
        samples: its sample of this update.
        state: all state interfaces.
        tolerances: tolerances in force.
        first: whether it is the first update of the trajectory, in which the path is checked even at the end.
        timeout_s: command timeout, 0 for none.
    """
    ended = bool(samples.next_reached[0] == motion.spline.count)
    overtime = float(motion.overtime_s(samples)[0])
    if ended and 0.0 < timeout_s < overtime:
        # Holding from here on, nothing is checked any more, so that the goal counts as reached.
        return Verdict(reached=True, timed_out=True)
    row, rows = state[None, :], slice(0, 1)
    if (not ended or first) and motion.violated(tolerances.path, samples, row, rows).any():
        return Verdict(violated=True)
    if not ended:
        return Verdict()
    if not motion.violated(tolerances.goal, samples, row, rows).any():
        return Verdict(reached=True)
    limit = tolerances.goal_time_s
    return Verdict(late_s=overtime if limit != 0.0 and overtime > limit else 0.0)


def tell_violation(context: Context, error: Array, goals: GoalBook, verdict: Verdict) -> None:
    """Log the joints that are outside their tolerance."""
    tolerance = goals.tolerances.path if verdict.violated else goals.tolerances.goal
    for index, value in enumerate(error.tolist()):
        if abs(value) > tolerance.position[index]:
            context.log.error("tolerances", f"State tolerances failed for joint {index}:")
            text = f"Position Error: {value:f}, Position Tolerance: {tolerance.position[index]:f}"
            context.log.error("tolerances", text)


def decide_failure(context: Context, goals: GoalBook, verdict: Verdict, now_ns: int) -> None:
    """Abort the goal, or only log where a trajectory of the topic failed."""
    log, name = context.log, context.name
    late = f"Aborted due to goal_time_tolerance exceeding by {verdict.late_s:f} seconds"
    if goals.running and verdict.violated:
        goals.abort(now_ns, -4, "Aborted due to path tolerance violation")
        log.warn(name, "Aborted due to state tolerance violation")
    elif goals.running:
        goals.abort(now_ns, -5, late)
        log.warn(name, late)
    elif verdict.violated:
        log.error(name, "Holding position due to state tolerance violation")
    else:
        log.error(name, "Exceeded goal_time_tolerance: holding position...")
