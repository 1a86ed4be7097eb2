"""What connects nodes: a profile that peers do not match, a server that answers nothing, a device that is cut off."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract
from cellc.contract.entities import ContractInterface
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome, Moment
from cellc.mock.bus.qos import served_actions
from cellc.mock.faults.cases import (
    BORNE,
    CellStep,
    Ending,
    FaultCase,
    cameras,
    cell_steps,
    components,
    controllers,
    ends_in,
    fault_case,
    image_topic,
)
from cellc.mock.faults.endings import Bounds, stateless, stopped, unfollowed, unobserved
from cellc.mock.faults.ports import FaultPorts
from cellc.mock.nodes.perception import POSE_TYPE, TF
from cellc.mock.task.bounds import planning_actions, planning_server
from cellc.mock.task.execute import RESPONSE_S
from cellc.mock.world.joint_states import JOINT_STATE_TYPE

POLICY = "reliability"
"""What the endpoint offers less of than its peers request."""
KEEP_ALIVE_S = 0.02
"""Silence after which a robot and its driver give each other up: ten cycles at 500 Hz."""


@dataclass(frozen=True, slots=True)
class MismatchQos:
    """An endpoint comes back with a profile that its peers do not match: it is never connected again.

    Of a topic no sample arrives, under the same name as before. Of an action neither request nor answer does.
    """

    kind: ClassVar[FaultKind] = FaultKind.MISMATCH_QOS
    name: str
    interface: ContractInterface

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> MismatchQos | None:
        """Return the fault of an entry; None where its target is no interface."""
        interface = contract.interfaces.get(entry.target)
        return None if interface is None else cls(entry.target, interface)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every interface of the mock whose samples or answers the task rests on."""
        used = {served_actions(contract)[name] for step in cell_steps(contract) for name in step.controllers}
        asked = {*used, *planning_actions(contract)}
        bounds = Bounds(contract)
        for name, interface in contract.interfaces.items():
            entry = FaultEntry(kind=cls.kind, target=name)
            if interface.sources and not any("mock" in source.targets for source in interface.sources):
                continue
            if interface.kind != "topic" and name in asked:
                yield fault_case(entry, contract, partial(_unanswered, bounds, name))
            elif interface.type == JOINT_STATE_TYPE:
                yield fault_case(entry, contract, stateless(bounds))
            elif name == TF:
                yield fault_case(entry, contract, partial(_frameless, bounds))
            elif frames := _observed(contract, name, interface):
                yield fault_case(entry, contract, unobserved(bounds, frames))

    def begin(self, ports: FaultPorts) -> None:
        """Come back with another profile."""
        ports.network.disconnect(self.name, POLICY)
        if self.name == TF:
            for frame in ports.transforms.all_frames():
                ports.transforms.drop(frame)
        elif self.interface.type == JOINT_STATE_TYPE:
            ports.samples.hold_back(ports.samples.of_broadcasters(self._sources()))

    def end(self, ports: FaultPorts) -> None:
        """Come back with the declared profile."""
        ports.network.reconnect(self.name)
        if self.name == TF:
            for frame in ports.transforms.all_frames():
                ports.transforms.resume(frame)
        elif self.interface.type == JOINT_STATE_TYPE:
            ports.samples.release(ports.samples.of_broadcasters(self._sources()))

    def _sources(self) -> list[str]:
        return [source.node for source in self.interface.sources]


