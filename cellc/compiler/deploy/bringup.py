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
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.cell.interface import Node
from cellc.compiler.deploy.processes import asks_for_motion, is_adapter, motion_clients
from cellc.compiler.deploy.proofs import (
    EVERY_CLAIM,
    EVERY_STEP,
    Lists,
    active_hardware,
    component,
    controller_proof,
    following,
    hardware_proof,
    joint_states,
    lifecycle_proof,
    lists,
    managed_nodes,
    shared,
    silent,
    transforms,
)
from cellc.compiler.deploy.readiness import (
    activated_later,
    components_of,
    components_read,
    hardware_before,
    is_claiming,
    is_exported,
    measured_in,
    moved_with,
    readers_of,
    started_active,
)
from cellc.compiler.deploy.versions import compared_on
from cellc.compiler.deploy.watches import heard, watches
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.enclaves import bring_up_enclave
from cellc.compiler.graph.simulated import is_asked, simulated
from cellc.compiler.link.derived import JOINT_STATE_TYPE
from cellc.contract.bring_up import (
    CLAIM_WATCH,
    Acknowledgment,
    ActionProof,
    Activation,
    BringUp,
    BringUpStep,
    Comparison,
    HardwareActivation,
    NodeProof,
    Proof,
    Request,
    Restart,
    SingleProof,
    TopicProof,
    Transition,
    Watch,
)
from cellc.contract.entities import LaunchTarget, Target
from cellc.contract.vocabulary import BringUpPhase, InterfaceKind

DEADLINE_S = 60.0
"""How long a step waits for its proof, and for its effect."""


def bring_up(cell: Cell) -> BringUp:
    """Return the plan of a cell: steps of each target in the order of their phases, and what the stopper watches."""
    plans: dict[LaunchTarget, tuple[Lists, tuple[BringUpStep, ...]]] = {"mock": _plan(cell, "mock")}
    if is_asked(cell):
        plans["sim"] = _plan(simulated(cell), "mock")
    plans["real"] = _plan(cell, "real")
    return BringUp(
        format=2,
        cell=cell.name,
        enclave=bring_up_enclave(cell),
        shared={target: lists for target, (lists, _) in plans.items()},
        mock=plans["mock"][1],
        sim=plans["sim"][1] if "sim" in plans else (),
        real=(*_comparisons(cell), *plans["real"][1]),
        watches=tuple(watches(cell)),
    )


def planned(graph: CellGraph) -> BringUp:
    """Return the plan of a graph: the question that every stage above asks once (`CellGraph.once`)."""
    return bring_up(graph.cell)


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


def _plan(cell: Cell, target: Target) -> tuple[Lists, tuple[BringUpStep, ...]]:
    """Return the lists of a target, and its steps, each of which waits for what every step waits for."""
    steps = (step.model_copy(update={"proof": (EVERY_STEP, *step.proof)}) for step in _steps(cell, target))
    return shared(tuple(steps), lists(cell, target))


def _steps(cell: Cell, target: Target) -> Iterator[BringUpStep]:
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
        [lifecycle_proof(node, "inactive")],
    )


def _activate(cell: Cell, node: Node, target: Target, phase: BringUpPhase, release: str = "") -> BringUpStep:
    return _step(
        phase,
        f"activate_{node.name}",
        node.host,
        [
            lifecycle_proof(node, "inactive"),
            *(tf for parent in measured_in(cell, node) for tf in transforms(cell, target, WORLD, parent)),
        ],
        Transition(kind="transition", node=node.full_name, transition="activate"),
        [lifecycle_proof(node, "active")],
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
            hardware_proof(manager, device, "active")
            for device in components_of(cell, manager, target)
            if device not in later  # or a person was faster
        )
        yield _step(
            BringUpPhase.START,
            f"observe_{manager.name}",
            manager.host,
            [
                *components,
                *(controller_proof(manager, name, "inactive") for name in spawned),
            ],
            Activation(kind="controllers", manager=manager.node, controllers=observing) if observing else None,
            [controller_proof(manager, name, "active") for name in observing],
        )


def _activate_hardware(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[BringUpStep]:
    """Yield what takes hardware to active that moves by it, one device a release, and then restarts what reads it."""
    for device in activated_later(cell, manager, target):
        yield _step(
            BringUpPhase.ACTIVATE,
            f"activate_{device.name}",
            manager.host,
            [*(silent(cell, device) if target == "real" else ())],
            HardwareActivation(kind="hardware", manager=manager.node, component=component(device)),
            [hardware_proof(manager, device, "active")],
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
                [*(controller_proof(manager, name, "inactive") for name in reading)],
                Restart(kind="restart", manager=manager.node, controllers=reading),
                [controller_proof(manager, name, "active") for name in reading],
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
                active_hardware(manager),
                *(controller_proof(manager, name, "inactive") for name in names),
                *joint_states(cell, manager),
                EVERY_CLAIM,
                following(manager),
            ],
            Activation(kind="controllers", manager=manager.node, controllers=tuple(names)),
            [controller_proof(manager, name, "active") for name in names],
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
            lifecycle_proof(node, "inactive"),
            TopicProof(kind="topic", topic=adapted.state_topic, type=JOINT_STATE_TYPE),
        ],
        Transition(kind="transition", node=node.full_name, transition="activate"),
        [lifecycle_proof(node, "active")],
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
        controller_proof(manager, controller.name, "active")
        for manager in cell.managers
        for controller in started_active(manager, target)
        if is_claiming(cell, controller, ())
    )
    adapted = tuple(adapter.action for adapter in cell.adapters)
    adapting = (lifecycle_proof(node, "active") for node in cell.nodes if target == "real" and is_adapter(cell, node))
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
    proof: list[Proof] = [*claimed, *adapting, *followed, *actions, *managed_nodes(cell)]
    return _step(BringUpPhase.MOVE, "move", "", proof, None, [])


def _step(
    phase: BringUpPhase,
    name: str,
    host: str,
    proof: list[Proof],
    request: Request | None,
    effect: list[SingleProof],
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
