"""Goals that cannot be reached, are canceled, meet an inactive controller, or are not the only ones."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract, ContractController
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import TRAJECTORIES, AttemptOutcome, Behavior
from cellc.mock.control import GripperGoal, TrajectoryGoal, TrajectoryPoint
from cellc.mock.faults.cases import BORNE, CellStep, Ending, FaultCase, cell_steps, controllers, ends_in, fault_case
from cellc.mock.faults.endings import Bounds
from cellc.mock.faults.ports import FaultPorts
from cellc.mock.task.bounds import cancel_bound_s

DISTANCE_M = 10.0
"""Farther than any arm of a cell reaches."""
STEPS_WITH_GOALS = ("move", "grip")
CLIENT = "second_commander"
DURATION_NS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Unreachable:
    """Displaces a goal along the z axis of its frame, out of the reach of its group."""

    kind: ClassVar[FaultKind] = FaultKind.UNREACHABLE
    goal: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Unreachable | None:
        """Return the fault of an entry; None where its target is no Cartesian goal."""
        return cls(entry.target) if entry.target in contract.goals else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every Cartesian goal."""
        for goal in contract.goals:
            entry = FaultEntry(kind=cls.kind, target=goal)
            yield fault_case(entry, contract, partial(_unreachable, Bounds(contract), goal))

    def begin(self, ports: FaultPorts) -> None:
        """Displace it."""
        ports.requests.displace_goal(self.goal, (0.0, 0.0, DISTANCE_M))

    def end(self, ports: FaultPorts) -> None:
        """Put it back."""
        ports.requests.restore_goal(self.goal)


@dataclass(frozen=True, slots=True)
class Cancel:
    """The client cancels the goal of one kind of step that is executing, or the first that executes after."""

    kind: ClassVar[FaultKind] = FaultKind.CANCEL
    step: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Cancel | None:
        """Return the fault of an entry; None where its target is no kind of step that sends goals."""
        return cls(entry.target) if entry.target in STEPS_WITH_GOALS else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every kind of step that sends goals in this cell; the bound is that of the cancel."""
        kinds = {step.kind for step in cell_steps(contract) if step.controllers}
        for kind in STEPS_WITH_GOALS:
            if kind in kinds:
                entry = FaultEntry(kind=cls.kind, target=kind)
                yield fault_case(
                    entry, contract, partial(_canceled, kind, cancel_bound_s(contract)), hits_running_step=True
                )

    def begin(self, ports: FaultPorts) -> None:
        """Ask."""
        ports.requests.ask_cancel(self.step, ports.schedule.now_ns)

    def end(self, ports: FaultPorts) -> None:
        """Take the request back where no goal has been canceled yet."""
        ports.requests.withdraw_cancel(self.step)


@dataclass(frozen=True, slots=True)
class Reject:
    """Deactivates a controller before its next goal, immediately or as soon as the goal that it has is over."""

    kind: ClassVar[FaultKind] = FaultKind.REJECT
    controller: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Reject | None:
        """Return the fault of an entry; None where its target is no controller."""
        return cls(entry.target) if entry.target in controllers(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every controller that takes goals, and every one that publishes joint states."""
        for name, facts in controllers(contract).items():
            broadcasts = facts.behavior is Behavior.JOINT_STATE_BROADCASTER
            if facts.active and (facts.action is not None or broadcasts):
                entry = FaultEntry(kind=cls.kind, target=name)
                yield fault_case(entry, contract, partial(_rejected, Bounds(contract), name, facts))

    def begin(self, ports: FaultPorts) -> None:
        """Deactivate it before its next goal."""
        ports.controllers.deactivate_when_idle(self.controller)

    def end(self, ports: FaultPorts) -> None:
        """Activate it again."""
        ports.controllers.activate(self.controller)


