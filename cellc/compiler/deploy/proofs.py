"""The proofs that steps of the bring-up wait for, and the lists of those that several steps wait for.

A list is written once for each target and named by its steps: each step that moves anything asks for every node that
must answer once, and each claim for every managed node, so that a plan without lists grows with the square of a cell.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import Node
from cellc.compiler.deploy.processes import asks_for_motion, description_nodes, is_adapter
from cellc.compiler.deploy.readiness import components_of, is_on
from cellc.compiler.deploy.watches import heard
from cellc.compiler.graph.claims import crosses_an_adapter
from cellc.compiler.link.derived import JOINT_STATE_TYPE
from cellc.contract.bring_up import (
    CLAIM_WATCH,
    AloneProof,
    BringUpStep,
    ControllerProof,
    HardwareProof,
    LifecycleProof,
    ManagedState,
    MockProof,
    NodeProof,
    SharedProof,
    SingleProof,
    TopicProof,
    TransformProof,
)
from cellc.contract.entities import HardwareState, Target
from cellc.contract.vocabulary import Moment, Need

EVERY_STEP = SharedProof(kind="shared", list="every_step")
"""What every step waits for that asks a node."""
EVERY_CLAIM = SharedProof(kind="shared", list="every_claim")
"""What every claim of a manager waits for, whichever manager that is."""

Lists = Mapping[str, tuple[SingleProof, ...]]


def active_hardware(manager: ControllerManager) -> SharedProof:
    """Name the list that the components of a manager are active."""
    return SharedProof(kind="shared", list=f"active_hardware_of_{manager.name}")


def following(manager: ControllerManager) -> SharedProof:
    """Name the list that the robots of a manager follow, and that their claims end where they no longer do."""
    return SharedProof(kind="shared", list=f"following_of_{manager.name}")


def lists(cell: Cell, target: Target) -> Lists:
    """Return every list of a target; some are empty."""
    moved = (tf for group in cell.groups for tf in transforms(cell, target, group.base_link, group.tip_frame))
    found: dict[str, Iterator[SingleProof]] = {
        EVERY_STEP.list: mocked(cell, target),
        EVERY_CLAIM.list: chain(moved, managed_nodes(cell)),
    }
    for manager in cell.managers:
        components = components_of(cell, manager, target)
        found[active_hardware(manager).list] = _active(manager, components)
        found[following(manager).list] = _followed(cell, manager) if target == "real" else iter(())
    return {name: tuple(dict.fromkeys(proofs)) for name, proofs in found.items()}


def shared(steps: Sequence[BringUpStep], lists: Lists) -> tuple[Lists, tuple[BringUpStep, ...]]:
    """Return the lists that several steps wait for, and the steps, with the proofs of all other lists in them."""
    waiting = Counter(name for step in steps for name in step.waits_for())
    kept = {name: proofs for name, proofs in lists.items() if proofs and waiting[name] > 1}
    inside = {name: proofs for name, proofs in lists.items() if name not in kept}
    return kept, tuple(step.with_lists(inside) for step in steps)


def mocked(cell: Cell, target: Target) -> Iterator[AloneProof | MockProof]:
    """Yield the proofs that one cell answers, and on the mock that it is the mock.

    The mock and the real cell have the same names and domain, so that one that was not ended hears every request
    of the other: what is asked, and what describes the robot, is there once.
    """
    describing = tuple(description_nodes(cell))
    there = (node for node in cell.nodes if node.lifecycle and (target == "real" or not node.real_only))
    asked = (*(manager.node for manager in cell.managers), *(node.full_name for node in there))
    if nodes := tuple(dict.fromkeys((*describing, *asked))):
        yield AloneProof(kind="alone", nodes=nodes)
    if target == "mock":
        hardware = (device.control.hardware for device in cell.devices if is_on(device, "mock"))
        plugins = tuple(sorted({item.plugins["mock"] for item in hardware if item is not None}))
        yield from (MockProof(kind="mock", node=node, plugins=plugins) for node in describing)


def _active(manager: ControllerManager, devices: Iterable[Device]) -> Iterator[HardwareProof]:
    return (hardware_proof(manager, device, "active") for device in devices)


def _followed(cell: Cell, manager: ControllerManager) -> Iterator[SingleProof]:
    """Yield that a robot follows, and that the node is there which takes the claim when it no longer does."""
    proofs = [proof for device in components_of(cell, manager, "real") for proof in heard(cell, device).values()]
    yield from proofs
    if proofs:
        yield NodeProof(kind="node", node=CLAIM_WATCH)


def silent(cell: Cell, device: Device) -> Iterator[TopicProof]:
    """Yield that no program plays which would end while a device holds up its controller manager."""
    effect = None if device.control.hardware is None else device.control.hardware.effects.get(Moment.ACTIVATE)
    if effect is not None and Need.PROGRAM_STOPPED in effect.needs:
        for manager in cell.managers:
            for other in components_of(cell, manager, "real") if device.name in manager.devices else ():
                proof = heard(cell, other).get(Need.PROGRAM_RUNNING)
                if proof is not None:
                    yield proof.model_copy(update={"values": (False,), "unsaid": True})


def component(device: Device) -> str:
    """Return the name of the hardware component of a device that has one."""
    assert device.control.hardware is not None
    return device.control.hardware.name


def hardware_proof(manager: ControllerManager, device: Device, state: HardwareState) -> HardwareProof:
    """Return that a component is in a state."""
    return HardwareProof(kind="hardware", manager=manager.node, component=component(device), state=state)


def controller_proof(manager: ControllerManager, name: str, state: ManagedState) -> ControllerProof:
    """Return that a controller is in a state."""
    return ControllerProof(kind="controller", manager=manager.node, controller=name, state=state)


def lifecycle_proof(node: Node, state: ManagedState) -> LifecycleProof:
    """Return that a managed node is in a state."""
    return LifecycleProof(kind="lifecycle", node=node.full_name, state=state)


def transforms(cell: Cell, target: Target, parent: str, child: str) -> Iterator[TransformProof]:
    """Yield the proof of a transform; on the mock not over joints behind an adapter, without states."""
    if target == "real" or not crosses_an_adapter(cell, parent, child):
        yield TransformProof(kind="transform", parent=parent, child=child)


def joint_states(cell: Cell, manager: ControllerManager) -> Iterator[TopicProof]:
    """Yield that the joint states of a manager arrive."""
    names = {controller.full_name for controller in manager.controllers}
    for interface in cell.interfaces:
        heard_of = interface.type == JOINT_STATE_TYPE and interface.sinks
        if heard_of and any(end.full_name in names for end in interface.sources):
            yield TopicProof(kind="topic", topic=interface.name, type=interface.type)


def managed_nodes(cell: Cell) -> Iterator[LifecycleProof]:
    """Yield that each managed node is active which neither asks for motion nor adapts a device."""
    managed = (node for node in cell.nodes if node.lifecycle and not is_adapter(cell, node))
    return (lifecycle_proof(node, "active") for node in managed if not asks_for_motion(cell, node))
