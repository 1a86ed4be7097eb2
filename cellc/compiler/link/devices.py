"""Binds each device to its catalog entry or folder: prefix, joints with limits, hardware component, mount."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from cellc.compiler.catalog.device_interfaces import JointInterfaces
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.limit_facts import AccelerationLimit, JerkLimit, VelocityLimit
from cellc.compiler.catalog.load import CatalogDevice, device_names, load_device, load_device_folder
from cellc.compiler.cell.body import Body, Kinematics, Mount, VendorMount
from cellc.compiler.cell.device import EVERY_JOINT, Device, DeviceJoint, DeviceSite
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.link.device_facts import (
    connection_of,
    device_control,
    device_limits,
    device_mock,
    device_sensing,
    device_software,
    limit_shares,
    mounted_on,
    network_needs,
    vendor_procedures,
)
from cellc.compiler.link.hardware import hardware_component
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.kinematics import kinematic_parameters, link_kinematics
from cellc.compiler.link.names import (
    Placeholders,
    controllers_by_device,
    home_host,
    placeholders,
    port_of,
    unknown_name,
)
from cellc.compiler.link.ports import port_shifts
from cellc.compiler.link.quantities import pose
from cellc.compiler.link.robot import program_parameters, robot_controller, robot_words
from cellc.compiler.link.site import bind_places
from cellc.compiler.link.tool import gripper_of, gripper_words, host_programs, tool_parameters, tool_words
from cellc.compiler.link.vendor_description import link_vendor_description, with_vendor_shapes
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.source.text import lies_under
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.devices import DeviceSpec
from cellc.contract.diagnostics import (
    Diagnostic,
    Outcome,
    Related,
    Severity,
    Span,
    YamlPath,
    did_you_mean,
    only_nearest,
)
from cellc.contract.frozen import dataclass
from cellc.contract.limits import Budget, children_seconds, limits
from cellc.contract.transforms import identity
from cellc.contract.vocabulary import Distro
from cellc.robot.description.model import Description, Joint


@dataclass(frozen=True, slots=True)
class BoundDevice:
    """A device with the catalog entry that it was bound to, and what fills the placeholders of the entry's texts."""

    device: Device
    facts: DeviceModel
    names: Placeholders


@dataclass(frozen=True, slots=True)
class _Found:
    """What the devices of a spec are bound to."""

    spec: CellSpec
    document: SourceDocument
    distro: Distro | None
    packages: Sequence[str]
    budget: Budget
    entries: Mapping[str, CatalogDevice]
    kinematics: Mapping[str, Kinematics | None]
    controllers: Mapping[str, Mapping[str, str]]


def link_devices(
    spec: CellSpec, document: SourceDocument, distro: Distro | None, packages: Sequence[str] = ()
) -> Outcome[tuple[BoundDevice, ...]]:
    """Bind every device of the spec; parents of mounts are resolved among the devices themselves.

    Args:
        distro: the distribution that decides which release of a driver runs; None where the spec names none.
        packages: further folders of packages that the spec names.
    """
    entries: dict[str, CatalogDevice] = {}
    kinematics: dict[str, Kinematics | None] = {}
    problems: list[Diagnostic] = []
    budget, controllers = Budget(limits().xacro_seconds_together, children_seconds), controllers_by_device(spec)
    for name, device_spec in until_hopeless(spec.devices.items(), problems):
        entry = _catalog_entry(name, device_spec, document, budget, packages)
        problems += entry.diagnostics
        if entry.value is not None:
            known = placeholders(name, prefix_of(name, device_spec), device_spec, spec, controllers.get(name, {}))
            calibrated = link_kinematics(name, device_spec, entry.value, known, document)
            problems += calibrated.diagnostics
            entries[name], kinematics[name] = calibrated.value or (entry.value, None)
        problems += _connection_problems(name, device_spec, spec, document)
    if len(entries) < len(spec.devices):
        return Outcome(None, tuple(problems))
    devices: list[BoundDevice] = []
    found = _Found(spec, document, distro, packages, budget, entries, kinematics, controllers)
    shifts = port_shifts({name: (spec.devices[name], entry.model) for name, entry in entries.items()})
    frames, carried = _mount_frames(spec, entries), _carried(spec)
    for name, device_spec in until_hopeless(spec.devices.items(), problems):
        parent = _parent_frame(name, device_spec, document, frames)
        problems += parent.diagnostics
        # Mounted somewhere even so: what refers to its frames, its node and its joints is right.
        mount = _mount(device_spec, parent.value or WORLD, entries[name].model, carried.get(name, ()))
        bound = _device(name, found, mount, shifts[name])
        problems += _unknown_simulated_joints(bound.device, document)
        devices.append(bound)
    return Outcome(tuple(devices) if len(devices) == len(entries) else None, tuple(problems))


def _unknown_simulated_joints(device: Device, document: SourceDocument) -> list[Diagnostic]:
    names = [joint.local_name for joint in device.actuated_joints]
    return [
        unknown_name("unknown-joint", joint.name, "joint", names, document, joint.path)
        for joint in device.mock.simulated_joints
        if joint.name not in (*names, EVERY_JOINT)
    ]


