"""Finds the layer in which a step failed, from what the cell published; what the task said is only quoted.

The order of the checks is that in which one failure hides another: a stopped robot aborts goals, stale states and
aborted goals make a task cancel.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.contract.attempt import Layer
from cellc.contract.diagnostics.wording import both
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome, Need
from cellc.mock.task.bounds import action_timeout_s, goal_timeout_s, grip_timeout_s, joint_state_age_s
from cellc.mock.task.execute import RESPONSE_S
from cellc.tools.attempt.follow import ABORTED, CANCELED, HOLDS, Goal
from cellc.tools.attempt.grips import gripped_wrong, undone
from cellc.tools.attempt.record import Finding
from cellc.tools.attempt.scene import NORMAL, STOPS, Scene, safety_at
from cellc.tools.attempt.steps import Made, needed

_ERROR = 40
_ANSWER_NS = round(RESPONSE_S * 1e9)
_GRACE_NS = 500_000_000
"""How long after the last goal of a step what ended it may be reported."""


def find(scene: Scene, made: Made) -> Finding | None:
    """Return where a step failed; None where nothing says that it did."""
    if made.goals and made.is_good and not made.foreign:
        late = None if scene.task_line() is None else _stale(scene, made)
        return late or gripped_wrong(scene, made) or undone(scene, made)
    if not made.goals and not made.plans and scene.task_line() is None:
        return None
    is_open = bool(needed(scene.contract, made.entry)) and not made.goals if made.entry is not None else False
    failed = not made.is_good or scene.task_line() is not None or gripped_wrong(scene, made) is not None
    if not failed and not made.foreign and not _plan_failed(made):
        if is_open and made.plans:
            return Finding(Layer.UNKNOWN, None, made.plans[-1].accepted_ns, "", "it was planned, and no goal followed")
        return None
    for check in _CHECKS:
        finding = check(scene, made)
        if finding is not None:
            return finding
    line = scene.task_line()
    text = "nothing of the bag says why" if line is None else f"{line.node}: {line.text}"
    return Finding(Layer.UNKNOWN, None, scene.until_ns if line is None else line.at_ns, "/rosout", text)


def _stopped(scene: Scene, made: Made) -> Finding | None:
    line = scene.task_line()
    at_ns = max(scene.last(made).at_ns + _GRACE_NS, 0 if line is None else line.at_ns)
    state, words, since_ns = safety_at(scene.contract, scene.followed, scene.components, min(at_ns, scene.until_ns))
    if state is None or state == NORMAL:
        return None
    return Finding(Layer.STOP, STOPS.get(state), since_ns, "what devices report", words)


def _cycles(scene: Scene, made: Made) -> Finding | None:
    allowed = scene.contract.kpis.missed_cycles
    end = scene.followed.end  # diagnostics are published once a second, and joint states alone may be lost on the way
    missed = min(end.missed, end.gaps)
    if allowed is None or missed <= allowed:
        return None
    text = f"{missed} update cycles missed, {allowed:g} allowed"
    return Finding(Layer.CYCLE, AttemptOutcome.MISSED_CYCLE, scene.last(made).at_ns, "/diagnostics", text)


def _owned(scene: Scene, made: Made) -> Finding | None:
    for goal in made.foreign:
        text = f"a second goal, {goal.goal_id}, was accepted while {made.goals[-1].goal_id} executed"
        source = f"{goal.action.name}/_action/status"
        return Finding(Layer.OWNER, AttemptOutcome.WRONG_OWNER, goal.accepted_ns, source, text)
    ours = {goal.action.controller for goal in made.goals} or scene.controllers
    for change in scene.followed.changes:
        during = scene.from_ns <= change.at_ns <= scene.until_ns
        if during and change.kind == Need.PROGRAM_RUNNING and change.state != HOLDS:
            text = f"the program of {change.subject} does not run: {change.state}"
            return Finding(Layer.OWNER, AttemptOutcome.CLAIM_FAILURE, change.at_ns, change.topic, text)
        if during and change.kind == "Controllers" and change.subject in ours and change.state != "active":
            text = f"controller {change.subject} became {change.state} meanwhile"
            return Finding(Layer.OWNER, AttemptOutcome.CLAIM_FAILURE, change.at_ns, "/diagnostics", text)
    return None


def _aborted(scene: Scene, made: Made) -> Finding | None:
    for goal in made.goals:
        if goal.status != ABORTED or goal.ended is None:
            continue
        said = [line for line in scene.lines() if line.node == goal.action.controller and line.level >= _ERROR]
        text = said[-1].text if said else f"its state is aborted; largest error {goal.worst_error:.3g} rad or m"
        source = "/rosout" if said else f"{goal.action.name}/_action/status"
        replaced = text.startswith("-1")  # INVALID_GOAL of FollowJointTrajectory: replaced, or deactivated
        layer = Layer.OWNER if replaced else Layer.TOLERANCE
        outcome = AttemptOutcome.WRONG_OWNER if replaced else AttemptOutcome.TOLERANCE_VIOLATION
        return Finding(layer, outcome, goal.ended.at_ns, source, f"{goal.action.controller}: {text}")
    return None


def _plan_failed(made: Made) -> bool:
    return not made.goals and any(plan.status == ABORTED for plan in made.plans)


def _planned(scene: Scene, made: Made) -> Finding | None:
    said = [line for line in scene.lines() if line.node == scene.planner and line.level >= _ERROR]
    if not said and (not _plan_failed(made) or _unanswered(scene, made) is not None):
        return None
    plan = made.plans[-1] if made.plans else None
    at_ns = said[-1].at_ns if said else (plan.ended_ns or plan.accepted_ns) if plan else scene.until_ns
    text = said[-1].text if said else "the goal of the planner was aborted, and no controller got one"
    return Finding(Layer.PLANNING, AttemptOutcome.PLANNING_FAILURE, at_ns, "/rosout" if said else "status", text)


def _rejected(scene: Scene, made: Made) -> Finding | None:
    if made.goals or made.entry is None:
        return None
    wanted = needed(scene.contract, made.entry)
    for line in scene.lines():
        if line.node in wanted and line.level >= _ERROR:
            text = f"{line.node}: {line.text}"
            return Finding(Layer.REJECTION, AttemptOutcome.GOAL_REJECTION, line.at_ns, "/rosout", text)
    return None


def _stale(scene: Scene, made: Made) -> Finding | None:
    """Look at the ages as the task gave up: when it canceled, or when it said so."""
    seen = scene.last(made)
    allowed_s = joint_state_age_s(scene.contract)
    for jump in scene.followed.jumps:
        if scene.from_ns <= jump.at_ns <= seen.at_ns + _GRACE_NS and jump.by_s > allowed_s:
            text = f"stamps of {jump.topic} are {jump.by_s:.3f} s ahead of those before: a clock was set"
            return Finding(Layer.STALE, AttemptOutcome.STALE_STATE, jump.at_ns, jump.topic, text)
    if seen.joints_ns is not None and abs(seen.at_ns - seen.joints_ns) / 1e9 > allowed_s:
        age, allowed = both((seen.at_ns - seen.joints_ns) / 1e9, allowed_s)
        text = f"joint state is {age} s old, {allowed} s allowed"
        return Finding(Layer.STALE, AttemptOutcome.STALE_STATE, seen.at_ns, "joint states", text)
    for frame, most_s in _acted_on(scene, made).items():
        stamp_ns = seen.observed.get(frame)
        if stamp_ns is None or (seen.at_ns - stamp_ns) / 1e9 >= most_s:
            age, allowed = both(0.0 if stamp_ns is None else (seen.at_ns - stamp_ns) / 1e9, most_s)
            told = "never observed" if stamp_ns is None else f"{age} s old"
            text = f"newest observation of {frame} is {told}, {allowed} s allowed"
            return Finding(Layer.STALE, AttemptOutcome.STALE_STATE, seen.at_ns, f"observations of {frame}", text)
    return None


def _acted_on(scene: Scene, made: Made) -> Mapping[str, float]:
    """Return the dynamic frame that a step rests on, with the oldest age of its observation in s."""
    if made.entry is None:
        return {}
    contract = scene.contract
    goal = contract.goals.get(made.entry.target)
    frame = None if goal is None else goal.frame
    if made.entry.kind is StepKind.DETECT:
        frame = made.entry.target
    elif made.entry.kind is StepKind.GRIP:
        frame = scene.acting_on
    while frame is not None and frame in contract.frames:
        entry = contract.frames[frame]
        if entry.kind == "dynamic":
            ages = (each.max_age_s for each in contract.interfaces.values() if each.frame == entry.parent)
            return {frame: min((age for age in ages if age is not None), default=float("inf"))}
        frame = entry.parent
    return {}


def _ended(scene: Scene, made: Made) -> Finding | None:
    """Tell a goal that was canceled, or never ended."""
    for goal in made.goals:
        source = f"{goal.action.name}/_action/status"
        end_ns = goal.ended_ns or scene.until_ns
        if goal.status == CANCELED or goal.canceling is not None or not goal.is_over:
            asked_ns = goal.canceling.at_ns if goal.canceling is not None else end_ns
            if _is_late(scene, goal, asked_ns):
                text = f"no result within {(asked_ns - goal.accepted_ns) / 1e9:.3g} s"
                return Finding(Layer.TIMEOUT, AttemptOutcome.TIMEOUT, asked_ns, source, text)
            if goal.is_over:
                text = "a client canceled it, and nothing else of the cell had failed"
                return Finding(Layer.CANCEL, AttemptOutcome.CANCELED, asked_ns, source, text)
    return None


def _is_late(scene: Scene, goal: Goal, at_ns: int) -> bool:
    controller = goal.action.controller
    bounds: tuple[float | None, ...] = (
        goal_timeout_s(scene.contract, controller),
        action_timeout_s(scene.contract),
    )
    if goal.action.gripper:
        bounds = (grip_timeout_s(scene.contract, controller),)
    stated = [bound for bound in bounds if bound is not None]
    return bool(stated) and (at_ns - goal.accepted_ns) / 1e9 >= min(stated)


def _unanswered(scene: Scene, made: Made) -> Finding | None:
    """Tell a goal that was due and that its server neither accepted nor rejected."""
    line = scene.task_line()
    if made.goals or made.entry is None or line is None:
        return None
    wanted = needed(scene.contract, made.entry)
    if made.entry.kind is StepKind.MOVE and not made.plans:
        wanted = (scene.planner,) if scene.planner else ()
    for controller in wanted:
        if any(each.node == controller for each in scene.lines()):
            continue
        began_ns = made.plans[-1].accepted_ns if made.plans else scene.from_ns
        if line.at_ns - began_ns >= _ANSWER_NS:
            text = f"{controller} neither accepted nor rejected a goal; {line.node}: {line.text}"
            return Finding(Layer.TIMEOUT, AttemptOutcome.TIMEOUT, line.at_ns, "/rosout", text)
    return None


def _unsent(scene: Scene, made: Made) -> Finding | None:
    """Tell a step whose goal was never sent though nothing was stale: what was planned could not be located."""
    if made.goals or made.entry is None or made.entry.target not in scene.contract.goals or made.plans:
        return None
    line = scene.task_line()
    if line is None:
        return None
    return Finding(Layer.TF, AttemptOutcome.TF_FAILURE, line.at_ns, "/rosout", f"{line.node}: {line.text}")


_CHECKS: tuple[Callable[[Scene, Made], Finding | None], ...] = (
    _stopped,
    _cycles,
    _rejected,
    _owned,
    _aborted,
    _planned,
    _stale,
    gripped_wrong,
    _ended,
    _unanswered,
    _unsent,
)
