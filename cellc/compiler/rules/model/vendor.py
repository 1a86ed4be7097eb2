"""Rules on what a vendor says of a robot: kinematics, description and `<ros2_control>`."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

from cellc.compiler.cell.body import KinematicCalibration, Kinematics
from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, Severity, found, rule
from cellc.contract.diagnostics import Span, is_slip
from cellc.contract.pins import day_of
from cellc.contract.vocabulary import UNKNOWN
from cellc.robot.description.model import Description, HardwareInterface, HardwarePart, Joint, as_number
from cellc.robot.description.posture import posture

_OFFSET_M = 0.02
_TURN_RAD = math.radians(2.0)
"""Own choice: ten times what robots of one type differ by, and less than types do."""


@rule(Severity.ERROR)
def implausible_kinematics(graph: CellGraph) -> Findings:
    """Yield devices with a joint that is far from where its type has it."""
    for device in graph.cell.devices:
        calibration = None if device.body.kinematics is None else device.body.kinematics.calibration
        if calibration is not None and (calibration.offset_m > _OFFSET_M or calibration.turn_rad > _TURN_RAD):
            differs = f"{calibration.offset_m * 1000.0:.0f} mm and {math.degrees(calibration.turn_rad):.1f} deg"
            allowed = f"{_OFFSET_M * 1000.0:.0f} mm and {math.degrees(_TURN_RAD):.0f} deg"
            message = (
                f"`{calibration.name}` must lie within {allowed} of the type `{device.model}`, differs by {differs}"
            )
            yield found(graph, (*device.path, "calibration", "file"), message)


@rule(Severity.ERROR)
def kinematics_of_another_robot(graph: CellGraph) -> Findings:
    """Yield the second device with the table of a robot, by its hash."""
    first: dict[str, Device] = {}
    for device in graph.cell.devices:
        kinematics = device.body.kinematics
        calibration = None if kinematics is None else kinematics.calibration
        if kinematics is None or calibration is None or calibration.hash == kinematics.nominal_hash:
            continue
        owner = first.setdefault(calibration.hash, device)
        if owner is not device:
            message = f"`{calibration.name}` must be read from `{device.name}`, got the table of `{owner.name}`"
            related = (Related("first named here", graph.cell.locate(*owner.path, "calibration", "file")),)
            yield found(graph, (*device.path, "calibration", "file"), message, related=related)


@rule(Severity.BLOCKER)
def nominal_kinematics(graph: CellGraph) -> Findings:
    """Yield devices whose kinematics are nominal, or those of a file without a day or an owner."""
    for device in graph.cell.devices:
        kinematics = device.body.kinematics
        if kinematics is not None:
            calibration = kinematics.calibration
            problems = _nominal(device, kinematics) if calibration is None else _unvouched(calibration, kinematics)
            for field, message in problems:
                yield found(graph, (*device.path, "calibration", *field), message)


def _nominal(device: Device, kinematics: Kinematics) -> Iterator[tuple[tuple[str, ...], str]]:
    yield (), f"`{device.name}` uses nominal kinematics; read those of this robot with `{kinematics.tool}`"


def _unvouched(one: KinematicCalibration, kinematics: Kinematics) -> Iterator[tuple[tuple[str, ...], str]]:
    if one.hash == kinematics.nominal_hash:
        yield ("file",), f"`{one.name}` holds nominal kinematics, by its hash `{one.hash}`"
    if one.owner == UNKNOWN:
        yield ("owner",), f"`{one.name}` has no owner"
    if day_of(one.measured) is None:
        yield ("measured",), f"`measured` of `{one.name}` must be a date, got `{one.measured}`"


@rule(Severity.WARNING)
def skipped_command_limit(graph: CellGraph) -> Findings:
    """Yield each interface with a limit that is not a number, at its joint."""
    for device in graph.cell.devices:
        path = (*device.path, "model")
        for part in (part for component in device.body.description.hardware for part in component.joints):
            for interface in part.command_interfaces:
                limits = {"min": interface.minimum, "max": interface.maximum}
                texts = [
                    f"`{key}` is `{text[:40]}`" for key, text in limits.items() if text and as_number(text) is None
                ]
                if texts:
                    message = (
                        f"`{interface.name}` of `{part.name}` has a limit that is not a number: {', '.join(texts)}"
                    )
                    yield Finding(message, part.span or graph.cell.locate(*path), path)


@rule(Severity.WARNING)
def unread_vendor_description(graph: CellGraph) -> Findings:
    """Yield devices whose vendor's description was refused."""
    for device in graph.cell.devices:
        vendor = device.body.vendor_description
        if vendor is not None and vendor.refused:
            message = f"the description of `{device.name}` in `{vendor.folder}` cannot be read: {vendor.refused}"
            yield found(graph, (*device.path, "model"), message)


_COMPONENT_TYPES = ("system", "actuator", "sensor")
_STANDARD = ("position", "velocity", "acceleration", "effort")

Faulty = Iterator[tuple[str, Span | None]]
"""What is wrong, and where the description says it."""


@rule(Severity.ERROR)
def unusable_ros2_control(graph: CellGraph) -> Findings:
    """Yield what ros2_control refuses of the tags, and joints and interfaces that nothing has."""
    for device in graph.cell.devices:
        path = (*device.path, "model")
        for message, span in (*_unloadable(device.body.description), *_of_joints(device)):
            yield Finding(message, span or graph.cell.locate(*path), path)