@dataclass(frozen=True, slots=True)
class SecondCommander:
    """Another client sends a goal to the action of a controller: to stay where the joints are.

    A trajectory controller takes the new goal and aborts the old one. The status topic of the action names both goals,
    so that the owner of the command sees one that it has not sent, whatever it does itself at that moment.
    """

    kind: ClassVar[FaultKind] = FaultKind.SECOND_COMMANDER
    controller: str
    facts: ContractController

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> SecondCommander | None:
        """Return the fault of an entry; None where its target takes no goals."""
        facts = controllers(contract).get(entry.target)
        return None if facts is None or facts.action is None else cls(entry.target, facts)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every controller that takes goals; a second commander ends whatever step it meets."""
        ending = ends_in(AttemptOutcome.WRONG_OWNER, within_s=Bounds(contract).watched_s())
        for name, facts in controllers(contract).items():
            if facts.active and facts.action is not None:
                entry = FaultEntry(kind=cls.kind, target=name)
                yield fault_case(entry, contract, lambda step: ending, hits_running_step=True)

    def begin(self, ports: FaultPorts) -> None:
        """Send it; a goal that is rejected commands nothing."""
        goal = self._goal(ports.controllers.positions(self.controller))
        ports.controllers.send_foreign_goal(self.controller, goal, CLIENT, ports.schedule.now_ns)

    def end(self, ports: FaultPorts) -> None:
        """Nothing: what was commanded was commanded."""

    def _goal(self, positions: dict[str, float]) -> TrajectoryGoal | GripperGoal:
        here = tuple(positions[joint] for joint in self.facts.joints)
        if self.facts.behavior in TRAJECTORIES:
            point = TrajectoryPoint(positions=here, time_from_start_ns=DURATION_NS)
            return TrajectoryGoal(joint_names=self.facts.joints, points=(point,))
        return GripperGoal(position=here, joint_names=self.facts.joints)


@dataclass(frozen=True, slots=True)
class Switch:
    """Somebody switches controllers: as a declared switch says, or one controller off and on again.

    A switch in motion aborts the goal of the controller that is deactivated; its commands stay at their last values
    until the next owner claims them.
    """

    kind: ClassVar[FaultKind] = FaultKind.SWITCH
    manager: str
    activate: tuple[str, ...]
    deactivate: tuple[str, ...]

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Switch | None:
        """Return the fault of an entry; None where its target is neither a switch nor a controller."""
        for name, manager in contract.managers.items():
            if entry.target in manager.switches:
                switch = manager.switches[entry.target]
                return cls(name, switch.activate, switch.deactivate)
            if entry.target in manager.controllers:
                return cls(name, (entry.target,), (entry.target,))
        return None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every declared switch, and the restart of every controller that takes goals."""
        bounds = Bounds(contract)
        for manager in contract.managers.values():
            for name, switch in manager.switches.items():
                entry = FaultEntry(kind=cls.kind, target=name)
                yield fault_case(entry, contract, partial(_switched, bounds, switch.deactivate))
        for name, facts in controllers(contract).items():
            if facts.active and facts.action is not None:
                entry = FaultEntry(kind=cls.kind, target=name)
                yield fault_case(entry, contract, partial(_switched, bounds, (name,)))

    def begin(self, ports: FaultPorts) -> None:
        """Switch."""
        ports.controllers.switch(self.manager, self.activate, self.deactivate)

    def end(self, ports: FaultPorts) -> None:
        """Switch back; a controller that was restarted is back already."""
        if self.activate != self.deactivate:
            ports.controllers.switch(self.manager, self.deactivate, self.activate)


def _unreachable(bounds: Bounds, goal: str, step: CellStep) -> Ending:
    if (step.kind, step.target) != ("move", goal):
        return BORNE
    return ends_in(AttemptOutcome.PLANNING_FAILURE, within_s=bounds.asked_s())


def _canceled(kind: str, within_s: float, step: CellStep) -> Ending:
    return ends_in(AttemptOutcome.CANCELED, within_s=within_s) if step.kind == kind and step.controllers else BORNE


def _rejected(bounds: Bounds, name: str, facts: ContractController, step: CellStep) -> Ending:
    if facts.action is None and step.controllers:
        return ends_in(AttemptOutcome.STALE_STATE, within_s=bounds.joint_state_s())
    if name in step.controllers:
        # A goal that is sent in the very cycle of the switch is accepted, and loses its controller immediately.
        return ends_in(AttemptOutcome.GOAL_REJECTION, AttemptOutcome.WRONG_OWNER, within_s=bounds.refused_s(step))
    return BORNE


def _switched(bounds: Bounds, deactivated: tuple[str, ...], step: CellStep) -> Ending:
    """A switch between two goals, or one that is refused, is borne; after it a goal may meet an inactive controller."""
    if not set(deactivated) & set(step.controllers):
        return BORNE
    within_s = bounds.refused_s(step)
    return ends_in(
        AttemptOutcome.WRONG_OWNER, AttemptOutcome.GOAL_REJECTION, AttemptOutcome.SUCCEEDED, within_s=within_s
    )
