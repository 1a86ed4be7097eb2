"""Makes the record of each step from what was followed; what no topic shows is UNKNOWN with what would show it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.contract.attempt import CancelRecord, Layer, PacketStep, ResultRecord, TracePoint
from cellc.contract.contract import Contract, ContractBand
from cellc.contract.rehearsals import StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.task.bounds import planning_server
from cellc.mock.task.move import dynamic_ancestor
from cellc.tools.attempt.follow import ABORTED, CANCELED, SUCCEEDED, Followed, Goal, Snapshot
from cellc.tools.attempt.grips import band_of
from cellc.tools.attempt.layer import find
from cellc.tools.attempt.record import Attempt
from cellc.tools.attempt.scene import NORMAL, STOPPED, Scene, safety_at
from cellc.tools.attempt.steps import Made, Pile, goes_on, needed

_STATUS = {SUCCEEDED: "succeeded", CANCELED: "canceled", ABORTED: "aborted"}
_SETTLED_NS = 100_000_000
"""How long after its last goal a task takes to find that a step did not do what its goals did."""
_RESULT = "the result of an action travels in its service get_result, which no distribution here lets a bag record"
_PLANNING = "status of the planning action, `/move_action/_action/status`"


class Deriver:
    """Walks the steps of a task along the goals of a bag."""

    def __init__(self, contract: Contract, followed: Followed, stem: str, task: str | None) -> None:
        """Bind what was followed.

        Args:
            stem: name of the bag, which attempts are numbered under.
            task: name of the rehearsal whose steps the task made; None where it is not known.
        """
        self._contract = contract
        self._followed = followed
        self._stem = stem
        self._task = task
        self._pile = Pile(followed)
        components = {each.hardware_component for each in contract.devices.values() if each.hardware_component}
        self._components = frozenset((*components, *contract.adapters))
        self._controllers = frozenset(name for each in contract.managers.values() for name in each.controllers)
        self._bands: dict[str, ContractBand] = {}
        self._now_ns: int | None = None
        self._detected: dict[str, int] = {}
        self._said_ns = -1
        self._is_vague = False
        self._acting_on: str | None = None

    def attempts(self, steps: Sequence[StepEntry]) -> list[Attempt]:
        """Return the records of the steps, and one that sums up."""
        made = self._by_task(steps) if steps else map(self._one, self._pile.take_any())
        attempts = list(made)
        attempts.append(self._sum(attempts))
        return attempts

    def _by_task(self, steps: Sequence[StepEntry]) -> Iterator[Attempt]:
        for number, step in enumerate(steps, start=1):
            made = self._pile.take(self._contract, number, step)
            attempt = self._one(made, steps[number:])
            failed = attempt.finding is not None
            if not failed and needed(self._contract, step) and not made.goals and not made.plans:
                return  # the bag ends before it
            yield attempt
            if (failed and not goes_on(steps[number:])) or (not failed and self._is_over(attempt)):
                return

    def _is_over(self, attempt: Attempt) -> bool:
        """Tell whether the bag ends before the next step, because nothing of it was seen."""
        return "ended_ns" in attempt.unknown and not self._is_vague

    def _one(self, made: Made, later: Sequence[StepEntry] = ()) -> Attempt:
        """Return the record of one step."""
        attempt = self._begin(made.number, made.title)
        was_vague, self._is_vague = self._is_vague, False
        attempt.started_ns = self._now_ns if self._now_ns is not None else _planned_ns(made)
        if made.entry is not None and made.entry.kind is StepKind.GRIP:
            self._bands.pop(made.entry.target, None)
        scene = self._scene(made, max(attempt.started_ns or self._followed.begin_ns, self._said_ns + 1))
        attempt.finding = find(scene, made)
        self._fill_goal(attempt, made)
        self._fill_action(attempt, made)
        self._end(attempt, made, scene, later)
        self._fill_safety(attempt, made)
        self._note_part(made, attempt)
        self._note_acting(made)
        self._now_ns = attempt.ended_ns if attempt.ended_ns is not None else self._now_ns
        for name, is_vague in (("started_ns", was_vague), ("ended_ns", self._is_vague)):
            if is_vague:
                setattr(attempt, name, None)
                attempt.lack(name, "what the task does between an observation and the next plan: it publishes nothing")
        return attempt

    def _begin(self, number: int, step: str) -> Attempt:
        return Attempt(
            attempt_id=f"{self._stem}-{number:03d}",
            rehearsal=self._task,
            step=step,
            configuration_id=self._contract.configuration_id,
            version_tuple=self._contract.version_tuple,
        )

    def _scene(self, made: Made, from_ns: int) -> Scene:
        next_ns = self._pile.next_ns()
        if made.goals and made.is_good and made.last_ns is not None:  # what fails later is another step
            settled_ns = made.last_ns + _SETTLED_NS
            next_ns = settled_ns if next_ns is None else min(settled_ns, next_ns)
        return Scene(
            self._contract,
            self._followed,
            from_ns,
            self._followed.end.at_ns if next_ns is None else next_ns,
            tuple(self._bands.values()),
            self._components,
            self._controllers,
            planning_server(self._contract),
            self._acting_on,
        )

    def _fill_goal(self, attempt: Attempt, made: Made) -> None:
        """Fill in where the goal is, and what its transforms rest on."""
        entry = made.entry
        if entry is None:
            for name in ("goal_frame", "goal_stamp", "calibration_id", "tf_lookup_age"):
                attempt.lack(name, "the steps of the task: name them with `--task`")
            return
        if entry.kind is StepKind.DETECT:
            self._detect(attempt, entry.target)
        if entry.kind is not StepKind.MOVE or entry.target not in self._contract.goals:
            return
        goal = self._contract.goals[entry.target]
        base = self._contract.groups[goal.group].base_link
        attempt.goal_frame = goal.frame
        tip = self._contract.groups[goal.group].tip_frame
        edges = {*_path(self._contract, base, goal.frame), *_path(self._contract, base, tip)}
        attempt.calibration_id = _calibrations(self._contract, edges)
        observed = dynamic_ancestor(self._contract, goal.frame)
        before = made.plans[0].before if made.plans else None
        attempt.goal_stamp = self._goal_stamp(before, observed, goal.transform_at, base, goal.frame)
        if attempt.goal_stamp is None:
            attempt.lack("goal_stamp", _PLANNING)
        if observed is not None and attempt.goal_stamp is not None:
            attempt.trace += (TracePoint(PacketStep.OBSERVED, attempt.goal_stamp),)
        if before is None:
            attempt.lack("tf_lookup_age", _PLANNING)
        elif attempt.goal_stamp is not None:
            attempt.tf_lookup_age = (before.at_ns - attempt.goal_stamp) / 1e9
            attempt.trace += (TracePoint(PacketStep.TRANSFORMED, before.at_ns),)

    def _detect(self, attempt: Attempt, frame: str) -> None:
        attempt.goal_frame = frame
        seen = self._newest(frame, self._now_ns)
        if seen is None:
            attempt.lack("goal_stamp", f"observations of {frame}")
            return
        self._detected[frame] = attempt.goal_stamp = seen
        attempt.trace += (TracePoint(PacketStep.OBSERVED, seen),)

    def _detected_ns(self, frame: str, started_ns: int) -> int | None:
        """Return when a detection had an observation that is young enough: as it began, or as one arrived."""
        ages = (most_s for each, most_s in self._followed.allowed.values() if each == frame and most_s is not None)
        most_s = min(ages, default=float("inf"))
        history = self._followed.observed.get(frame, [])
        arrived = [stamp_ns for log_ns, stamp_ns in history if log_ns <= started_ns]
        if arrived and (started_ns - arrived[-1]) / 1e9 < most_s:
            return started_ns
        return next((at for at, ns in history if at > started_ns and (at - ns) / 1e9 < most_s), None)

    def _newest(self, frame: str, at_ns: int | None) -> int | None:
        """Return the stamp of the newest observation that had arrived, or of the first one after."""
        history = self._followed.observed.get(frame, [])
        arrived = [stamp_ns for log_ns, stamp_ns in history if at_ns is None or log_ns <= at_ns]
        later = [stamp_ns for log_ns, stamp_ns in history if at_ns is not None and log_ns > at_ns]
        return arrived[-1] if arrived else later[0] if later else None

    def _goal_stamp(
        self, before: Snapshot | None, observed: str | None, transform_at: str, base: str, frame: str
    ) -> int | None:
        """Return the stamp that the transforms of a goal were looked up at."""
        if observed is not None and transform_at != "latest":
            return self._detected.get(observed, self._newest(observed, self._now_ns))
        if before is None:
            return None
        path = _path(self._contract, base, frame)
        moving = [stamp_ns for child, stamp_ns in before.edges.items() if child in path]
        stamps = moving if transform_at == "latest" and moving else [*moving, before.joints_ns]
        return min((each for each in stamps if each is not None), default=None)

    def _fill_action(self, attempt: Attempt, made: Made) -> None:
        """Fill in what was planned, sent, and returned."""
        is_move = made.entry is None or made.entry.kind is StepKind.MOVE
        if is_move:
            self._fill_plan(attempt, made)
        for goal in made.goals:
            attempt.controller_name = goal.action.controller
            attempt.action_goal_id = goal.goal_id
            attempt.speed_scaling = goal.scaling if goal.action.scales else None
            if goal.action.scales and goal.scaling is None:
                attempt.lack("speed_scaling", "its topic, or a controller state that states it (jazzy and later)")
            marks = tuple(_marks(goal, planned=is_move and not goal.action.gripper))
            attempt.trace += tuple(
                mark for mark in marks if mark.step is not PacketStep.PLANNED or mark not in attempt.trace
            )
            self._fill_result(attempt, goal)
            if goal.written_ns is None:
                attempt.lack("trace", "joint states after the acceptance of its goal")
        if attempt.finding is not None and made.entry is not None and not made.goals:
            self._lack_answer(attempt, made.entry)
        if len(made.goals) > 1 and made.entry is not None and made.entry.command == "together" and made.is_good:
            attempt.controller_name = " and ".join(goal.action.controller for goal in made.goals)
        attempt.trace = tuple(sorted(attempt.trace, key=lambda point: point.step.value))

    def _lack_answer(self, attempt: Attempt, entry: StepEntry) -> None:
        """Note what a goal leaves open that no server accepted: it may have been sent, and no state says so."""
        wanted = needed(self._contract, entry)
        layer = None if attempt.finding is None else attempt.finding.layer
        if wanted and layer not in (Layer.PLANNING, Layer.STALE, Layer.TF):
            for name in ("controller_name", "action_goal_id", "speed_scaling", "trace"):
                attempt.lack(name, "goals that are not accepted: they have no state, and requests are not recorded")

    def _fill_plan(self, attempt: Attempt, made: Made) -> None:
        if made.plans and made.plans[-1].before.joints_ns is not None:
            before = made.plans[-1].before
            attempt.joint_state_age = (before.at_ns - (before.joints_ns or 0)) / 1e9
        else:
            attempt.lack("joint_state_age", f"{_PLANNING}, and joint states")
        if made.goals:
            attempt.plan_result = "success"
        elif attempt.finding is not None and attempt.finding.layer is Layer.PLANNING:
            attempt.plan_result = attempt.finding.message
            attempt.trace += (TracePoint(PacketStep.PLANNED, attempt.finding.at_ns),)
        else:
            attempt.lack("plan_result", f"{_PLANNING}, and /rosout")

    def _fill_result(self, attempt: Attempt, goal: Goal) -> None:
        if goal.ended is not None:
            attempt.result = ResultRecord(_STATUS.get(goal.status, "unknown"), None, "", goal.ended.at_ns)
            attempt.lack("result.error_code", _RESULT)
            attempt.lack("result.error_string", _RESULT)
        else:
            attempt.lack("result", "the end of its goal: the recording ended before")
        if goal.canceling is not None:
            asked_ns, held_ns = goal.canceling.at_ns, goal.motion.held_ns
            latency_s = None if held_ns is None else (held_ns - asked_ns) / 1e9
            attempt.cancel = CancelRecord(asked_ns, held_ns, latency_s, 0)
            if held_ns is None:
                attempt.lack("cancel.held_ns", "joint states after the cancel request, at standstill")
                attempt.lack("cancel.latency_s", "joint states after the cancel request, at standstill")
        elif attempt.finding is not None:
            attempt.lack("cancel", "answers to cancel requests: a refused one leaves no state")

    def _end(self, attempt: Attempt, made: Made, scene: Scene, later: Sequence[StepEntry]) -> None:
        """Fill in outcome and end."""
        finding = attempt.finding
        line = scene.task_line()
        if finding is not None:
            attempt.outcome, attempt.fault_code = finding.outcome, finding.message if line is None else line.text
            attempt.ended_ns = finding.at_ns if line is None else line.at_ns
            self._said_ns = attempt.ended_ns
        elif made.goals and all(goal.is_over for goal in made.goals):
            attempt.outcome, attempt.fault_code, attempt.ended_ns = AttemptOutcome.SUCCEEDED, "", made.last_ns
        elif made.goals or made.plans:
            attempt.lack("ended_ns", "the end of its goal: the recording ended before")
        else:
            self._end_unseen(attempt, made, later)
        if attempt.outcome is None:
            attempt.lack("outcome", "what the task made of it: /rosout")
        if attempt.fault_code is None:
            attempt.lack("fault_code", "/rosout")
        if attempt.started_ns is None:
            attempt.lack("started_ns", "what the task does: it touches no recorded topic")

    def _end_unseen(self, attempt: Attempt, made: Made, later: Sequence[StepEntry]) -> None:
        """Fill in the end of a step without a goal: it ended before the next goal, or after the time that it waits."""
        next_ns = self._pile.next_ns()
        if made.entry is not None and made.entry.kind is StepKind.DETECT and attempt.started_ns is not None:
            attempt.ended_ns = self._detected_ns(made.entry.target, attempt.started_ns)
            moves_next = bool(later) and later[0].kind is StepKind.MOVE and next_ns is not None
            self._is_vague = moves_next and next_ns != attempt.ended_ns
        elif made.entry is not None and made.entry.duration_s is not None and attempt.started_ns is not None:
            attempt.ended_ns = attempt.started_ns + round(made.entry.duration_s * 1e9)
        elif next_ns is not None:
            waits_s = sum(step.duration_s or 0.0 for step in later[:1])
            attempt.ended_ns = next_ns - round(waits_s * 1e9)
        if attempt.ended_ns is None or (next_ns is None and not later):
            attempt.lack("ended_ns", "what the task does: it touches no recorded topic")
        else:
            attempt.outcome, attempt.fault_code = AttemptOutcome.SUCCEEDED, ""

    def _fill_safety(self, attempt: Attempt, made: Made) -> None:
        at_ns = attempt.ended_ns if attempt.ended_ns is not None else self._followed.end.at_ns
        attempt.safety_state, _, _ = safety_at(self._contract, self._followed, self._components, at_ns)
        if attempt.safety_state is None:
            attempt.lack("safety_state", "/diagnostics of the controller manager, or the vendor's safety state")
            attempt.lack("operator_intervention", "/diagnostics of the controller manager")
            return
        role = self._contract.safety.acknowledge
        stopped = attempt.safety_state != NORMAL
        if attempt.safety_state == STOPPED:
            attempt.safety_state = None
            attempt.lack(
                "safety_state", "the vendor's safety state: the component leaves active alike in several stops"
            )
        attempt.operator_intervention = f"required: acknowledge by {role}" if stopped else "none"
        if not stopped and attempt.outcome is AttemptOutcome.CLAIM_FAILURE:
            attempt.operator_intervention = f"required: program start, then a claim, by {role}"
        if made.entry is not None and made.entry.kind is StepKind.ACKNOWLEDGE and attempt.finding is None:
            attempt.operator_intervention = f"acknowledged by {made.entry.target}"

    def _note_acting(self, made: Made) -> None:
        """Note on which observations later steps rest: those of the last move, until a part is held."""
        entry = made.entry
        if entry is not None and entry.kind is StepKind.GRIP and entry.part is not None and made.is_good:
            self._acting_on = None
        elif entry is not None and entry.kind is StepKind.MOVE:
            goal = self._contract.goals.get(entry.target)
            self._acting_on = None if goal is None else dynamic_ancestor(self._contract, goal.frame)

    def _note_part(self, made: Made, attempt: Attempt) -> None:
        if made.entry is None or made.entry.kind is not StepKind.GRIP:
            return
        band = band_of(self._contract, made)
        if band is not None and attempt.finding is None:
            self._bands[made.entry.target] = band

    def _sum(self, attempts: Sequence[Attempt]) -> Attempt:
        end = self._begin(len(attempts) + 1, "end")
        if not attempts:
            for name in ("outcome", "fault_code", "started_ns", "ended_ns"):
                end.lack(name, "status of the actions of the cell")
            self._fill_safety(end, Made(0, None, end.step))
            return end
        last = attempts[-1]
        end.started_ns, end.ended_ns = attempts[0].started_ns, last.ended_ns
        end.outcome, end.fault_code, end.finding = last.outcome, last.fault_code, last.finding
        end.safety_state, end.operator_intervention = last.safety_state, last.operator_intervention
        if "started_ns" in attempts[0].unknown:
            end.lack("started_ns", attempts[0].unknown["started_ns"])
        shared = ("outcome", "fault_code", "ended_ns", "safety_state", "operator_intervention")
        end.unknown |= {name: last.unknown[name] for name in shared if name in last.unknown}
        return end


def _planned_ns(made: Made) -> int | None:
    """Return when the first step began: the bag tells where its first act is to have a motion planned."""
    return min((plan.accepted_ns for plan in made.plans), default=None)


def _marks(goal: Goal, *, planned: bool) -> Iterator[TracePoint]:
    """Yield the steps of the packet that a goal shows; it was planned at the latest when it was accepted."""
    if planned:
        yield TracePoint(PacketStep.PLANNED, goal.accepted_ns)
    yield TracePoint(PacketStep.GOAL_SENT, goal.accepted_ns)
    yield TracePoint(PacketStep.ACCEPTED, goal.accepted_ns)
    if goal.written_ns is not None:
        yield TracePoint(PacketStep.WRITTEN, goal.written_ns)
    if goal.motion.driven_ns is not None:
        yield TracePoint(PacketStep.DRIVEN, goal.motion.driven_ns)
    if goal.ended is not None:
        yield TracePoint(PacketStep.RETURNED, goal.ended.at_ns)


def _path(contract: Contract, target: str, source: str) -> set[str]:
    """Return the children of all edges between two frames."""
    return set(_to_root(contract, target)) ^ set(_to_root(contract, source))


def _to_root(contract: Contract, frame: str) -> Iterator[str]:
    for _ in range(len(contract.frames) + 1):
        if frame not in contract.frames or not contract.frames[frame].parent:
            return
        yield frame
        frame = contract.frames[frame].parent


def _calibrations(contract: Contract, edges: set[str]) -> tuple[str, ...]:
    """Return the calibrations of some edges, with revision."""
    names = {contract.frames[edge].calibration for edge in edges if edge in contract.frames}
    return tuple(
        f"{name}:{contract.calibrations[name].revision}"
        for name in sorted(name for name in names if name is not None)
        if name in contract.calibrations
    )
