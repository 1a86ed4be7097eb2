"""Rules on what devices are mounted on, and where."""

from __future__ import annotations

import math

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.transforms import Vector3

_FARTHEST_M = 0.5


@rule(Severity.WARNING)
def detached_mount(graph: CellGraph) -> Findings:
    """Yield devices whose root is more than 0.5 m from the frame of another device that moves it.

    The base of an arm carries nothing: a calibration beside the robot has the pose of the camera in it.
    """
    links = {link.name for device in graph.cell.devices for link in device.body.description.links}
    for device in graph.cell.devices:
        far_m = math.hypot(*device.mount.transform_root_to_parent.position)
        moves = any(frame.moving for frame in graph.frames.chain(device.mount.parent_frame))
        if moves and device.mount.parent_frame in links and far_m > _FARTHEST_M:
            message = (
                f"`{device.name}` must be within {_FARTHEST_M:g} m of `{device.mount.parent_frame}`, which carries it,"
            )
            yield found(graph, (*device.path, "mount"), f"{message} got {far_m:.2g} m")


@rule(Severity.ERROR, assumes=("frame-cycle",))
def mount_on_dynamic_frame(graph: CellGraph) -> Findings:
    """Yield devices with a published frame between them and the next link or the world."""
    for device in graph.cell.devices:
        for frame in graph.frames.chain(device.mount.parent_frame):
            if frame.kind in (FrameKind.LINK, FrameKind.MOUNT):
                break
            if frame.kind is FrameKind.DYNAMIC:
                message = f"`{device.name}` must be mounted on what the robot description has, got `{frame.name}`"
                path = (*device.path, "mount", "parent")
                yield found(graph, path, f"{message}, which `{frame.authority}` publishes")


_LEVEL_RAD = math.radians(1.0)


@rule(Severity.ERROR, assumes=("frame-cycle",))
def tilted_base(graph: CellGraph) -> Findings:
    """Yield devices whose base is further from upright than their controllers compensate gravity for."""
    for device in graph.cell.devices:
        pose, most = graph.frames.in_world(device.body.root_link), device.limits.tilt_rad
        if pose is None or most is None:
            continue
        up = pose.apply((0.0, 0.0, 1.0))[2] - pose.position[2]
        tilt = math.acos(max(-1.0, min(1.0, up)))
        if tilt > most + _LEVEL_RAD:
            path = (*device.path, "mount")
            message = f"the base of `{device.name}` must be at most {math.degrees(most):g} deg from upright,"
            yield found(graph, path, f"{message} got {math.degrees(tilt):.3g} deg")


_APART_M = 1e-3
_APART_RAD = math.radians(1.0)


@rule(Severity.WARNING)
def mounted_against_vendor(graph: CellGraph) -> Findings:
    """Yield devices whose pose on the frame that the vendor names is another than the vendor's."""
    for device in graph.cell.devices:
        for mount in device.mount.vendor_mounts:
            for arm in graph.cell.devices:
                if arm.model != mount.model or arm.body.frames.get(mount.frame) != device.mount.parent_frame:
                    continue
                off = mount.pose.inverse() @ device.mount.transform_root_to_parent
                if math.hypot(*off.position) > _APART_M or math.hypot(*off.rotation_vector()) > _APART_RAD:
                    message = f"`{device.name}` must sit on `{arm.name}/{mount.frame}` as its vendor has it:"
                    message += f" xyz {_millimeters(mount.pose.position)} mm, rpy {_degrees(mount.pose.rpy())} deg"
                    yield found(graph, (*device.path, "mount"), message)


def _millimeters(position: Vector3) -> str:
    return " ".join(f"{round(value * 1e3, 3) + 0.0:g}" for value in position)


def _degrees(angles: Vector3) -> str:
    return " ".join(f"{round(math.degrees(angle), 3) + 0.0:g}" for angle in angles)


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def mounted_inside_another(graph: CellGraph) -> Findings:
    """Yield pairs of devices with links that touch in every posture; of two the one that is no arm, or comes later."""
    owners = {link.name: device for device in graph.cell.devices for link in device.body.description.links}
    reported: set[tuple[str, str]] = set()
    for contact in motion_answer(graph).rigid:
        first, other = owners.get(contact.first), owners.get(contact.second)
        if first is None or other is None or first is other:
            continue
        wrong, right = sorted((first, other), key=lambda device: _doubt(graph, device))
        if (wrong.name, right.name) in reported:
            continue
        reported.add((wrong.name, right.name))
        message = f"`{wrong.name}` must be outside of `{right.name}`, but `{contact.first}` and `{contact.second}`"
        related = (Related("the other device", graph.cell.locate(*right.path, "mount")),)
        yield found(graph, (*wrong.path, "mount"), f"{message} touch in every pose", related=related)


def _doubt(graph: CellGraph, device: Device) -> tuple[int, int]:
    """Order the devices by how likely their mount is the wrong one: cameras first, arms last, later before earlier."""
    kinds = {"camera": 0, "gripper": 1, "arm": 2}
    return kinds.get(device.kind, 1), -graph.cell.devices.index(device)


@rule(Severity.ERROR)
def shared_prefix(graph: CellGraph) -> Findings:
    """Yield the second device of those with a link in common, with all others that have one."""
    owners: dict[str, Device] = {}
    reported: set[str] = set()
    for device in graph.cell.devices:
        links = [link.name for link in device.body.description.links]
        first = next((owners[name] for name in links if name in owners), None)
        if first is not None and device.name not in reported:
            reported.add(device.name)
            shared = [name for name in links if owners.get(name) is first]
            more = f" and {len(shared) - 1} more" if len(shared) > 1 else ""
            prefix = f"prefix `{device.body.prefix}`" if device.body.prefix else "empty prefix"
            message = f"`{device.name}` must have names of its own, but with its {prefix} link `{shared[0]}`{more}"
            related = (Related("the other device", graph.cell.locate(*first.path, "prefix")),)
            path = (*device.path, "prefix")
            yield found(graph, path, f"{message} is also one of `{first.name}`", related=related)
        for name in links:
            owners.setdefault(name, device)