def prefix_of(name: str, written: DeviceSpec) -> str:
    """Return what is before every ROS name of a device; an empty prefix is the user's right."""
    return f"{name}_" if written.prefix is None else written.prefix


def _catalog_entry(
    name: str, written: DeviceSpec, document: SourceDocument, budget: Budget, packages: Sequence[str]
) -> Outcome[CatalogDevice]:
    path = ("devices", name, "model")
    if "/" in written.model or written.model.startswith("."):
        return local_device(written.model, document.locate(path), path, budget, packages)
    if written.model not in device_names():
        problem = Diagnostic(
            code="unknown-model",
            severity=Severity.ERROR,
            message=f"the catalog has no model `{written.model}`",
            span=document.locate(path),
            yaml_path=path,
            help=did_you_mean(written.model, device_names(), "models of the catalog, or a folder with a device.yaml"),
            fix=document.fix(
                document.locate(path), written.model, only_nearest(written.model, device_names()), sure=False
            ),
        )
        return Outcome(None, (problem,))
    return load_device(written.model)


def _connection_problems(
    name: str, written: DeviceSpec, spec: CellSpec, document: SourceDocument
) -> tuple[Diagnostic, ...]:
    connection = written.connection
    if connection is None:
        return ()
    path = ("devices", name, "connection")
    if connection.host not in spec.hosts:
        return (unknown_name("unknown-host", connection.host, "host", spec.hosts, document, (*path, "host")),)
    if connection.through is not None and connection.through not in spec.devices:
        place = (*path, "through")
        return (unknown_name("unknown-device", connection.through, "device", spec.devices, document, place),)
    nics = spec.hosts[connection.host].nics
    if connection.nic is None or connection.nic in nics:
        return ()
    return (unknown_name("unknown-nic", connection.nic, "network card", nics, document, (*path, "nic")),)


def _mount_frames(spec: CellSpec, entries: Mapping[str, CatalogDevice]) -> dict[str, str]:
    """Return the frames that a mount may name; those of the spec are not linked yet, and are taken as written."""
    known = {WORLD: WORLD} | {frame: frame for frame in (*spec.frames, *spec.scene)}
    for name, entry in entries.items():
        prefix = prefix_of(name, spec.devices[name])
        known.update((f"{name}/{short}", prefix + link) for short, link in _frame_names(entry).items())
    return known


def _parent_frame(name: str, written: DeviceSpec, document: SourceDocument, known: Mapping[str, str]) -> Outcome[str]:
    """Bind the parent of a mount."""
    if written.mount is None:
        return Outcome(WORLD)
    reference = written.mount.parent
    if reference in known:
        return Outcome(known[reference])
    path = ("devices", name, "mount", "parent")
    return Outcome(None, (unknown_name("unknown-frame", reference, "frame", known, document, path),))


def _frame_names(entry: CatalogDevice) -> dict[str, str]:
    """Return local link names and the short names of the catalog, which win."""
    return {link.name: link.name for link in entry.description.links} | dict(entry.model.frames)


def _device(name: str, found: _Found, mount: Mount, port_shift: int) -> BoundDevice:
    path, written, entry = ("devices", name), found.spec.devices[name], found.entries[name]
    facts, prefix, kinematics = entry.model, prefix_of(name, written), found.kinematics[name]
    named = placeholders(name, prefix, written, found.spec, found.controllers.get(name, {}), port_shift)
    words = {**dict(robot_words(written)), **dict(tool_words(facts, written)), **gripper_words(facts)}
    known = replace(named, values={**named.values, **words})
    parameters = {
        **program_parameters(facts, written),
        **tool_parameters(facts, written, known),
        **kinematic_parameters(kinematics, facts),
    }
    hardware = hardware_component(facts, known, prefix, found.distro, written.driver, parameters)
    joints = _joints(name, written, found.document, facts, entry.description, prefix)
    device = Device(
        name=name,
        path=path,
        span=found.document.locate(path),
        model=facts.model,
        vendor=facts.vendor,
        kind=facts.kind,
        architecture=written.architecture,
        body=_body(entry, prefix, kinematics, found),
        joints=joints,
        mount=mount,
        control=device_control(facts, written, known, found.distro, hardware),
        site=DeviceSite(
            host=home_host(found.spec) if written.connection is None else written.connection.host,
            connection=connection_of(written, port_of(written, found.spec)),
            network=network_needs(facts, known),
            programs=host_programs(name, facts, written, known),
        ),
        software=device_software(facts, written),
        robot=robot_controller(facts, written),
        sensing=device_sensing(facts, written, known, prefix),
        gripper=gripper_of(facts, written, prefix),
        limits=device_limits(facts, written),
        procedures=vendor_procedures(facts, written, known, found.distro),
        mock=device_mock(facts, written, prefix, path, joints, found.document),
    )
    return BoundDevice(device, facts, known)


