"""An endpoint comes back with a profile that its peers do not match: it is never connected again.

Of a topic no sample arrives, under the same name as before. Of an action neither request nor answer does.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract, ContractInterface
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.bus.network import SEVERED, QosEvent, QosEventKind
from cellc.mock.bus.qos import served_actions
from cellc.mock.faults.bounds import POSE_TYPE, Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep, cell_steps
from cellc.mock.faults.contents import image_topic
from cellc.mock.faults.observed import cameras, ending_unobserved
from cellc.mock.faults.silent_states import catch_up, delay, of_broadcasters
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import planning_actions
from cellc.mock.world.joint_states import JOINT_STATE_TYPE

TF = "/tf"
POLICY = "reliability"
"""What the endpoint offers less of than its peers request."""


@dataclass(frozen=True, slots=True)
class MismatchQos:
    """Disconnects what an interface carries."""

    name: str
    interface: ContractInterface

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> MismatchQos | None:
        """Return the fault of an entry; None where its target is no interface."""
        interface = contract.interfaces.get(entry.target)
        return None if interface is None else cls(entry.target, interface)

    def begin(self, plant: Plant) -> None:
        """Come back with another profile."""
        servers = [source.node for source in self.interface.sources]
        self._tell(plant)
        plant.network.disturb(self.name, SEVERED)
        if self.interface.kind != "topic":
            plant.requests.unresponsive.update(servers)
        elif self.name == TF:
            self._drop_frames(plant)
        elif self.interface.type == JOINT_STATE_TYPE:
            for history in of_broadcasters(plant, servers):
                delay(history, plant.now_ns)

    def end(self, plant: Plant) -> None:
        """Come back with the declared profile."""
        servers = [source.node for source in self.interface.sources]
        plant.network.calm(self.name)
        plant.requests.unresponsive.difference_update(servers)
        if self.name == TF:
            self._resume_frames(plant)
        elif self.interface.type == JOINT_STATE_TYPE:
            for history in of_broadcasters(plant, servers):
                catch_up(history, plant.now_ns)

    def _tell(self, plant: Plant) -> None:
        """Let the middleware of each end log one line that names the policy."""
        plant.requests.findings.append(f"`{self.name}` is no longer connected: incompatible QoS, policy {POLICY}")
        ends = [(QosEventKind.OFFERED_QOS_INCOMPATIBLE, end) for end in self.interface.sources]
        ends += [(QosEventKind.REQUESTED_QOS_INCOMPATIBLE, end) for end in self.interface.sinks]
        for kind, end in ends:
            plant.network.events.note(QosEvent(kind, self.name, end.node, plant.now_ns, detail=POLICY))

    def _drop_frames(self, plant: Plant) -> None:
        for perception in plant.perceptions.values():
            perception.publishes_transform = False
        for child in plant.robot_state_publisher.links.joints:
            plant.robot_state_publisher.drop(child, plant.now_ns)

    def _resume_frames(self, plant: Plant) -> None:
        for perception in plant.perceptions.values():
            perception.publishes_transform = True
        for child in plant.robot_state_publisher.links.joints:
            plant.robot_state_publisher.resume(child, plant.now_ns)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every interface whose samples or answers the task rests on."""
    used = {served_actions(contract)[name] for step in cell_steps(contract) for name in step.controllers}
    asked = {*used, *planning_actions(contract)}
    for name, interface in contract.interfaces.items():
        entry = FaultEntry(kind="mismatch_qos", target=name)
        bounds = Bounds(contract)
        if interface.kind != "topic" and name in asked:
            yield fault_case(entry, contract, partial(_unanswered, bounds, name))
        elif interface.type == JOINT_STATE_TYPE:
            yield fault_case(entry, contract, partial(_stateless, bounds))
        elif name == TF:
            yield fault_case(entry, contract, partial(_frameless, bounds))
        elif frames := _observed(contract, name, interface):
            yield fault_case(entry, contract, ending_unobserved(bounds, frames))


def _observed(contract: Contract, name: str, interface: ContractInterface) -> tuple[str, ...]:
    """Return the dynamic frames that are observed through a topic."""
    seen = [frames for device, frames in cameras(contract).items() if image_topic(contract, device) == name]
    if interface.type == POSE_TYPE:
        seen += [(frame,) for frame, facts in contract.frames.items() if facts.kind == "dynamic"]
    return tuple(dict.fromkeys(frame for frames in seen for frame in frames))


def _unanswered(bounds: Bounds, name: str, step: CellStep) -> Ending:
    served = served_actions(bounds.contract)
    plans = name in planning_actions(bounds.contract) and step.kind == "move"
    if plans or name in {served[each] for each in step.controllers}:
        return ends_in("timeout", within_s=bounds.execution_s(step))
    return BORNE


def _stateless(bounds: Bounds, step: CellStep) -> Ending:
    return ends_in("stale_state", within_s=bounds.joint_state_s()) if step.controllers else BORNE


def _frameless(bounds: Bounds, step: CellStep) -> Ending:
    """A goal whose transforms are all static, or were all heard before, is borne."""
    return ends_in("tf_failure", SUCCEEDED, within_s=bounds.asked_s()) if step.frames else BORNE
