"""Bring-up by readiness: the request of each step, the proof that it waits for, and the effect that it must show.

Four phases: ``start`` configures and observes, ``activate`` activates self-moving hardware, ``claim`` assigns command
interfaces to controllers, ``move`` starts motion clients. On the mock the launch file runs the first three together.
On the real target a person releases each at its gate: a claim made before the robot listens holds a set point that is
stale by then (Universal_Robots_ROS2_Driver issue 1084), and a claim of an FR3 starts motion mode. Processes may start
in any order; each later step waits for its proof.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.cell.interface import Node
from cellc.compiler.deploy.processes import asks_for_motion, description_nodes, is_adapter, motion_clients
from cellc.compiler.deploy.readiness import (
    activated_later,
    components_of,
    components_read,
    hardware_before,
    is_claiming,
    is_exported,
    is_on,
    measured_in,
    moved_with,
    readers_of,
    started_active,
)
from cellc.compiler.deploy.versions import compared_on
from cellc.compiler.deploy.watches import heard, watches
from cellc.compiler.graph.claims import crosses_an_adapter
from cellc.compiler.graph.enclaves import bring_up_enclave
from cellc.compiler.graph.simulated import is_asked, simulated
from cellc.compiler.link.derived import JOINT_STATE_TYPE
from cellc.contract.bring_up import (
    CLAIM_WATCH,
    Acknowledgment,
    ActionProof,
    Activation,
    AloneProof,
    BringUp,
    BringUpStep,
    Comparison,
    ControllerProof,
    HardwareActivation,
    HardwareProof,
    LifecycleProof,
    ManagedState,
    MockProof,
    NodeProof,
    Proof,
    Request,
    Restart,
    TopicProof,
    TransformProof,
    Transition,
    Watch,
)
from cellc.contract.entities import HardwareState, Target
from cellc.contract.vocabulary import BringUpPhase, InterfaceKind, Moment, Need

DEADLINE_S = 60.0
"""How long a step waits for its proof, and for its effect."""


def bring_up(cell: Cell) -> BringUp:
    """Return the plan of a cell: steps of both targets in the order of their phases, and what the stopper watches."""
    return BringUp(
        format=1,
        cell=cell.name,
        enclave=bring_up_enclave(cell),
        mock=tuple(_steps(cell, "mock")),
        sim=tuple(_steps(simulated(cell), "mock")) if is_asked(cell) else (),
        real=(*_comparisons(cell), *_steps(cell, "real")),
        watches=tuple(watches(cell)),
    )


def phases(plan: BringUp, target: Target, host: str | None = None) -> tuple[BringUpPhase, ...]:
    """Return the phases that have a step on a target, and on a host where one is given."""
    phases = {step.phase for step in plan.steps(target) if host is None or step.host in ("", host)}
    return tuple(phase for phase in BringUpPhase if phase in phases)


def releases(plan: BringUp, phase: BringUpPhase) -> tuple[str, ...]:
    """Return what a person releases in a phase of the real target, one after the other; one or none needs no name."""
    named = tuple(dict.fromkeys(step.release for step in plan.real if step.phase is phase and step.release))
    return named if len(named) > 1 else ()


def activation(node: Node) -> str:
    """Return the command with which a person activates a managed node that asks for motion."""
    return f"ros2 lifecycle set {node.full_name} activate"


def _steps(cell: Cell, target: Target) -> Iterator[BringUpStep]:
    """Yield the steps on a target, each with the proofs that all of them wait for."""
    everywhere = tuple(_mocked(cell, target))
    return (step.model_copy(update={"proof": (*everywhere, *step.proof)}) for step in _own_steps(cell, target))


def _own_steps(cell: Cell, target: Target) -> Iterator[BringUpStep]:
    """Yield the steps on a target; each waits for what an earlier one made, on whichever host that runs."""
    managed = [node for node in cell.nodes if node.lifecycle and (target == "real" or not node.real_only)]
    yield from (_configure(node) for node in managed)
    for manager in cell.managers:
        yield from _observe(cell, manager, target)
    activated = [node for node in managed if not asks_for_motion(cell, node) and not is_adapter(cell, node)]
    late = {node.full_name: hardware_before(cell, node, target) for node in activated}
    yield from (_activate(cell, node, target, BringUpPhase.START) for node in activated if not late[node.full_name])
    for manager in cell.managers:
        yield from _activate_hardware(cell, manager, target)
    for node in activated:
        if devices := late[node.full_name]:
            yield _activate(cell, node, target, BringUpPhase.ACTIVATE, devices[-1])
    for manager in cell.managers:
        yield from _claim(cell, manager, target)
    yield from (_claim_by_adapter(cell, node, target) for node in managed if is_adapter(cell, node))
    if motion_clients(cell):
        yield _move(cell, target)


def _comparisons(cell: Cell) -> Iterator[BringUpStep]:
    """Yield what compares each computer with the tuple that every gate is passed with, before its other steps.

    It reads what is installed and asks no node, so that it waits for none, also on a computer with no other step.
    """
    for host, parts in compared_on(cell):
        if parts:
            name = f"compare_versions{host and f'_on_{host}'}"
            asked = Comparison(kind="versions", parts=tuple(part.shown for part in parts))
            yield _step(BringUpPhase.START, name, host, [], asked, [])


def _configure(node: Node) -> BringUpStep:
    return _step(
        BringUpPhase.START,
        f"configure_{node.name}",
        node.host,
        [NodeProof(kind="node", node=node.full_name)],
        Transition(kind="transition", node=node.full_name, transition="configure"),
        [_lifecycle(node, "inactive")],
    )


def _activate(cell: Cell, node: Node, target: Target, phase: BringUpPhase, release: str = "") -> BringUpStep:
    return _step(
        phase,
        f"activate_{node.name}",
        node.host,
        [
            _lifecycle(node, "inactive"),
            *(tf for parent in measured_in(cell, node) for tf in _transforms(cell, target, WORLD, parent)),
        ],
        Transition(kind="transition", node=node.full_name, transition="activate"),
        [_lifecycle(node, "active")],
        release,
    )


def _observe(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[BringUpStep]:
    """Yield the step that activates broadcasters, except on hardware that a person has yet to activate."""
    spawned = [controller.name for controller in manager.controllers if target in controller.targets]
    later = activated_later(cell, manager, target)
    observing = tuple(
        reader.name for reader in readers_of(cell, manager, target) if is_exported(cell, manager, reader, target)
    )
    if spawned:
        components = (
            _hardware(manager, device, "active")
            for device in components_of(cell, manager, target)
            if device not in later  # or a person was faster
        )
        yield _step(
            BringUpPhase.START,
            f"observe_{manager.name}",
            manager.host,
            [
                *components,
                *(_controller(manager, name, "inactive") for name in spawned),
            ],
            Activation(kind="controllers", manager=manager.node, controllers=observing) if observing else None,
            [_controller(manager, name, "active") for name in observing],
        )


def _activate_hardware(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[BringUpStep]:
    """Yield what takes hardware to active that moves by it, one device a release, and then restarts what reads it."""
    for device in activated_later(cell, manager, target):
        yield _step(
            BringUpPhase.ACTIVATE,
            f"activate_{device.name}",
            manager.host,
            [*(_silent(cell, device) if target == "real" else ())],
            HardwareActivation(kind="hardware", manager=manager.node, component=_component(device)),
            [_hardware(manager, device, "active")],
            device.name,
        )
        reading = tuple(
            reader.name
            for reader in readers_of(cell, manager, target)
            if device in components_read(cell, manager, reader, target)
        )
        if reading:
            yield _step(
                BringUpPhase.ACTIVATE,
                f"observe_{device.name}_again",
                manager.host,
                [*(_controller(manager, name, "inactive") for name in reading)],
                Restart(kind="restart", manager=manager.node, controllers=reading),
                [_controller(manager, name, "active") for name in reading],
                device.name,
            )


def _claim(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[BringUpStep]:
    """Yield the steps that give command interfaces their owners: one for each arm with what it carries."""
    later, watched = activated_later(cell, manager, target), tuple(watches(cell))
    claiming: dict[str, list[str]] = {}
    for controller in started_active(manager, target):
        if is_claiming(cell, controller, later):
            claiming.setdefault(moved_with(cell, controller.device), []).append(controller.name)
    for released, names in claiming.items():
        if target == "real":
            yield from _acknowledge(cell, manager, watched, released, names)
        yield _step(
            BringUpPhase.CLAIM,
            f"claim_{manager.name}" if len(claiming) == 1 else f"claim_{manager.name}_of_{released}",
            manager.host,
            [
                *(_hardware(manager, device, "active") for device in components_of(cell, manager, target)),
                *(_controller(manager, name, "inactive") for name in names),
                *_joint_states(cell, manager),
                *(tf for group in cell.groups for tf in _transforms(cell, target, group.base_link, group.tip_frame)),
                *_managed_nodes(cell),
                *(_heard(cell, manager) if target == "real" else ()),
            ],
            Activation(kind="controllers", manager=manager.node, controllers=tuple(names)),
            [_controller(manager, name, "active") for name in names],
            released,
        )


def _claim_by_adapter(cell: Cell, node: Node, target: Target) -> BringUpStep:
    """Return the step from which on an adapter takes goals: it is a claim, and has read since it was configured."""
    adapted = next(adapted for adapted in cell.adapters if adapted.node == node.full_name)
    return _step(
        BringUpPhase.CLAIM,
        f"claim_by_{node.name}",
        node.host,
        [
            _lifecycle(node, "inactive"),
            TopicProof(kind="topic", topic=adapted.state_topic, type=JOINT_STATE_TYPE),
        ],
        Transition(kind="transition", node=node.full_name, transition="activate"),
        [_lifecycle(node, "active")],
        moved_with(cell, adapted.device),
    )


def _acknowledge(
    cell: Cell, manager: ControllerManager, watched: Sequence[Watch], released: str, names: Sequence[str]
) -> Iterator[BringUpStep]:
    """Yield what lets claims be made: the person who authorizes them acknowledges, and each proof must hold by then."""
    for watch in watched:
        if watch.manager == manager.node and not set(watch.controllers).isdisjoint(names):
            yield _step(
                BringUpPhase.CLAIM,
                f"acknowledge_{watch.device}",
                manager.host,
                [*watch.while_hold.values(), NodeProof(kind="node", node=CLAIM_WATCH)],
                Acknowledgment(kind="acknowledge", service=watch.acknowledge),
                [],
                released,
            )


def _move(cell: Cell, target: Target) -> BringUpStep:
    """Return what must show before a node that asks for motion is started: claims, actions of adapters too, states.

    For the mock that no manager runs anything but the mock: a target is a word, and the description is what moves.
    """
    asking = {node.name for node in motion_clients(cell)}
    claimed = (
        _controller(manager, controller.name, "active")
        for manager in cell.managers
        for controller in started_active(manager, target)
        if is_claiming(cell, controller, ())
    )
    adapted = tuple(adapter.action for adapter in cell.adapters)
    adapting = (_lifecycle(node, "active") for node in cell.nodes if target == "real" and is_adapter(cell, node))
    asked = (
        interface.name
        for interface in cell.interfaces
        if interface.kind is InterfaceKind.ACTION
        and target in interface.targets
        and any(end.node in asking for end in interface.sinks)
    )
    names = (name for name in asked if name not in adapted)
    actions = (ActionProof(kind="action", action=name) for name in (*(adapted if target == "real" else ()), *names))
    followed = (proof for device in cell.devices for proof in heard(cell, device).values() if target == "real")
    proof: list[Proof] = [*claimed, *adapting, *followed, *actions, *_managed_nodes(cell)]
    return _step(BringUpPhase.MOVE, "move", "", proof, None, [])


def _mocked(cell: Cell, target: Target) -> Iterator[AloneProof | MockProof]:
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


def _step(
    phase: BringUpPhase,
    name: str,
    host: str,
    proof: list[Proof],
    request: Request | None,
    effect: list[Proof],
    release: str = "",
) -> BringUpStep:
    return BringUpStep(
        release=release,
        name=name,
        phase=phase,
        host=host,
        proof=tuple(dict.fromkeys(proof)),
        request=request,
        effect=tuple(effect),
        deadline_s=DEADLINE_S,
    )


def _heard(cell: Cell, manager: ControllerManager) -> Iterator[Proof]:
    """Yield that a robot follows, and that the node is there which takes the claim when it no longer does."""
    proofs = [proof for device in components_of(cell, manager, "real") for proof in heard(cell, device).values()]
    yield from proofs
    if proofs:
        yield NodeProof(kind="node", node=CLAIM_WATCH)


def _silent(cell: Cell, device: Device) -> Iterator[TopicProof]:
    """Yield that no program plays which would end while a device holds up its controller manager."""
    effect = None if device.control.hardware is None else device.control.hardware.effects.get(Moment.ACTIVATE)
    if effect is not None and Need.PROGRAM_STOPPED in effect.needs:
        for manager in cell.managers:
            for other in components_of(cell, manager, "real") if device.name in manager.devices else ():
                proof = heard(cell, other).get(Need.PROGRAM_RUNNING)
                if proof is not None:
                    yield proof.model_copy(update={"values": (False,), "unsaid": True})


def _component(device: Device) -> str:
    assert device.control.hardware is not None
    return device.control.hardware.name


def _hardware(manager: ControllerManager, device: Device, state: HardwareState) -> HardwareProof:
    return HardwareProof(kind="hardware", manager=manager.node, component=_component(device), state=state)


def _controller(manager: ControllerManager, name: str, state: ManagedState) -> ControllerProof:
    return ControllerProof(kind="controller", manager=manager.node, controller=name, state=state)


def _lifecycle(node: Node, state: ManagedState) -> LifecycleProof:
    return LifecycleProof(kind="lifecycle", node=node.full_name, state=state)


def _transforms(cell: Cell, target: Target, parent: str, child: str) -> Iterator[TransformProof]:
    """Yield the proof of a transform; on the mock not over joints behind an adapter, without states."""
    if target == "real" or not crosses_an_adapter(cell, parent, child):
        yield TransformProof(kind="transform", parent=parent, child=child)


def _joint_states(cell: Cell, manager: ControllerManager) -> Iterator[TopicProof]:
    names = {controller.full_name for controller in manager.controllers}
    for interface in cell.interfaces:
        published = any(end.full_name in names for end in interface.sources)
        if interface.type == JOINT_STATE_TYPE and interface.sinks and published:
            yield TopicProof(kind="topic", topic=interface.name, type=interface.type)


def _managed_nodes(cell: Cell) -> Iterator[LifecycleProof]:
    managed = (node for node in cell.nodes if node.lifecycle and not is_adapter(cell, node))
    return (_lifecycle(node, "active") for node in managed if not asks_for_motion(cell, node))
