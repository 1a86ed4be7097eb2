"""Another client sends a goal to the action of a controller.

A trajectory controller takes the new goal and aborts the old one. The status topic of the action names both goals, so
that the owner of the command sees one that it has not sent, whatever it does itself at that moment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract, ContractController
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.control import GripperGoal, TrajectoryGoal, TrajectoryPoint
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import FaultCase, ends_in, fault_case
from cellc.mock.faults.contents import controllers
from cellc.mock.plant import Plant
from cellc.vocabulary import TRAJECTORIES

CLIENT = "second_commander"
DURATION_NS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class SecondCommander:
    """Sends one goal: to stay where the joints are."""

    controller: str
    facts: ContractController

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> SecondCommander | None:
        """Return the fault of an entry; None where its target takes no goals."""
        facts = controllers(contract).get(entry.target)
        return None if facts is None or facts.action is None else cls(entry.target, facts)

    def begin(self, plant: Plant) -> None:
        """Send it; a goal that is rejected commands nothing."""
        manager = plant.control.manager_of(self.controller)
        response = plant.control.send_goal(self.controller, self._goal(manager.joint_positions()))
        if response.accepted:
            plant.requests.foreign_goals[(self.controller, response.goal_id)] = CLIENT
            plant.requests.changed.fire(plant.now_ns)

    def end(self, plant: Plant) -> None:
        """Nothing: what was commanded was commanded."""

    def _goal(self, positions: dict[str, float]) -> TrajectoryGoal | GripperGoal:
        here = tuple(positions[joint] for joint in self.facts.joints)
        if self.facts.behaviour in TRAJECTORIES:
            point = TrajectoryPoint(positions=here, time_from_start_ns=DURATION_NS)
            return TrajectoryGoal(joint_names=self.facts.joints, points=(point,))
        return GripperGoal(position=here, joint_names=self.facts.joints)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every controller that takes goals; a second commander ends whatever step it meets."""
    ending = ends_in("wrong_owner", within_s=Bounds(contract).watched_s())
    for name, facts in controllers(contract).items():
        if facts.active and facts.action is not None:
            entry = FaultEntry(kind="second_commander", target=name)
            yield fault_case(entry, contract, lambda step: ending, at_once=True)
