"""Whether a proof of the bring-up holds in the simulated cell, in the words of the program that asks the real one.

Each kind is judged against what the mock runs: its managers with their controllers and hardware, the nodes of the
contract, who serves an action, and which frames are connected. What the mock runs no program for, it believes: that a
node of the contract is there, that it takes a transition, that a topic which is no joint state has a message.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.contract.bring_up import (
    ActionProof,
    ControllerProof,
    HardwareProof,
    LifecycleProof,
    MockProof,
    NodeProof,
    Proof,
    SharedProof,
    TopicProof,
    TransformProof,
    Transition,
)
from cellc.mock.nodes.robot_state_publisher import NODE as ROBOT_STATE_PUBLISHER
from cellc.mock.plant import Plant
from cellc.mock.world.joint_states import JOINT_STATE_TYPE

_DESCRIPTION_PUBLISHER = "description_publisher"
_UNCONFIGURED = "unconfigured"
_NEEDED = {"configure": (_UNCONFIGURED, "inactive"), "activate": ("inactive", "active")}
"""From which state a transition starts, and where it ends."""


class Proofs:
    """Judges proofs in a plant, and keeps the states that managed nodes were asked into."""

    def __init__(self, plant: Plant) -> None:
        """Bind the plant; every managed node is unconfigured."""
        self._plant = plant
        self._states = plant.lifecycles
        contract = plant.contract
        self.managers = {f"{entry.namespace}/controller_manager": name for name, entry in contract.managers.items()}
        self._plugins = frozenset(
            component.plugin_name
            for manager in plant.control.managers.values()
            for component in manager.list_hardware_components()
        )

    def missing(self, proofs: Sequence[Proof]) -> str:
        """Return the first thing that is missing, empty where every proof holds."""
        return next((absent for absent in map(self._of, proofs) if absent), "")

    def believed(self, proofs: Sequence[Proof]) -> Iterator[str]:
        """Yield what of some proofs is not judged."""
        for proof in proofs:
            if isinstance(proof, TopicProof):
                interface = self._plant.contract.interfaces.get(proof.topic)
                if proof.field is not None:
                    yield f"what `{proof.topic}` says in `{proof.field}`"
                elif interface is not None and interface.type != JOINT_STATE_TYPE:
                    yield f"that `{proof.topic}` has a message"

    def take(self, asked: Transition) -> str:
        """Ask a managed node for a transition; return an empty text, or why it is refused."""
        before, after = _NEEDED[asked.transition]
        state = self._states.get(asked.node, _UNCONFIGURED)
        if not self._has_node(asked.node):
            return f"no node {asked.node}"
        if state != before:
            return f"{asked.node} refused to {asked.transition}, it is {state}"
        self._states[asked.node] = after
        return ""

    def controllers(self, manager: str) -> dict[str, str]:
        """Return the names that a manager has for its controllers → their keys in the contract.

        The contract calls controllers that several managers have by their full names.
        """
        declared = self._plant.contract.managers[self.managers[manager]].controllers
        return {controller.full_name.rpartition("/")[2]: key for key, controller in declared.items()}

    def _of(self, proof: Proof) -> str:
        if isinstance(proof, NodeProof):
            return "" if self._has_node(proof.node) else f"no node {proof.node}"
        if isinstance(proof, LifecycleProof):
            return self._lifecycle(proof)
        if isinstance(proof, ControllerProof):
            return self._controller(proof)
        if isinstance(proof, HardwareProof):
            return self._hardware(proof)
        if isinstance(proof, TopicProof):
            return self._topic(proof)
        if isinstance(proof, ActionProof):
            return self._action(proof)
        if isinstance(proof, TransformProof):
            connected = self._connected(proof.parent) & self._connected(proof.child)
            return "" if connected else f"no transform from {proof.parent} to {proof.child}"
        if isinstance(proof, MockProof):
            return self._mock(proof)
        return f"no list {proof.list}" if isinstance(proof, SharedProof) else ""  # two cells never run in one mock

    def _has_node(self, node: str) -> bool:
        """Tell whether the contract has a node; it calls one by its bare name where no other is called so."""
        bare = node.rpartition("/")[2]
        return node in self.managers or not {node, bare}.isdisjoint(self._plant.contract.clock_of)

    def _lifecycle(self, proof: LifecycleProof) -> str:
        if not self._has_node(proof.node):
            return f"no node {proof.node}"
        state = self._states.get(proof.node, _UNCONFIGURED)
        passed = ("inactive", "active") if proof.state == "inactive" else ("active",)
        return "" if state in passed else f"{proof.node} must be {proof.state}, got {state}"

    def _controller(self, proof: ControllerProof) -> str:
        if proof.manager not in self.managers:
            return f"no manager {proof.manager}"
        key = self.controllers(proof.manager).get(proof.controller)
        listed = self._plant.control.managers[self.managers[proof.manager]].list_controllers()
        state = next((state.state for state in listed if state.name == key), "not loaded")
        passed = ("inactive", "active") if proof.state == "inactive" else ("active",)
        return "" if state in passed else f"controller {proof.controller} must be {proof.state}, got {state}"

    def _hardware(self, proof: HardwareProof) -> str:
        if proof.manager not in self.managers:
            return f"no manager {proof.manager}"
        listed = self._plant.control.managers[self.managers[proof.manager]].list_hardware_components()
        state = next((state.state for state in listed if state.name == proof.component), "not there")
        return "" if state == proof.state else f"hardware {proof.component} must be {proof.state}, got {state}"

    def _topic(self, proof: TopicProof) -> str:
        interface = self._plant.contract.interfaces.get(proof.topic)
        if interface is None or interface.kind != "topic" or not interface.sources:
            return f"no message on {proof.topic}"
        if interface.type != proof.type:
            return f"{proof.topic} must be {proof.type}, got {interface.type}"
        heard = {source.node for source in interface.sources} & self._heard()
        return "" if interface.type != JOINT_STATE_TYPE or heard else f"no message on {proof.topic}"

    def _heard(self) -> set[str]:
        """Return the broadcasters, and adapters, of whom a joint state was heard."""
        return {history.broadcaster for history in self._plant.control.histories.values() if len(history.stamps)}

    def _action(self, proof: ActionProof) -> str:
        interface = self._plant.contract.interfaces.get(proof.action)
        served = interface is not None and interface.kind == "action" and bool(interface.sources)
        return "" if served else f"no server for {proof.action}"

    def _connected(self, frame: str) -> set[str]:
        """Return a frame and those above it, as far as transforms have arrived."""
        frames, joints = self._plant.contract.frames, self._plant.robot_state_publisher.links.joints
        named = {
            name for history in self._plant.control.histories.values() if len(history.stamps) for name in history.names
        }
        connected: set[str] = set()
        while frame in frames and frame not in connected:
            connected.add(frame)
            joint = joints.get(frame)
            if joint is not None and joint.moves and (joint.follows or joint.name) not in named:
                break
            frame = frames[frame].parent
        return connected

    def _mock(self, proof: MockProof) -> str:
        name = proof.node.rpartition("/")[2]
        if proof.node not in self.managers and name not in (ROBOT_STATE_PUBLISHER, _DESCRIPTION_PUBLISHER):
            return f"no node {proof.node} with a description"
        foreign = ", ".join(sorted(self._plugins - set(proof.plugins)))
        if self._plugins and not foreign:
            return ""
        return f"{proof.node} must describe only {', '.join(proof.plugins)}, got {foreign or 'no hardware'}"
