"""The cell as bodies that joints move: what is fixed lies in the body that carries it, so that no tree is deep.

Bodies begin at movable joints, at the roots of devices, and at the frames where tools hang: a force sensor measures
between two bodies. Any other link with a mass or a shape is a body of its own in the one that carries it, and a frame
alone is a site.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device, DeviceJoint
from cellc.compiler.cell.frame import WORLD, FrameKind, Grasp, Solid
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.graph.frame_tree import FrameTree
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity
from cellc.robot.description.model import Box, Joint, Link

_LEANS = 1e-6
_NEAR_M = 0.25
"""m: what is farther below a part does not carry it."""
_DEEPEST = 100
"""Bodies within each other: parsers of XML, and writers of it, end at some depth."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What a gripper takes: a free body, named like the frame that follows it, or after the one that it lies at.

    Args:
        above_m: how high its frame is above the box of the scene that it rests on; None where none is below it.
    """

    name: str
    grasp: Grasp
    pose: Pose
    above_m: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """A link, frame or solid thing in the body that carries it."""

    name: str
    pose: Pose
    device: Device | None = None
    link: Link | None = None
    solid: Solid | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """What moves as one, against the body that carries it.

    Args:
        placed: links, frames and solid things that are fixed in it, itself first.
        joint, limits: what moves it; None of what is only mounted.
        part: what it is where nothing holds it.
    """

    name: str
    pose: Pose
    placed: tuple[Placed, ...]
    bodies: tuple[Body, ...]
    device: Device | None = None
    joint: Joint | None = None
    limits: DeviceJoint | None = None
    part: Part | None = None

    def all(self) -> Iterator[Body]:
        """Yield the body and all that it carries, in the order of the file."""
        yield self
        for body in self.bodies:
            yield from body.all()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Edge:
    """A frame in its parent; ``begins`` where a body begins."""

    placed: Placed
    parent: str
    begins: bool = False
    joint: Joint | None = None
    part: Part | None = None


def body_tree(cell: Cell, frames: FrameTree) -> Body | None:
    """Return the world with all that it carries; None where bodies carry bodies deeper than parsers read."""
    above: dict[str, str] = {}
    depth = {WORLD: 0}
    started: dict[str, _Edge] = {}
    fixed: dict[str, list[Placed]] = {WORLD: []}
    inner: dict[str, list[str]] = {WORLD: []}
    for edge, body, pose in _walk(cell, frames):
        placed = edge.placed
        if not edge.begins:
            fixed[body].append(_at(placed, pose))
            continue
        started[placed.name], above[placed.name], depth[placed.name] = edge, body, depth[body] + 1
        fixed[placed.name], inner[placed.name] = [_at(placed, identity())], []
        inner[body].append(placed.name)
        started[placed.name] = _Edge(
            placed=_at(placed, pose), parent=body, begins=True, joint=edge.joint, part=edge.part
        )
    if max(depth.values()) > _DEEPEST:
        return None
    return _assembled(started, fixed, inner)


def _assembled(started: dict[str, _Edge], fixed: Mapping[str, list[Placed]], inner: Mapping[str, list[str]]) -> Body:
    """Build bodies from the innermost on; each was started after the one that carries it."""
    done: dict[str, Body] = {}
    for name in reversed(started):
        edge = started[name]
        device, joint = edge.placed.device, edge.joint
        limits = next((each for each in device.joints if joint and each.name == joint.name), None) if device else None
        done[name] = Body(
            name=name,
            pose=edge.placed.pose,
            placed=tuple(fixed[name]),
            bodies=tuple(done[each] for each in inner[name]),
            device=device,
            joint=joint,
            limits=limits,
            part=edge.part,
        )
    return Body(name=WORLD, pose=identity(), placed=tuple(fixed[WORLD]), bodies=tuple(done[n] for n in inner[WORLD]))


def _at(placed: Placed, pose: Pose) -> Placed:
    return Placed(name=placed.name, pose=pose, device=placed.device, link=placed.link, solid=placed.solid)


def _walk(cell: Cell, frames: FrameTree) -> Iterator[tuple[_Edge, str, Pose]]:
    """Yield each edge from the world up, with the body that carries it and its pose there."""
    children: dict[str, list[_Edge]] = {}
    for edge in (*_device_edges(cell), *_frame_edges(cell, frames)):
        children.setdefault(edge.parent, []).append(edge)
    waiting = deque([(WORLD, WORLD, identity())])
    while waiting:
        parent, body, pose = waiting.popleft()
        for edge in children.get(parent, ()):
            there = pose @ edge.placed.pose
            yield edge, body, there
            name = edge.placed.name
            waiting.append((name, name, identity()) if edge.begins else (name, body, there))


def _device_edges(cell: Cell) -> Iterator[_Edge]:
    for device in cell.devices:
        links = {link.name: link for link in device.body.description.links}
        carriers = {device.body.tool_frame, sensed_link(cell, device)}
        root, mount = device.body.root_link, device.mount
        placed = Placed(name=root, pose=mount.transform_root_to_parent, device=device, link=links.get(root))
        yield _Edge(placed=placed, parent=mount.parent_frame, begins=True)
        for joint in device.body.description.with_direct_mimics().joints:
            child = Placed(name=joint.child, pose=joint.pose, device=device, link=links.get(joint.child))
            moving = joint if joint.movable else None
            begins = joint.movable or joint.child in carriers
            yield _Edge(placed=child, parent=joint.parent, begins=begins, joint=moving)


def sensed_link(cell: Cell, device: Device) -> str:
    """Return the link at which a device feels what it carries: where tools hang, else its root."""
    links = {link.name for link in device.body.description.links}
    hung = (cell.device(name).mount.parent_frame for name in device.mount.carries)
    known = (link for link in (device.body.tool_frame, *hung) if link in links)
    return next((link for link in known if link is not None), device.body.root_link)


def _frame_edges(cell: Cell, frames: FrameTree) -> Iterator[_Edge]:
    free = parts(cell, frames)
    for frame in cell.frames:
        if frame.kind is FrameKind.FIXED and frame.transform_to_parent is not None:
            yield _Edge(placed=Placed(name=frame.name, pose=frame.transform_to_parent), parent=frame.parent)
        if frame.name in free:
            part = free[frame.name]
            yield _Edge(placed=Placed(name=part.name, pose=part.pose), parent=WORLD, begins=True, part=part)
        elif frame.kind is FrameKind.DYNAMIC and frame.simulated_pose is not None:
            placed = Placed(name=frame.name, pose=frame.simulated_pose.pose)
            yield _Edge(placed=placed, parent=frame.simulated_pose.parent)
    for solid in cell.scene:
        placed = Placed(name=solid.name, pose=solid.transform_to_parent, solid=solid)
        yield _Edge(placed=placed, parent=solid.parent)


def parts(cell: Cell, frames: FrameTree) -> dict[str, Part]:
    """Return the parts of a cell by the frame that states each; nothing where no pose in the world is stated."""
    taken, found = {frame.name for frame in cell.frames}, dict[str, Part]()
    for frame in cell.frames:
        pose = frames.in_world(frame.name)
        if frame.grasp is not None and pose is not None:
            is_dynamic = frame.kind is FrameKind.DYNAMIC
            name = frame.name if is_dynamic else _free_name(f"{frame.name}_part", taken)
            found[frame.name] = Part(name=name, grasp=frame.grasp, pose=pose, above_m=_above_m(cell, frames, pose))
    return found


def _above_m(cell: Cell, frames: FrameTree, pose: Pose) -> float | None:
    """Return how high an upright frame is above the nearest top of an upright box below it."""
    here = [depth for solid in cell.scene if (depth := _height_m(solid, frames, pose)) is not None]
    return min(here, default=None)


def _height_m(solid: Solid, frames: FrameTree, pose: Pose) -> float | None:
    parent = frames.in_world(solid.parent)
    if parent is None or not isinstance(solid.geometry, Box):
        return None
    box = parent @ solid.transform_to_parent @ solid.center
    (x, y, z), (length, width, height) = box.inverse().apply(pose.position), solid.geometry.size
    above_m = rounded(z - height / 2.0)
    below = abs(x) <= length / 2.0 and abs(y) <= width / 2.0 and 0.0 < above_m <= _NEAR_M
    return above_m if below and _is_upright(box) and _is_upright(pose) else None


def _is_upright(pose: Pose) -> bool:
    return pose.apply((0.0, 0.0, 1.0))[2] - pose.position[2] > 1.0 - _LEANS


def _free_name(name: str, taken: set[str]) -> str:
    while name in taken:
        name += "_"
    taken.add(name)
    return name


def weight_kg(body: Body) -> float:
    """Return what is fixed in a body, without what moves against it."""
    links = (placed.link for placed in body.placed)
    own = sum(link.inertial.mass for link in links if link is not None and link.inertial is not None)
    return own + sum(weight_kg(other) for other in body.bodies if other.joint is None and other.part is None)
