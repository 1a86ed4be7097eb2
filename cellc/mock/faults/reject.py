"""A controller is inactive when its goal arrives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract, ContractController
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.control import ControlEvent, GripperEnded, TrajectoryEnded
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import controllers
from cellc.mock.plant import Plant
from cellc.vocabulary import Behaviour


@dataclass(frozen=True, slots=True)
class Reject:
    """Deactivates a controller, at once or as soon as the goal that it has is over."""

    controller: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Reject | None:
        """Return the fault of an entry; None where its target is no controller."""
        return cls(entry.target) if entry.target in controllers(contract) else None

    def begin(self, plant: Plant) -> None:
        """Deactivate it before its next goal."""
        if self.controller not in plant.requests.executing:
            self._deactivate(plant)
            return
        waiting = [True]

        def after_goal(event: ControlEvent) -> None:
            if waiting and isinstance(event, (TrajectoryEnded, GripperEnded)) and event.controller == self.controller:
                waiting.clear()
                self._deactivate(plant)

        plant.control.listen(after_goal)

    def end(self, plant: Plant) -> None:
        """Activate it again."""
        plant.control.manager_of(self.controller).switch_controllers([self.controller], [])

    def _deactivate(self, plant: Plant) -> None:
        plant.control.manager_of(self.controller).switch_controllers([], [self.controller])


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every controller that takes goals, and every one that publishes joint states."""
    for name, facts in controllers(contract).items():
        if facts.active and (facts.action is not None or facts.behaviour is Behaviour.JOINT_STATE_BROADCASTER):
            entry = FaultEntry(kind="reject", target=name)
            yield fault_case(entry, contract, partial(_ending, Bounds(contract), name, facts))


def _ending(bounds: Bounds, name: str, facts: ContractController, step: CellStep) -> Ending:
    if facts.action is None and step.controllers:
        return ends_in("stale_state", within_s=bounds.joint_state_s())
    if name in step.controllers:
        # A goal that is sent in the very cycle of the switch is accepted, and loses its controller at once.
        return ends_in("goal_rejection", "wrong_owner", within_s=bounds.asked_s())
    return BORNE
