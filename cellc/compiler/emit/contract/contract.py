"""``contract.json``: what the cell's artifacts promise, for the mock, for tools and for people.

Format 2, ``cellc.contract.contract``: full ROS names, SI and radians, every default resolved. Read by ``cellc.mock``,
which knows nothing of the spec. Left out: whatever is in the URDF, poses most of all, in the controllers'
parameters and in the SRDF, because the mock reads those; and costs of planning, which are the planner's own.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import (
    BRING_UP,
    REHEARSALS,
    controllers_file,
    description_file,
    semantic_file,
    stage_files,
)
from cellc.compiler.deploy.gate_evidence import left_by
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
from cellc.compiler.feasibility import parts_by_name
from cellc.compiler.formats.json_text import render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.versions import compatibility
from cellc.contract.contract import Contract, ContractFiles, ContractSafety
from cellc.contract.gates import Gates, GateSetting, PinAnswer
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
        interfaces={interface.name: interface for interface in cell.interfaces},
        managers=managers(cell),
        clocks=clocks(cell),
        clock_of=clock_of(cell),
        plugin_behaviors=dict(cell.behaviors),
        devices=devices(cell),
        simulated_joints=simulated_joints(cell),
        adapters=adapters(cell),
        joint_limits=joint_limits(cell),
        parts=parts_by_name(graph),
        groups=groups(cell),
        poses=poses(cell),
        goals=goals(cell),
        responsibilities=dict(cell.owners.responsibilities),
        approvals=dict(cell.owners.approvals),
        safety=_safety(cell),
        kpis=cell.kpis,
        attempt_fields=cell.recording.attempt_fields,
        gates=_gates(cell, plan),
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
        stages=stage_files(cell),
        packages=tuple(os.path.relpath(folder, beside).replace(os.sep, "/") for folder in cell.packages),
    )


def _gates(cell: Cell, plan: Deployment) -> Gates:
    checks = [check for gate in (*plan.promotion, *plan.network) for check in gate.checks]
    settings = list[GateSetting]()
    for setting in (check.setting for check in checks if check.setting is not None):
        settings += () if setting in settings else (setting,)
    versions = tuple(
        PinAnswer(holder=judged.pin.holder, part=judged.pin.part, answer=judged.answer.value, reason=judged.evidence)
        for judged in compatibility(cell)
    )
    evidence = tuple(map(left_by, (*plan.promotion, *plan.network)))
    return Gates(settings=tuple(settings), evidence=evidence, versions=versions)


def _safety(cell: Cell) -> ContractSafety:
    stop, recovery = cell.safety.stop, cell.safety.recovery
    return ContractSafety(
        stop_authority=stop.authority,
        stop_path=stop.path,
        recovery_states=recovery.states,
        acknowledge=recovery.acknowledge,
        on_reconnect=recovery.on_reconnect,
    )
