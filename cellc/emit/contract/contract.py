"""``contract.json``: what the cell's artifacts promise, for the mock, for tools and for people.

Format 1, ``cellc.contract.contract``: full ROS names, SI and radians, every default resolved. Read by ``cellc.mock``,
which knows nothing of the spec. Left out: whatever stands in the URDF and in the controllers' parameters, because the
mock reads those as ros2_control would; and costs of planning, which are the planner's own.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.cell.frame import WORLD
from cellc.contract.contract import Contract, ContractFiles, ContractKpis, ContractSafety
from cellc.deploy.configuration import version_tuple
from cellc.deploy.files import REHEARSALS, controllers_file, description_file
from cellc.deploy.recording import attempt_fields
from cellc.emit.contract.adapters import adapters
from cellc.emit.contract.clocks import clock_of, clocks
from cellc.emit.contract.control import joint_limits, managers
from cellc.emit.contract.devices import devices
from cellc.emit.contract.frames import calibrations, frames
from cellc.emit.contract.interfaces import interfaces
from cellc.emit.contract.motion import disabled_collisions, goals, groups, poses
from cellc.emit.contract.simulated_joints import simulated_joints
from cellc.formats.header import Header
from cellc.formats.json_text import render
from cellc.graph.cell_graph import CellGraph
from cellc.spec.quantity import Quantity


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the contract."""
    yield Artifact("contract.json", render(_contract(graph, header.configuration_id)))


def _contract(graph: CellGraph, configuration_id: str) -> Contract:
    cell = graph.cell
    return Contract(
        format=1,
        cell=cell.name,
        summary=cell.spec.summary,
        configuration_id=configuration_id,
        distro=cell.distro,
        version_tuple=version_tuple(cell),
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
        disabled_collisions=disabled_collisions(graph),
        responsibilities={name: str(owner) for name, owner in cell.spec.owners.responsibilities},
        approvals={name: str(owner) for name, owner in cell.spec.owners.approvals},
        safety=_safety(cell),
        kpis=_kpis(cell),
        attempt_fields=attempt_fields(cell),
    )


def _files(cell: Cell) -> ContractFiles:
    return ContractFiles(
        urdf_mock=description_file(cell, "mock"),
        urdf_real=description_file(cell, "real"),
        parameters={manager.name: controllers_file(cell, manager) for manager in cell.managers},
        rehearsals=REHEARSALS,
    )


def _safety(cell: Cell) -> ContractSafety:
    stop, recovery = cell.spec.safety.stop, cell.spec.safety.recovery
    return ContractSafety(
        stop_authority=stop.authority,
        stop_path=stop.path,
        recovery_states=recovery.states,
        acknowledge=recovery.acknowledge,
        on_reconnect=recovery.on_reconnect,
    )


def _kpis(cell: Cell) -> ContractKpis:
    kpis = cell.spec.kpis
    return ContractKpis(
        plan_to_execute_s=_si(kpis.plan_to_execute),
        cancel_s=_si(kpis.cancel),
        missed_cycles=kpis.missed_cycles,
        stale_state_rejection=_si(kpis.stale_state_rejection),
        protective_stops=kpis.protective_stops,
        recovery_time_s=_si(kpis.recovery_time),
        wrong_owner_events=kpis.wrong_owner_events,
    )


def _si(quantity: Quantity | None) -> float | None:
    return None if quantity is None else quantity.si
