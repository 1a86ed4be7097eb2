"""What the task shows of itself while it runs, and what may be asked of it; each value has one owner and few verbs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable

from cellc.contract.attempt import AttemptRecord
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Vector3
from cellc.mock.engine.process import Action, Signal


class TaskRequests:
    """What others ask of the task; the task looks whenever it wakes.

    Attributes:
        changed: fires when something is asked, or when the task must look at what it waits for.
    """

    def __init__(self) -> None:
        self.changed = Signal()
        self._cancels: set[str] = set()
        self._displaced: dict[str, Vector3] = {}

    def ask_cancel(self, kind: str, now_ns: int) -> None:
        """Ask to cancel the goal that a step of this kind executes, or the first that one executes from now on."""
        self._cancels.add(kind)
        self.changed.fire(now_ns)

    def withdraw_cancel(self, kind: str) -> None:
        """Take the request back, or note that it was carried out."""
        self._cancels.discard(kind)

    def is_cancel_asked(self, kind: str) -> bool:
        """Tell whether the goals of this kind of step are to be canceled."""
        return kind in self._cancels

    def displace_goal(self, goal: str, offset: Vector3) -> None:
        """Move a Cartesian goal by meters along the axes of its frame."""
        self._displaced[goal] = offset

    def restore_goal(self, goal: str) -> None:
        """Let a goal be where the contract places it."""
        self._displaced.pop(goal, None)

    def displacement(self, goal: str) -> Vector3:
        """Return how far a goal is from where the contract places it."""
        return self._displaced.get(goal, (0.0, 0.0, 0.0))


@dataclass(frozen=True, slots=True)
class ForeignGoal:
    """A goal that another client than the task sent to a controller."""

    controller: str
    goal_id: int
    client: str


@dataclass(frozen=True, slots=True)
class PlanBegan:
    """The task has asked for the plan of an attempt."""

    attempt_id: str
    stamp_ns: int


@dataclass(frozen=True, slots=True)
class CancelAsked:
    """A server has accepted to cancel a goal of the task."""

    controller: str
    goal_id: int
    stamp_ns: int


TaskEvent = PlanBegan | CancelAsked | AttemptRecord
"""What the task does that is seen on no controller; a record comes as its attempt ends."""


class ActionStatus:
    """What the status topics of the actions tell: which goals execute, and whose they are.

    Attributes:
        changed: fires when the goal of another client appears.
        foreign: goals of other clients, in the order in which they were accepted.
    """

    def __init__(self) -> None:
        self.changed = Signal()
        self.foreign: list[ForeignGoal] = []
        self._executing: set[str] = set()
        self._listeners: list[Callable[[TaskEvent], None]] = []

    def listen(self, listener: Callable[[TaskEvent], None]) -> None:
        """Call ``listener`` with all that the task does, in order."""
        self._listeners.append(listener)

    def tell(self, event: TaskEvent) -> None:
        """Tell of something that the task did."""
        for listener in self._listeners:
            listener(event)

    def note_started(self, controller: str) -> None:
        """Note that a controller executes a goal of the task."""
        self._executing.add(controller)

    def note_ended(self, controller: str) -> None:
        """Note that the goal of the task is over."""
        self._executing.discard(controller)

    def is_executing(self, controller: str | None = None) -> bool:
        """Tell whether a controller, or any, executes a goal of the task."""
        return bool(self._executing) if controller is None else controller in self._executing

    def note_foreign(self, goal: ForeignGoal, now_ns: int) -> None:
        """Note that the goal of another client was accepted."""
        self.foreign.append(goal)
        self.changed.fire(now_ns)

    def is_shared(self, controller: str) -> bool:
        """Tell whether another client has sent a goal to a controller."""
        return any(goal.controller == controller for goal in self.foreign)


class Milestones:
    """How far the steps of a rehearsal have come: the task announces it, and who waits for it acts at that instant.

    Attributes:
        step: number of the step that runs, from 1; 0 before the first.
    """

    def __init__(self) -> None:
        self.step = 0
        self._waiting: defaultdict[tuple[int, str], list[Action]] = defaultdict(list)

    def expect(self, step: int, milestone: str, action: Action) -> None:
        """Call ``action`` once when a step first reaches a milestone: started, accepted or moving."""
        self._waiting[(step, milestone)].append(action)

    def is_expected(self, milestone: str) -> bool:
        """Tell whether somebody waits for a milestone of the step that runs."""
        return bool(self._waiting.get((self.step, milestone)))

    def announce(self, milestone: str) -> bool:
        """Say that the step that runs has reached a milestone; tell whether somebody had waited for it."""
        actions = self._waiting.pop((self.step, milestone), [])
        for action in actions:
            action()
        return bool(actions)
