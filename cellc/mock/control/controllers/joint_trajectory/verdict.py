"""What one update finds: still on the way, a tolerance violated, the end reached, too late."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.control.controllers.base import Context
from cellc.mock.control.controllers.joint_trajectory.goals import GoalBook
from cellc.mock.control.controllers.joint_trajectory.motion import Motion, Samples
from cellc.mock.control.controllers.joint_trajectory.tolerances import Tolerances
from cellc.mock.control.interfaces import Array


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