def _unloadable(description: Description) -> Faulty:
    if description.hardware_error:
        yield f"ros2_control refuses the description: {description.hardware_error}", description.hardware_error_span
    names = Counter(component.name for component in description.hardware)
    for component in description.hardware:
        if component.type not in _COMPONENT_TYPES:
            yield (
                f"`type` of `{component.name}` must be one of {', '.join(_COMPONENT_TYPES)}, got `{component.type}`",
                component.span,
            )
        if names[component.name] > 1:
            yield f"two components have the name `{component.name}`", component.span
        if not component.plugin:
            yield f"`{component.name}` names no plugin", component.span


def _of_joints(device: Device) -> Faulty:
    joints = {joint.name.removeprefix(device.body.prefix): joint for joint in device.body.description.joints}
    commanded: dict[str, str] = {}
    for component in device.body.description.hardware:
        for part in component.joints:
            joint = joints.get(part.name)
            if joint is None:
                yield f"`{component.name}` has the joint `{part.name}`, which the description does not have", part.span
            elif joint.mimic is not None and part.command_interfaces and part.mimic != "false":
                yield f"`{part.name}` follows another joint, but has command interfaces", part.span
            if part.command_interfaces and part.name in commanded:
                yield f"`{part.name}` is commanded by `{commanded[part.name]}` and `{component.name}`", part.span
            elif part.command_interfaces:
                commanded[part.name] = component.name
            yield from _of_interfaces(part)
            follows = joint is not None and joint.mimic is not None
            if not part.command_interfaces and not part.state_interfaces and not follows:
                yield f"`{part.name}` of `{component.name}` has no interface", part.span


def _of_interfaces(part: HardwarePart) -> Faulty:
    for kind, interfaces in (("command", part.command_interfaces), ("state", part.state_interfaces)):
        names = Counter(interface.name for interface in interfaces)
        for interface in interfaces:
            near = next((text for text in _STANDARD if is_slip(interface.name, text)), None)
            if near is not None and interface.name not in _STANDARD:
                yield f"`{part.name}` has the {kind} interface `{interface.name}`, which is not `{near}`", part.span
            for wrong in _wrong_bounds(interface):
                yield f"`{interface.name}` of `{part.name}` {wrong}", part.span
        for name in (name for name, count in names.items() if count > 1):
            yield f"`{part.name}` has the {kind} interface `{name}` twice", part.span


def _wrong_bounds(interface: HardwareInterface) -> Iterator[str]:
    if interface.initial_value and as_number(interface.initial_value) is None:
        yield f"must have a number in `initial_value`, got `{interface.initial_value[:40]}`"
    least, most = as_number(interface.minimum), as_number(interface.maximum)
    if least is not None and most is not None and least > most:
        yield f"must have `min` at most `max`, got {least:g} and {most:g}"


_LENGTH_M = 1e-5
"""By which frames may differ: vendors round the figures of their files."""
_ANGLE_RAD = 1e-4
_SHARE = 1e-3
_OFF_RAD_OR_M = 0.1


@rule(Severity.WARNING)
def vendor_description_differs(graph: CellGraph) -> Findings:
    """Yield one finding for each device that differs, with the largest difference of each kind."""
    for device in graph.cell.devices:
        vendor = device.body.vendor_description
        if vendor is None or vendor.description is None:
            continue
        placed = filter(None, _placed(device, vendor.description))
        differences = [*placed, *_limited(device.body.description, vendor.description)]
        if differences:
            message = f"`{device.name}` differs from the description in `{vendor.folder}`: {'; '.join(differences)}"
            yield found(graph, (*device.path, "model"), message)


def _placed(device: Device, vendor: Description) -> Iterator[str]:
    """Yield how far a link is from where the vendor has it; the calibration of one robot is compared with nothing."""
    if device.body.kinematics is not None and device.body.kinematics.calibration is not None:
        return
    movable = [joint.name for joint in device.body.description.joints if joint.movable]
    for positions in ({}, {name: _OFF_RAD_OR_M * (number + 1) for number, name in enumerate(movable)}):
        ours, theirs = posture(device.body.description, positions), posture(vendor, positions)
        base = theirs.get(device.body.root_link)
        shared = [name for name in ours if name in theirs]
        if base is None or len(shared) < 2:
            yield f"it has no link `{device.body.root_link}`" if base is None else "no link has the same name"
            return
        apart = {name: ours[name].inverse() @ base.inverse() @ theirs[name] for name in shared}
        far = max(shared, key=lambda name: math.dist(apart[name].position, (0, 0, 0)))
        turned = max(shared, key=lambda name: math.dist(apart[name].rotation_vector(), (0, 0, 0)))
        length = math.dist(apart[far].position, (0, 0, 0))
        angle = math.dist(apart[turned].rotation_vector(), (0, 0, 0))
        if length > _LENGTH_M or angle > _ANGLE_RAD:
            yield f"`{far}` is {length * 1000:.3g} mm off" if length > _LENGTH_M else ""
            yield f"`{turned}` is turned by {math.degrees(angle):.3g} deg" if angle > _ANGLE_RAD else ""
            return


def _limited(ours: Description, vendor: Description) -> Iterator[str]:
    for joint in ours.joints:
        theirs = vendor.joint(joint.name) if joint.movable else None
        if theirs is not None:
            yield from _limit_figures(joint, theirs)


def _limit_figures(joint: Joint, theirs: Joint) -> Iterator[str]:
    if joint.limit is None or theirs.limit is None or joint.type != theirs.type:
        if joint.type != theirs.type:
            yield f"`{joint.name}` is {joint.type} here and {theirs.type} there"
        return
    for figure in ("lower", "upper", "velocity", "effort"):
        here, there = getattr(joint.limit, figure), getattr(theirs.limit, figure)
        if here is not None and there is not None and not math.isclose(here, there, rel_tol=_SHARE, abs_tol=_SHARE):
            yield f"{figure} of `{joint.name}` is {here:.6g} here and {there:.6g} there"