@dataclass(frozen=True, slots=True)
class Unresponsive:
    """Silences a server: no goal response, no result, no answer to a cancel.

    What it has accepted goes on in its control loop.
    """

    kind: ClassVar[FaultKind] = FaultKind.UNRESPONSIVE
    server: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Unresponsive | None:
        """Return the fault of an entry; None where its target serves nothing."""
        served = {
            source.node for each in contract.interfaces.values() if each.kind != "topic" for source in each.sources
        }
        return cls(entry.target) if entry.target in served | controllers(contract).keys() else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every server that the task asks: the controllers with an action, and who plans."""
        planner = planning_server(contract)
        acting = [name for name, facts in controllers(contract).items() if facts.active and facts.action is not None]
        for server in (*acting, *([planner] if planner else [])):
            entry = FaultEntry(kind=cls.kind, target=server)
            yield fault_case(entry, contract, partial(_silent, Bounds(contract), server, server == planner))

    def begin(self, ports: FaultPorts) -> None:
        """Fall silent."""
        ports.network.silence(self.server)

    def end(self, ports: FaultPorts) -> None:
        """Answer again what is asked from now on."""
        ports.network.restore(self.server)


class CutNetwork:
    """Cuts a device off from its host; a cut that is over before the driver gives up is borne.

    A camera falls silent. A robot stops by itself when commands stay away. Its driver gives up when states do, or
    never: the last states are published with new stamps meanwhile.
    """

    kind: ClassVar[FaultKind] = FaultKind.CUT_NETWORK

    def __init__(self, device: str, component: str | None) -> None:
        """Bind the fault to a device; ``component`` is None for one without hardware of ros2_control."""
        self.device = device
        self.component = component
        self._cut = False
        self._given_up = False

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> CutNetwork | None:
        """Return the fault of an entry; None where its target is neither a camera nor has hardware."""
        component = components(contract).get(entry.target)
        known = component is not None or entry.target in cameras(contract)
        return cls(entry.target, component) if known else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device that is connected to a host."""
        bounds = Bounds(contract)
        for device in components(contract):
            entry = FaultEntry(kind=cls.kind, target=device)
            lost = contract.devices[device].effects.get(Moment.LINK_LOST)
            if lost is not None and lost.leaves == "active":
                yield fault_case(entry, contract, unfollowed(bounds, device))
            else:
                given_up = stopped(bounds, AttemptOutcome.HARDWARE_FAULT, KEEP_ALIVE_S)
                yield fault_case(entry, contract, given_up, hits_running_step=True)
        for device, frames in cameras(contract).items():
            yield fault_case(FaultEntry(kind=cls.kind, target=device), contract, unobserved(bounds, frames))

    def begin(self, ports: FaultPorts) -> None:
        """Cut."""
        if self.component is None:
            ports.network.cut({ports.samples.camera_node(self.device)})
            return
        self._cut = True
        ports.effects.cut(self.device)
        give_up_ns = ports.schedule.now_ns + round(KEEP_ALIVE_S * 1e9)
        ports.schedule.at(give_up_ns, partial(self._give_up, ports))

    def end(self, ports: FaultPorts) -> None:
        """Connect again; a driver that gave up lets nothing move before somebody acknowledges."""
        self._cut = False
        if self.component is None:
            ports.network.undo_cuts()
        elif self._given_up:
            ports.effects.end_cause(self.device)
        else:
            ports.effects.reconnect(self.device)

    def _give_up(self, ports: FaultPorts) -> None:
        if self._cut:
            self._given_up = ports.effects.lose_link(self.device)


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
        return ends_in(AttemptOutcome.TIMEOUT, within_s=bounds.execution_s(step))
    return BORNE


def _frameless(bounds: Bounds, step: CellStep) -> Ending:
    """A goal whose transforms are all static, or were all heard before, is borne."""
    return (
        ends_in(AttemptOutcome.TF_FAILURE, AttemptOutcome.SUCCEEDED, within_s=bounds.asked_s())
        if step.frames
        else BORNE
    )


def _silent(bounds: Bounds, server: str, plans: bool, step: CellStep) -> Ending:
    """A request is given up soon; a result that stays away at the bound of the action."""
    if plans and step.kind == "move":
        asked_s = bounds.refused_s(step)
        return ends_in(AttemptOutcome.TIMEOUT, within_s=None if asked_s is None else RESPONSE_S + asked_s)
    if server not in step.controllers:
        return BORNE
    execution_s = bounds.execution_s(step)
    return ends_in(AttemptOutcome.TIMEOUT, within_s=None if execution_s is None else max(RESPONSE_S, execution_s))
