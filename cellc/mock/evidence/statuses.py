"""What nodes say of goals and failures, as a bag of the real cell has it: action status and /rosout.

A bag holds no goal, no answer and no result of an action: they travel in hidden services. The status of each action
has its goals by id, with the time of acceptance and the last state, as rcl_action publishes it after every change.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from typing import Protocol
from uuid import UUID

from cellc.contract.attempt import AttemptRecord, PacketStep
from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.control import ControllerChanged, GoalStatus, GripperEnded, HardwareChanged, TrajectoryEnded
from cellc.mock.engine.control_stack import GoalSent
from cellc.mock.evidence.bag.bag_file import LATCHED
from cellc.mock.evidence.bag.messages import GOAL_STATUS, LOG, GoalState
from cellc.mock.evidence.topics import BagTopic
from cellc.mock.plant import Plant
from cellc.mock.stops import NORMAL
from cellc.mock.task.bounds import planning_actions, planning_server
from cellc.mock.task.task import END_STEP
from cellc.mock.task_status import CancelAsked, PlanBegan, TaskEvent

INFO, ERROR = 20, 40
"""Levels of rcl_interfaces/msg/Log."""
EXECUTING, CANCELING = 2, 3
"""States of action_msgs/msg/GoalStatus before the terminal ones."""
ROSOUT = BagTopic("/rosout", LOG, replace(LATCHED, depth=1000, lifespan_s=10.0))
"""Profile: rmw_qos_profile_rosout_default of rcl/logging_rosout.h."""


@dataclass(frozen=True, slots=True)
class Line:
    """One line on /rosout."""

    stamp_ns: int
    level: int
    node: str
    text: str


class StatusWriter(Protocol):
    """Takes what is said."""

    def status(self, action: str, at_ns: int, goals: tuple[GoalState, ...]) -> None:
        """Take the states of all goals of an action."""
        ...

    def line(self, line: Line) -> None:
        """Take a line of a log."""
        ...


def status_topics(contract: Contract) -> dict[str, BagTopic]:
    """Return the status topic of every action of the contract that a bag can have, by action."""
    served = (each.action for manager in contract.managers.values() for each in manager.controllers.values())
    adapted = (each.action for each in contract.adapters.values())
    names = dict.fromkeys((*served, *adapted, *planning_actions(contract)))
    return {name: BagTopic(f"{name}/_action/status", GOAL_STATUS, LATCHED) for name in names if name is not None}


def _action_of(contract: Contract, controller: str) -> str | None:
    """Return the action that takes the goals of a controller, or of a device behind an adapter."""
    if controller in contract.adapters:
        return contract.adapters[controller].action
    facts = (manager.controllers.get(controller) for manager in contract.managers.values())
    return next((each.action for each in facts if each is not None), None)


class Statuses:
    """Hands on the states of goals, and what nodes say, as it happens."""

    def __init__(self, plant: Plant, writer: StatusWriter) -> None:
        """Begin without a goal."""
        self._plant = plant
        self._writer = writer
        self._goals: dict[str, dict[bytes, GoalState]] = {}
        self._uuids: dict[tuple[str, int], bytes] = {}
        self._plan: bytes | None = None
        self._plans = 0
        self._stops = 0
        plant.task.actions.listen(self._hear)

    def sent(self, goal: GoalSent) -> None:
        """Take a goal, whatever the answer was."""
        number = goal.response.goal_id
        if not goal.response.accepted:
            self._writer.line(Line(goal.stamp_ns, ERROR, goal.controller, goal.response.log_reason))
            return
        uuid = _octets(f"{goal.controller}/{number}") if goal.uuid is None else UUID(goal.uuid).bytes
        self._uuids[(goal.controller, number)] = uuid
        self._change(_action_of(self._plant.contract, goal.controller), uuid, goal.stamp_ns, EXECUTING)

    def ended(self, event: TrajectoryEnded | GripperEnded) -> None:
        """Take the end of a goal."""
        uuid = self._uuids.get((event.controller, event.goal_id))
        if uuid is not None:
            action = _action_of(self._plant.contract, event.controller)
            self._change(action, uuid, event.stamp_ns, int(event.status))
        if event.status is GoalStatus.ABORTED and isinstance(event, TrajectoryEnded):
            text = f"{event.error_code}: {event.error_string}"
            self._writer.line(Line(event.decided_ns, ERROR, event.controller, text))

    def changed(self, event: ControllerChanged | HardwareChanged) -> None:
        """Take a change of state; one that was asked for has no reason, and no node says it."""
        name = event.controller if isinstance(event, ControllerChanged) else event.component
        if event.reason:
            self._writer.line(Line(event.stamp_ns, ERROR, name, f"{name} became {event.state}: {event.reason}"))

    def look(self) -> None:
        """Say what devices have reported meanwhile."""
        changes = self._plant.stops.changes
        for stop in changes[self._stops :]:
            level = INFO if stop.state == NORMAL else ERROR
            self._writer.line(Line(stop.stamp_ns, level, stop.component, f"reports {stop.state}"))
        self._stops = len(changes)

    def _hear(self, event: TaskEvent) -> None:
        if isinstance(event, PlanBegan):
            self._end_plan(event.stamp_ns, GoalStatus.SUCCEEDED)  # group after group has one
            self._plans += 1
            self._plan = _octets(f"plan {self._plans} of {event.attempt_id}")
            self._change_plan(self._plan, event.stamp_ns, EXECUTING)
        elif isinstance(event, CancelAsked):
            uuid = self._uuids.get((event.controller, event.goal_id))
            if uuid is not None:
                self._change(_action_of(self._plant.contract, event.controller), uuid, event.stamp_ns, CANCELING)
        elif event.step != END_STEP:
            self._attempt(event)

    def _attempt(self, record: AttemptRecord) -> None:
        """Take the end of an attempt: the planning action answers, and the task says why it gave up."""
        self.look()
        word = "aborted" if record.result is None else record.result.status
        self._end_plan(record.ended_ns, GoalStatus[word.upper()])
        contract, task = self._plant.contract, self._plant.task.name
        if record.outcome is AttemptOutcome.PLANNING_FAILURE:
            at_ns = next(
                (point.stamp_ns for point in record.trace if point.step is PacketStep.PLANNED), record.ended_ns
            )
            self._writer.line(Line(at_ns, ERROR, planning_server(contract) or task, record.plan_result or ""))
        if record.outcome is not AttemptOutcome.SUCCEEDED:
            self._writer.line(Line(record.ended_ns, ERROR, task, record.fault_code))

    def _end_plan(self, at_ns: int, status: GoalStatus) -> None:
        if self._plan is not None:
            self._change_plan(self._plan, at_ns, int(status))
            self._plan = None

    def _change_plan(self, uuid: bytes, at_ns: int, status: int) -> None:
        for action in planning_actions(self._plant.contract):
            self._change(action, uuid, at_ns, status)

    def _change(self, action: str | None, uuid: bytes, at_ns: int, status: int) -> None:
        if action is None:
            return
        goals = self._goals.setdefault(action, {})
        accepted_ns = goals[uuid].accepted_ns if uuid in goals else at_ns
        goals[uuid] = GoalState(uuid, accepted_ns, status)
        self._writer.status(action, at_ns, tuple(goals.values()))


def _octets(text: str) -> bytes:
    return hashlib.sha256(text.encode()).digest()[:16]
