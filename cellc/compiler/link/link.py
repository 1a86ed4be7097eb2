"""From what the user wrote to the cell: references bound, units SI, catalog facts joined."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath

from cellc.compiler.catalog.load import load_distros, load_qos_profiles
from cellc.compiler.catalog.tables import RMWS, Rmw
from cellc.compiler.cell.body import Body
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.entity import Places
from cellc.compiler.cell.frame import Frame, SharedArea, Solid
from cellc.compiler.cell.motion import CartesianGoal, NamedPose, Octomap, Pipeline, PlanningGroup, Servo
from cellc.compiler.link.control import as_driven, bind_adapters, link_managers
from cellc.compiler.link.controller import ControlContext
from cellc.compiler.link.derived import Derivation, with_derived
from cellc.compiler.link.devices import BoundDevice, link_devices
from cellc.compiler.link.endpoints import QosResolver, name_endpoints
from cellc.compiler.link.frames import FrameNames, link_areas, link_frames, name_frames
from cellc.compiler.link.hand_eye import Measured, link_hand_eye, with_mounts
from cellc.compiler.link.hopeless import to_first_hopeless
from cellc.compiler.link.interfaces import link_interfaces
from cellc.compiler.link.motion import Machine, link_goals, link_groups, link_poses
from cellc.compiler.link.moveit import link_octomap, link_servo, with_octomap
from cellc.compiler.link.nodes import link_nodes, standard_nodes
from cellc.compiler.link.planners import link_pipelines
from cellc.compiler.link.programs import implied_endpoints, with_programs
from cellc.compiler.link.rehearsals import link_rehearsals
from cellc.compiler.link.robot import link_centers
from cellc.compiler.link.scene import link_scene, scene_frames
from cellc.compiler.link.site import (
    bind_bringup,
    bind_calibrations,
    bind_hosts,
    bind_kpis,
    bind_places,
    bind_recording,
    bind_safety,
    bind_targets,
)
from cellc.compiler.link.switched import link_switched
from cellc.compiler.link.uncertainty import link_uncertainty
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, did_you_mean, only_nearest
from cellc.contract.frozen import dataclass
from cellc.contract.stated import Versions
from cellc.contract.vocabulary import Distro
from cellc.robot.description.model import Description
from cellc.robot.description.packages import lies_under, repository_of


def link(spec: CellSpec, document: SourceDocument) -> Outcome[Cell]:
    """Bind a spec to the catalog.

    Returns:
        The cell where every reference could be bound; all references that could not, together.
    """
    distro = _distro(spec, document)
    packages = _packages(spec, document)
    if packages.value is None:
        return Outcome(None, (*distro.diagnostics, *packages.diagnostics))
    devices = link_devices(spec, document, distro.value, packages.value)
    if distro.value is None or devices.value is None:
        return Outcome(None, (*distro.diagnostics, *devices.diagnostics))
    switched = link_switched(spec, document, devices.value)
    every = Outcome(switched.value, (*devices.diagnostics, *switched.diagnostics))
    linked = _link_with_devices(spec, document, distro.value, every)
    return replace(linked, value=None if linked.value is None else replace(linked.value, packages=packages.value))


def _packages(spec: CellSpec, document: SourceDocument) -> Outcome[tuple[str, ...]]:
    """Return each folder as the current folder sees it; of one that may not be searched, why.

    A folder is relative to the file that names it, as includes are, and lies in the repository of the spec with every
    link followed; without version control that is the spec's own folder.
    """
    repository = repository_of(os.path.dirname(document.file) or ".")
    folders: list[str] = []
    problems: list[Diagnostic] = []
    for number, folder_text in enumerate(spec.packages):
        place = document.locate(("packages", number))
        folder = os.path.normpath(Path(place.file).parent / folder_text).replace(os.sep, "/")
        if os.path.isabs(folder_text) or not lies_under(folder, repository):
            code, message = "include-escape", f"`{folder_text}` leads out of the repository of the spec"
            advice = "name a folder of the repository, relative to the spec, or give it with `--package-path`"
        elif not os.path.isdir(folder):
            code, message = "file-not-found", f"there is no folder `{folder}`"
            advice = "name the folder that holds the packages, relative to the spec"
        else:
            folders.append(folder)
            continue
        problems.append(Diagnostic(code, Severity.ERROR, message, place, ("packages", number), advice))
    return Outcome(None if problems else tuple(folders), tuple(problems))


@dataclass(frozen=True, slots=True)
class _Placement:
    """Where everything is: devices, frames and solid objects, and the calibration files behind some poses."""

    bound: tuple[BoundDevice, ...]
    names: FrameNames
    frames: tuple[Frame, ...]
    scene: tuple[Solid, ...]
    areas: tuple[SharedArea, ...]
    measured: Measured


def _placed(spec: CellSpec, document: SourceDocument, bound: tuple[BoundDevice, ...]) -> Outcome[_Placement]:
    names = name_frames(spec, document, (device.device for device in bound))
    hand_eye = link_hand_eye(spec, document, bound, names)
    measured = hand_eye.value or Measured({}, {}, {})
    bound = with_mounts(bound, measured)
    scene = link_scene(spec, document, names)
    frames = link_frames(spec, document, tuple(device.device for device in bound), names, measured.frames)
    boxes, areas = scene.value or (), link_areas(spec, document, names)
    placement = _Placement(
        bound, names, (*(frames.value or ()), *scene_frames(boxes)), boxes, areas.value or (), measured
    )
    return Outcome(placement, (*hand_eye.diagnostics, *scene.diagnostics, *areas.diagnostics, *frames.diagnostics))


def _link_with_devices(
    spec: CellSpec, document: SourceDocument, distro: Distro, linked_devices: Outcome[tuple[BoundDevice, ...]]
) -> Outcome[Cell]:
    placed = _placed(spec, document, linked_devices.value or ())
    assert placed.value is not None  # what cannot be placed is reported and left out
    bound, names, all_frames = placed.value.bound, placed.value.names, placed.value.frames
    devices = tuple(device.device for device in bound)
    centers = link_centers(spec, devices, names)
    devices = centers.value or devices
    nodes = link_nodes(spec, document, bound)
    managers = link_managers(ControlContext(spec, document, distro, {device.device.name: device for device in bound}))
    loops = managers.value or ()
    started = with_programs((*(nodes.value or ()), *standard_nodes(spec, document, loops)), distro)
    all_nodes = tuple(with_octomap(node, spec) for node in started)
    controllers = tuple(controller for manager in loops for controller in manager.controllers)
    machine = Machine(devices, controllers, all_frames, names, placed=linked_devices.ok and placed.ok)
    planned = _planned(spec, document, distro, machine)
    assert planned.value is not None  # what cannot be bound is reported and left out
    servo = planned.value.servo
    ends = name_endpoints(spec, bound, all_nodes, loops, _qos_resolver(spec), servo)
    interfaces = link_interfaces(spec, document, ends, names)
    source = Derivation(spec, document, loops, devices, all_frames, all_nodes, ends, servo)
    all_interfaces = with_derived(source, interfaces.value or ())
    rehearsals = link_rehearsals(spec, document, devices, loops, all_interfaces, names)
    uncertainty = link_uncertainty(spec, document, machine, planned.value.groups if planned.ok else None)
    cell = replace(
        _surroundings(spec, document, distro, placed.value.measured, devices),
        devices=devices,
        frames=all_frames,
        scene=placed.value.scene,
        areas=placed.value.areas,
        nodes=all_nodes,
        interfaces=all_interfaces,
        managers=loops,
        adapters=tuple(bind_adapters(devices, controllers, all_interfaces)),
        rehearsals=rehearsals.value or (),
        uncertainty=uncertainty.value,
        behaviors={controller.plugin: controller.behavior for controller in controllers},
    )
    parts = (linked_devices, placed, centers, nodes, managers, interfaces, planned, rehearsals, uncertainty)
    linked = as_driven(_with_plans(cell, planned.value))
    return Outcome(linked, tuple(to_first_hopeless(part.diagnostics for part in parts)))


@dataclass(frozen=True, slots=True)
class _Planned:
    """What moves by a plan: groups with their named poses and goals, what plans for them, and servoing."""

    groups: tuple[PlanningGroup, ...]
    pipelines: tuple[Pipeline, ...]
    poses: tuple[NamedPose, ...]
    goals: tuple[CartesianGoal, ...]
    octomap: Octomap | None
    servo: Servo | None


def _planned(spec: CellSpec, document: SourceDocument, distro: Distro, machine: Machine) -> Outcome[_Planned]:
    groups = link_groups(spec, document, distro, machine)
    known = groups.value or ()
    pipelines, poses = link_pipelines(spec, document, distro), link_poses(spec, document, known)
    goals = link_goals(spec, document, known, machine.names)
    servo = link_servo(spec, document, known, machine.controllers)
    octomap = link_octomap(spec.motion.octomap, machine.devices)
    parts = (groups, servo, pipelines, poses, goals)
    planned = _Planned(known, pipelines.value or (), poses.value or (), goals.value or (), octomap, servo.value)
    return Outcome(planned, tuple(problem for part in parts for problem in part.diagnostics))


def _with_plans(cell: Cell, planned: _Planned) -> Cell:
    return replace(
        cell,
        groups=planned.groups,
        pipelines=planned.pipelines,
        poses=planned.poses,
        goals=planned.goals,
        octomap=planned.octomap,
        servo=planned.servo,
    )


def _surroundings(
    spec: CellSpec, document: SourceDocument, distro: Distro, measured: Measured, devices: tuple[Device, ...]
) -> Cell:
    """Return the cell before anything is in it: its hosts, network, owners, safety, figures, and all places."""
    places = bind_places(document)
    table = load_distros().value
    assert table is not None  # package data, held valid by the catalog's tests
    return Cell(
        name=spec.cell,
        places=places,
        distro=distro,
        summary=spec.summary,
        versions=spec.versions,
        hosts=bind_hosts(spec, places),
        network=spec.network,
        calibrations=bind_calibrations(spec, places, measured.files),
        owners=spec.owners,
        surroundings=spec.surroundings,
        safety=bind_safety(spec, devices),
        bringup=bind_bringup(spec, places),
        kpis=bind_kpis(spec),
        recording=bind_recording(spec),
        targets=bind_targets(spec),
        mock_plugins=spec.mock_plugins,
        mock_programs=spec.mock_programs,
        harmless_plugins=frozenset(table.harmless_plugins),
        harmless_programs=frozenset(table.harmless_programs),
        hardware_packages=frozenset(table.hardware_packages),
        implied=implied_endpoints(distro),
    )


def _qos_resolver(spec: CellSpec) -> QosResolver:
    table = load_qos_profiles().value
    assert table is not None  # package data, held valid by the catalog's tests
    return QosResolver(table, _rmw(spec))


def _distro(spec: CellSpec, document: SourceDocument) -> Outcome[Distro]:
    for distro in Distro:
        if spec.versions.ros == distro:
            return Outcome(distro)
    path, name = ("versions", "ros"), spec.versions.ros
    span = document.locate(path)
    problem = Diagnostic(
        code="unknown-distro",
        severity=Severity.ERROR,
        message=f"`{name}` is not a ROS 2 distribution that cellc knows",
        span=span,
        yaml_path=path,
        help=did_you_mean(name, tuple(Distro), "distributions"),
        fix=document.fix(span, name, only_nearest(name, tuple(Distro)), sure=False),
    )
    return Outcome(None, (problem,))


def _rmw(spec: CellSpec) -> Rmw:
    """Return the middleware of the tuple; an unknown one is a rule's finding, and QoS is then that of Fast DDS."""
    name = spec.versions.rmw.split()[0]
    for rmw in RMWS:
        if name == rmw:
            return rmw
    return "rmw_fastrtps_cpp"


def bare_cell(description: Description, file: str, root: str, excused: Mapping[str, str] | None = None) -> Cell:
    """Return a description alone as a cell of one device; what has no place in it begins the file.

    Args:
        root: the folder beside whose files the packages of meshes lie.
        excused: codes that its `device.yaml` excuses, and why.
    """
    start, path = Span(file, 1, 1, 1, 1), ("devices", "robot")
    roots = description.roots()
    device = Device(
        name="robot",
        path=path,
        span=start,
        model=description.name,
        vendor="",
        kind="arm",
        body=Body(description=description, root_link=roots[0] if roots else "", excused=excused or {}),
    )
    beside = Span(PurePosixPath(root, PurePosixPath(file).name).as_posix(), 1, 1, 1, 1)
    places = Places(file, {("cell",): start, ("devices",): start, path: start, (*path, "model"): beside})
    ros = Distro.JAZZY  # no rule on models asks for it
    return Cell(name=description.name, places=places, distro=ros, versions=Versions(ros=ros), devices=(device,))
