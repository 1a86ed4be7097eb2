"""Lays the goals of a bag beside the steps of a task: which goals belong to which step, and which step has no goal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import StepEntry
from cellc.contract.steps import StepKind
from cellc.tools.attempt.follow import ABORTED, SUCCEEDED, Followed, Goal


@dataclass(slots=True)
class Made:
    """A step with what the bag has of it; ``entry`` is None where no task is known, and the goal alone is a step."""

    number: int
    entry: StepEntry | None
    title: str
    goals: list[Goal] = field(default_factory=list)
    plans: list[Goal] = field(default_factory=list)
    foreign: list[Goal] = field(default_factory=list)
    wanted: int = 0

    @property
    def is_good(self) -> bool:
        """Tell whether it had all its goals, one for each controller, and every one succeeded."""
        return len(self.goals) >= self.wanted and all(goal.status == SUCCEEDED for goal in self.goals)

    @property
    def last_ns(self) -> int | None:
        """When the last of its goals ended, or was seen."""
        ends = [goal.ended_ns or goal.accepted_ns for goal in (*self.goals, *self.plans)]
        return max(ends, default=None)


def needed(contract: Contract, step: StepEntry) -> tuple[str, ...]:
    """Return the controllers that take the goals of a step, in order; none of a step without goals."""
    if step.kind is StepKind.GRIP:
        device = contract.devices.get(step.target)
        controller = None if device is None or device.gripper is None else device.gripper.controller
        return () if controller is None else (controller,)
    if step.kind is not StepKind.MOVE:
        return ()
    if step.target in contract.goals:
        groups = [contract.goals[step.target].group]
    else:
        groups = [pose.group for pose in contract.poses.get(step.target, ())]
    controllers = (contract.groups[group].controller for group in groups)
    return tuple(controller for controller in controllers if controller is not None)


class Pile:
    """The goals of a bag that no step has taken yet, in the order of their acceptance."""

    def __init__(self, followed: Followed) -> None:
        """Begin with all of them."""
        self.goals = sorted(followed.goals, key=lambda goal: goal.accepted_ns)
        self.plans = sorted(followed.plans, key=lambda goal: goal.accepted_ns)

    def next_ns(self) -> int | None:
        """Return when the next goal was accepted that no step has taken; None where no goal is left."""
        return min((goal.accepted_ns for goal in (*self.goals[:1], *self.plans[:1])), default=None)

    def take(self, contract: Contract, number: int, step: StepEntry) -> Made:
        """Return a step of the task with its goals."""
        made = Made(number, step, step.title)
        made.wanted = len(needed(contract, step))
        for controller in needed(contract, step):
            _take(made, controller, self, together=step.command == "together")
        self._take_foreign(made)
        return made

    def _take_foreign(self, made: Made) -> None:
        """Take the goals that began while the step executed its own: a task sends one after the other."""
        begin_ns = min((goal.accepted_ns for goal in made.goals), default=0)
        until_ns = max((goal.ended_ns or 0 for goal in made.goals), default=0)
        foreign = [each for each in self.goals if begin_ns < each.accepted_ns < until_ns]
        made.foreign += foreign
        self.goals = [each for each in self.goals if each not in foreign]

    def take_any(self) -> Iterator[Made]:
        """Yield a step for each goal, where no task is known."""
        number = 0
        while self.goals or self.plans:
            number += 1
            name = self.goals[0].action.controller if self.goals else self.plans[0].action.name
            made = Made(number, None, f"goal of {name}")
            _take(made, name, self, together=False)
            yield made


def goes_on(later: Sequence[StepEntry]) -> bool:
    """Tell whether a task goes on after a stop, because a person acknowledges it later."""
    return any(step.kind is StepKind.ACKNOWLEDGE for step in later)


def _take(made: Made, controller: str, pile: Pile, *, together: bool) -> None:
    """Move the next goal of a controller into a step, with what was planned before it and what was sent into it."""
    if any(each.status != SUCCEEDED for each in made.goals) and not together:
        return
    goal = next((each for each in pile.goals if each.action.controller == controller), None)
    if made.entry is None or made.entry.kind is StepKind.MOVE:
        until_ns = None if goal is None else goal.accepted_ns
        planned = [each for each in pile.plans if until_ns is None or each.accepted_ns <= until_ns]
        made.plans += planned
        pile.plans = [each for each in pile.plans if each not in planned]
    if goal is None:
        return
    pile.goals.remove(goal)
    made.goals.append(goal)
    made.foreign += [each for each in pile.goals if _overlaps(each, goal)]
    pile.goals = [each for each in pile.goals if not _overlaps(each, goal)]


def _overlaps(other: Goal, goal: Goal) -> bool:
    """Tell whether a goal of the same action began while another one executed: of another client, or a replacement."""
    ends_ns = goal.ended_ns
    if other.action.name != goal.action.name or ends_ns is None:
        return other.action.name == goal.action.name
    return other.accepted_ns < ends_ns or (goal.status == ABORTED and other.accepted_ns == ends_ns)
