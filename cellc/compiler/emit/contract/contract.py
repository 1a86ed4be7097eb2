"""``contract.json``: what the cell's artifacts promise, for the mock, for tools and for people.

Format 2, ``cellc.contract.contract``: full ROS names, SI and radians, every default resolved. Read by ``cellc.mock``,
which knows nothing of the spec. Left out: whatever is in the URDF, poses most of all, in the controllers'
parameters and in the SRDF, because the mock reads those; and costs of planning, which are the planner's own.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import asdict

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.cell.interface import Endpoint, Interface, Qos
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import BRING_UP, REHEARSALS, controllers_file, description_file, semantic_file
from cellc.compiler.emit.contract.clocks import clock_of, clocks
from cellc.compiler.emit.contract.devices import adapters, devices, simulated_joints
from cellc.compiler.emit.contract.motion import (
    calibrations,
    frames,
    goals,
    groups,
    joint_limits,
    managers,
    poses,
)
from cellc.compiler.emit.contract.uncertainty import uncertainty
from cellc.compiler.formats.json_text import render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.contract import (
    Contract,
    ContractEndpoint,
    ContractFiles,
    ContractInterface,
    ContractKpis,
    ContractNetwork,
    ContractQos,
    ContractSafety,
)
from cellc.contract.uncertainty import UNCERTAINTY_FILE


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the contract, and what sweeps draw where the cell says something of it."""
    contract = _contract(graph, plan)
    yield Artifact("contract.json", render(contract))
    if graph.cell.uncertainty is not None:
        drawn = uncertainty(graph.cell, graph.cell.uncertainty, contract.clocks)
        yield Artifact(UNCERTAINTY_FILE, render(drawn))


def _contract(graph: CellGraph, plan: Deployment) -> Contract:
    cell = graph.cell
    return Contract(
        format=2,
        cell=cell.name,
        summary=cell.summary,
        configuration_id=plan.configuration_id,
        distro=cell.distro,
        version_tuple=dict(plan.versions),
        files=_files(cell),
        root_frame=WORLD,
        calibrations=calibrations(cell),
        frames=frames(cell),
        interfaces=interfaces(cell),
        managers=managers(cell),
        clocks=clocks(cell),
        clock_of=clock_of(cell),
        plugin_behaviours=dict(cell.behaviours),
        devices=devices(cell),
        simulated_joints=simulated_joints(cell),
        adapters=adapters(cell),
        joint_limits=joint_limits(cell),
        groups=groups(cell),
        poses=poses(cell),
        goals=goals(cell),
        responsibilities=dict(cell.owners.responsibilities.items()),
        approvals=dict(cell.owners.approvals.items()),
        safety=_safety(cell),
        kpis=_kpis(cell),
        attempt_fields=cell.recording.attempt_fields,
    )


def _files(cell: Cell) -> ContractFiles:
    beside = os.path.dirname(cell.locate("cell").file) or "."
    return ContractFiles(
        urdf_mock=description_file(cell, "mock"),
        urdf_real=description_file(cell, "real"),
        parameters={manager.name: controllers_file(cell, manager, "mock") for manager in cell.managers},
        srdf=semantic_file(cell) if cell.groups else None,
        rehearsals=REHEARSALS,
        bring_up=BRING_UP,
        packages=tuple(os.path.relpath(folder, beside).replace(os.sep, "/") for folder in cell.packages),
    )


def _safety(cell: Cell) -> ContractSafety:
    stop, recovery = cell.safety.stop, cell.safety.recovery
    return ContractSafety(
        stop_authority=stop.authority,
        stop_path=stop.path,
        recovery_states=recovery.states,
        acknowledge=recovery.acknowledge,
        on_reconnect=recovery.on_reconnect,
    )


def _kpis(cell: Cell) -> ContractKpis:
    kpis = cell.kpis
    return ContractKpis(
        plan_to_execute_s=kpis.plan_to_execute_s,
        cancel_s=kpis.cancel_s,
        missed_cycles=kpis.missed_cycles,
        stale_state_rejection=kpis.stale_state_rejection,
        protective_stops=kpis.protective_stops,
        recovery_time_s=kpis.recovery_time_s,
        wrong_owner_events=kpis.wrong_owner_events,
    )


def interfaces(cell: Cell) -> dict[str, ContractInterface]:
    """Return every interface by its full name."""
    return {interface.name: _interface(interface) for interface in cell.interfaces}


def _interface(interface: Interface) -> ContractInterface:
    return ContractInterface(
        kind=interface.kind.value,
        type=interface.type,
        sources=tuple(map(_endpoint, interface.sources)),
        sinks=tuple(map(_endpoint, interface.sinks)),
        frame=interface.frame,
        unit=interface.unit,
        time_source=interface.time_source,
        owner=interface.owner,
        wants=interface.wants,
        rate_hz=interface.rate_hz,
        max_age_s=interface.max_age_s,
        transport_s=interface.transport_s,
        on_stale=interface.on_stale,
        timeout_s=interface.timeout_s,
        on_timeout=interface.on_timeout,
        on_error=interface.on_error,
        cancel_within_s=interface.cancel_within_s,
        simulated=None if interface.simulated is None else ContractNetwork(**asdict(interface.simulated)),
    )


def _endpoint(end: Endpoint) -> ContractEndpoint:
    # Through validation, because the cell's words are plain text and the contract's are fixed.
    return ContractEndpoint.model_validate(
        {"node": end.node, "full_name": end.full_name, "targets": end.targets, "qos": _qos(end.qos)}
    )


def _qos(qos: Qos) -> ContractQos:
    return ContractQos.model_validate(
        {
            "reliability": qos.reliability,
            "durability": qos.durability,
            "history": qos.history,
            "depth": qos.depth,
            "deadline_s": qos.deadline_s,
            "lifespan_s": qos.lifespan_s,
            "liveliness": qos.liveliness,
            "lease_duration_s": qos.lease_duration_s,
        }
    )