def _body(entry: CatalogDevice, prefix: str, kinematics: Kinematics | None, found: _Found) -> Body:
    facts = entry.model
    vendor = link_vendor_description(facts, found.document, prefix, found.budget, found.packages)
    return Body(
        prefix=prefix,
        description=with_vendor_shapes(entry.description.renamed(prefix), vendor),
        root_link=prefix + facts.base,
        frames={short: prefix + link for short, link in _frame_names(entry).items()},
        tool_frame=None if facts.tool_frame is None else prefix + facts.frames.get(facts.tool_frame, facts.tool_frame),
        optical_frames=facts.optical_frames,
        vendor_description=vendor,
        kinematics=kinematics,
        allowed_collisions=tuple(
            (prefix + a, prefix + b) for a, b in (pair.links for pair in facts.allowed_collisions)
        ),
        excused={str(code): because for code, because in facts.excused.items()},
        places=None if entry.document is None else bind_places(entry.document),
    )


def _mount(written: DeviceSpec, parent: str, facts: DeviceModel, carries: Sequence[str]) -> Mount:
    mount = written.mount
    return Mount(
        parent_frame=parent,
        transform_root_to_parent=identity() if mount is None else pose(mount.xyz, mount.rpy),
        mounted_on=mounted_on(written),
        vendor_mounts=tuple(
            VendorMount(model=arm.on, frame=arm.frame, pose=pose(arm.xyz, arm.rpy)) for arm in facts.mounts
        ),
        carries=tuple(carries),
    )


def _carried(spec: CellSpec) -> dict[str, list[str]]:
    """Return the devices whose mount names a frame of a device, in the order of the spec."""
    carried: dict[str, list[str]] = {}
    for name, device_spec in spec.devices.items():
        parent = "" if device_spec.mount is None else device_spec.mount.parent
        carrier = parent.partition("/")[0] if "/" in parent else ""  # a device may have the name of a frame
        if carrier != name:
            carried.setdefault(carrier, []).append(name)
    return carried


def _joints(
    device: str,
    written: DeviceSpec,
    document: SourceDocument,
    facts: DeviceModel,
    description: Description,
    prefix: str,
) -> tuple[DeviceJoint, ...]:
    path = ("devices", device)
    shares = limit_shares(written)
    return tuple(
        DeviceJoint(
            name=prefix + joint.name,
            path=path,
            span=document.locate(path),
            local_name=joint.name,
            type=joint.type,
            lower=None if joint.limit is None else joint.limit.lower,
            upper=None if joint.limit is None else joint.limit.upper,
            velocity=_scaled(None if joint.limit is None else joint.limit.velocity, shares.velocity),
            velocity_everywhere=_limit(facts.limits.velocity_of(joint.name)),
            acceleration=_scaled(_limit(facts.limits.acceleration_of(joint.name)), shares.acceleration),
            jerk=_limit(facts.limits.jerk_of(joint.name)),
            effort=None if joint.limit is None else joint.limit.effort,
            assumed=() if joint.mimic is not None else tuple(facts.limits.assumed_of(joint.name)),
            mimics=None if joint.mimic is None else prefix + joint.mimic.joint,
            command_interfaces=_interfaces(facts, joint).command,
            state_interfaces=_interfaces(facts, joint).state,
        )
        for joint in description.joints
        if joint.movable
    )


def _limit(limit: VelocityLimit | AccelerationLimit | JerkLimit | None) -> float | None:
    return None if limit is None else limit.value.si


def _scaled(value: float | None, share: float) -> float | None:
    return None if value is None else value * share


def _interfaces(facts: DeviceModel, joint: Joint) -> JointInterfaces:
    """Return what hardware offers for a joint; a mimic joint follows and is offered nothing unless it is named."""
    offered = {} if facts.control is None else facts.control.joints
    if joint.name in offered:
        return offered[joint.name]
    if "*" in offered and joint.mimic is None:
        return offered["*"]
    return JointInterfaces()


def local_device(
    model: str, place: Span, path: YamlPath, budget: Budget, packages: Sequence[str] = ()
) -> Outcome[CatalogDevice]:
    """Load the device of a folder; what is wrong in it is reported there, with the line of the spec that names it.

    Args:
        model: the folder, relative to the file that names it.
        place: where the spec names it.
        path: the same place in the document.
        budget: what expansions of the spec may still take.
        packages: further folders of packages that the spec names.
    """
    root = Path(place.file).parent
    folder = root / model
    if not os.path.exists(folder / "device.yaml"):
        problem = "holds no `device.yaml`" if os.path.isdir(folder) else "is not a folder"
        shown = folder.as_posix()
        advice = "write the folder with its `device.yaml`, or name a model of the catalog"
        missing = Diagnostic("unknown-model", Severity.ERROR, f"`{shown}` {problem}", place, path, advice)
        return Outcome(None, (missing,))
    if not lies_under(folder / "device.yaml", root):
        message = f"`{folder.as_posix()}/device.yaml` leads out of the folder of the spec"
        advice = "move the folder of the device beside the spec"
        return Outcome(None, (Diagnostic("include-escape", Severity.ERROR, message, place, path, advice),))
    loaded = load_device_folder(folder, root, budget, packages)
    named = Related("the spec names this folder here", place)
    return Outcome(
        loaded.value,
        tuple(replace(diagnostic, related=(*diagnostic.related, named)) for diagnostic in loaded.diagnostics),
    )
