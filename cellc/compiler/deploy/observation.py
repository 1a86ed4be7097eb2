"""What runs on each target once the cell is launched, before a person releases a claim: what an observer compares."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.deploy.computers import computers
from cellc.compiler.deploy.ends import ends_on
from cellc.compiler.deploy.processes import launch_hosts
from cellc.compiler.deploy.readiness import components_of
from cellc.compiler.deploy.recording import recorded_topics, reporting
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.enclaves import observe_enclave
from cellc.contract.bring_up import CLAIM_WATCH, BringUp, ControllerProof, HardwareProof, LifecycleProof, ManagedState
from cellc.contract.entities import HardwareState, Target
from cellc.contract.observation import Observation, ObservedEnds, ObservedManager, ObservedReading, ObservedTarget
from cellc.contract.vocabulary import BringUpPhase, Feature, features


def observation(graph: CellGraph, plan: BringUp) -> Observation:
    """Return what runs on both targets."""
    targets = {target: _on(graph, plan, target) for target in ("mock", "real")}
    return Observation(
        enclave=observe_enclave(graph.cell),
        recorded=tuple(recorded_topics(graph.cell)),
        computers=computers(graph),
        **targets,
    )


def _on(graph: CellGraph, plan: BringUp, target: Target) -> ObservedTarget:
    cell, placed = graph.cell, tuple(nodes_on(graph.cell, plan, target))
    taken = [step for step in plan.steps(target) if target == "mock" or step.phase is BringUpPhase.START]
    shown = [proof for step in taken for proof in step.effect]
    claimed = [proof for step in plan.steps(target) for proof in step.effect]
    lifecycle: dict[str, ManagedState] = {node.full_name: "inactive" for node in cell.nodes if node.lifecycle}
    lifecycle |= {proof.node: proof.state for proof in shown if isinstance(proof, LifecycleProof)}
    ends = {each.name: ends_on(graph, each, target) for each in cell.interfaces if target in each.targets}
    return ObservedTarget(
        nodes=tuple(sorted({name for name, _ in placed})),
        hosts={host: tuple(sorted({name for name, at in placed if at == host})) for host in launch_hosts(cell)},
        inside={
            node.full_name: tuple(inner.full_name for inner in node.inside)
            for node in cell.nodes
            if node.inside and (target == "real" or not node.real_only)
        },
        ends={name: ObservedEnds(sources=dict(sides[0]), sinks=dict(sides[1])) for name, sides in ends.items()},
        states={
            manager.node: ObservedManager(
                hardware=dict(_components(cell, manager, target))
                | {
                    each.component: each.state
                    for each in shown
                    if isinstance(each, HardwareProof) and each.manager == manager.node
                },
                controllers={each.name: "inactive" for each in manager.controllers if target in each.targets}
                | {
                    each.controller: each.state
                    for each in shown
                    if isinstance(each, ControllerProof) and each.manager == manager.node
                },
                reports=manager.node in reporting(cell),
            )
            for manager in cell.managers
        },
        lifecycle=lifecycle,
        lifecycle_claimed=lifecycle | {each.node: each.state for each in claimed if isinstance(each, LifecycleProof)},
        late_joints=() if target == "mock" else tuple(sorted(_late_joints(cell))),
        readings=() if target == "mock" else tuple(readings(cell)),
    )


def readings(cell: Cell) -> Iterator[ObservedReading]:
    """Yield what the devices say of themselves where this cell has what says it; each release has other interfaces."""
    there = {interface.name for interface in cell.interfaces if "real" in interface.targets}
    for device in cell.devices:
        for reading in device.procedures.readings:
            telling = cell.reporting(device, reading)
            if telling is not None and (name := f"{telling.full_name}/{reading.below}") in there:
                yield ObservedReading(
                    name=reading.name,
                    device=device.name,
                    interface=name,
                    fields=reading.fields,
                    values=dict(reading.values),
                    expected={gate.value: names for gate, names in reading.expected.items()},
                    version=None if reading.version is None else f"{device.name}.{reading.version}",
                )


def _late_joints(cell: Cell) -> Iterator[str]:
    for manager in cell.managers:
        for device in components_of(cell, manager, "real"):
            if device.control.startup_state == "unconfigured":
                yield from (joint.name for joint in device.joints)


def _components(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[tuple[str, HardwareState]]:
    for device in components_of(cell, manager, target):
        if device.control.hardware is not None:
            yield device.control.hardware.name, device.control.startup_state


def nodes_on(cell: Cell, plan: BringUp, target: Target) -> Iterator[tuple[str, str]]:
    """Yield the full name of every node on a target, with its host."""
    for node in cell.nodes:
        if target == "real" or not node.real_only:
            yield node.full_name, node.host
    for manager in cell.managers:
        here = [controller.full_name for controller in manager.controllers if target in controller.targets]
        yield from ((name, manager.host) for name in here)
        for device in components_of(cell, manager, target):
            if device.control.hardware is None:
                continue
            bare = [node.full_name.rpartition("/")[2] for node in device.control.hardware.nodes]
            if Feature.HARDWARE_NODES in features(cell.distro):
                bare.append(device.control.hardware.name.lower().replace("/", "_"))
            yield from ((f"{manager.namespace}/{name}", manager.host) for name in bare)
    if target == "real":
        yield from ((CLAIM_WATCH, watch.host) for watch in plan.watches)
