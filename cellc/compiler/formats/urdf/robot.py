"""The whole ``<robot>``: the world, devices at their mounts, fixed frames and the scene, one tree.

Every static frame is in it, so that robot_state_publisher is the one authority for all of them. Dynamic frames and
what hangs on them stay out: their publisher is their authority.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device, DeviceJoint
from cellc.compiler.cell.frame import WORLD, Frame, FrameKind, Solid
from cellc.compiler.formats.urdf.elements import (
    device_joint,
    device_link,
    fixed_joint,
    frame_link,
    palette_of,
    scene_link,
    scene_materials,
)
from cellc.compiler.formats.urdf.hardware import HEADLESS, for_xacro, ros2_control, simulator
from cellc.compiler.formats.xml_text import comment, element, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.contract.entities import Target

HOME = "home"
"""A named pose of this name is where the cell begins."""

START = "start"
"""What a simulator calls where a cell without one begins."""


def robot_description(cell: Cell, target: Target) -> Element:
    """Return the description of a cell for the target ``mock`` or ``real``, with the hardware of all devices."""
    return manager_description(cell, target, tuple(device.name for device in cell.devices))


def real_description(graph: CellGraph) -> str:
    """Return the text of the description for the target ``real``: a question that a graph answers once."""
    return render(robot_description(graph.cell, "real"))


def simulated_description(cell: Cell, scene: str) -> Element:
    """Return the description of a cell with one simulator for all of its hardware; ``scene`` is its path there."""
    argument = element("xacro:arg", {"name": HEADLESS, "default": "false"})
    tag = [comment("hardware of every device, sim"), simulator(cell, scene, first_keyframe(cell))]
    attributes = {"name": cell.name, "xmlns:xacro": "http://www.ros.org/wiki/xacro"}
    return for_xacro(element("robot", attributes, [argument, *_body(cell), *tag]))


def first_keyframe(cell: Cell) -> str:
    """Return the name of the keyframe where a simulator begins."""
    return HOME if any(pose.name == HOME for pose in cell.poses) else START


def manager_description(cell: Cell, target: Target, devices: tuple[str, ...]) -> Element:
    """Return the same description with the hardware of some devices alone, for the manager that drives them."""
    return for_xacro(element("robot", {"name": cell.name}, _parts(cell, target, devices)))


def described_frames(cell: Cell) -> frozenset[str]:
    """Return the frames that the description holds: the world, links, mounts, fixed frames and the scene."""
    links = (link.name for device in cell.devices for link in device.body.description.links)
    fixed = (frame.name for frame in _fixed_frames(cell))
    return frozenset((WORLD, *links, *fixed, *(box.name for box in _standing(cell))))


def _fixed_frames(cell: Cell) -> Iterator[Frame]:
    apart = _off_the_tree(cell)
    for frame in cell.frames:
        if frame.kind is FrameKind.FIXED and frame.authority == ROBOT_STATE_PUBLISHER and frame.name not in apart:
            yield frame


def _standing(cell: Cell) -> Iterator[Solid]:
    apart = _off_the_tree(cell)
    return (box for box in cell.scene if box.parent not in apart)


def _parts(cell: Cell, target: Target, devices: tuple[str, ...]) -> Iterator[Element]:
    yield from _body(cell)
    start = start_positions(cell) if target == "mock" else {}
    for device in cell.devices:
        if device.control.hardware is not None and target in device.control.hardware.targets and device.name in devices:
            yield comment(f"hardware of devices.{device.name}, {target}")
            yield ros2_control(device, device.control.hardware, target, start)


def _body(cell: Cell) -> Iterator[Element]:
    yield frame_link(WORLD)
    for device in cell.devices:
        yield comment(f"devices.{device.name}: {device.model}")
        yield from _device(device)
    for frame in _fixed_frames(cell):
        yield comment(f"frames.{frame.name}{_calibration(cell, frame)}")
        yield frame_link(frame.name)
        yield _held(frame.name, frame)
    yield from scene_materials(cell.scene)
    for box in _standing(cell):
        yield comment(f"scene.{box.name}: {box.kind}")
        yield scene_link(box)
        yield _held(box.name, box)


def _device(device: Device) -> Iterator[Element]:
    limits = {joint.name: joint for joint in device.joints}
    palette = palette_of(device)
    yield from palette.definitions()
    yield fixed_joint(
        f"{device.body.root_link}_mount",
        device.mount.parent_frame,
        device.body.root_link,
        device.mount.transform_root_to_parent,
    )
    yield from (device_link(link, palette) for link in device.body.description.links)
    yield from (
        device_joint(joint, limits.get(joint.name)) for joint in device.body.description.with_direct_mimics().joints
    )


def _held(name: str, placed: Frame | Solid) -> Element:
    pose = placed.transform_to_parent
    assert pose is not None, "only a dynamic frame has no pose"
    return fixed_joint(f"{name}_mount", placed.parent, name, pose)


def _calibration(cell: Cell, frame: Frame) -> str:
    calibration = cell.calibrations.get(frame.calibration) if frame.calibration else None
    return f": calibration {frame.calibration}, revision {calibration.revision}" if calibration else ""


def _off_the_tree(cell: Cell) -> frozenset[str]:
    """Return the dynamic frames and all that hangs on them."""
    parents = {frame.name: frame.parent for frame in cell.frames}
    dynamic = {frame.name for frame in cell.frames if frame.kind is FrameKind.DYNAMIC}
    known = dict.fromkeys(dynamic, True)
    for name in parents:
        above, seen = name, list[str]()
        while above in parents and above not in known:
            known[above] = False
            seen.append(above)
            above = parents[above]
        known.update(dict.fromkeys(seen, known.get(above, False)))
    return frozenset(name for name, apart in known.items() if apart)


def start_positions(cell: Cell) -> dict[str, float]:
    """Return a position for each joint that moves on its own, rad or m.

    The pose ``home`` of the cell counts first, then the home of the catalog, then zero. A value outside the limits is
    moved to the nearest limit: a trajectory controller whose joint begins outside them fails in its first update.
    """
    of_cell = {
        joint: position
        for pose in cell.poses
        if pose.name == HOME
        for joint, position in zip(pose.joints, pose.positions, strict=False)
    }
    return {
        joint.name: _within(joint, of_cell.get(joint.name, device.mock.home.get(joint.name, 0.0)))
        for device in cell.devices
        for joint in device.joints
        if joint.mimics is None
    }


def _within(joint: DeviceJoint, position: float) -> float:
    if joint.type == "continuous":
        return position
    lower = -math.inf if joint.lower is None else joint.lower
    upper = math.inf if joint.upper is None else joint.upper
    return min(max(position, lower), upper)
