"""What is drawn in 3D: shapes, frames, fields of view, named poses and goals, each held by a rigid group."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from cellc.compiler.cell.device import FieldOfView
from cellc.contract.diagnostics.wording import count
from cellc.contract.transforms import Pose, identity
from cellc.robot.description.model import Box, Collision, Cylinder, Geometry, Link, Mesh, Sphere, Visual
from cellc.tools.view.meshes import DrawnMesh, Meshes, meshes_at_hand, meshes_of
from cellc.tools.view.poses import Values
from cellc.tools.view.skeleton import Held, Skeleton
from cellc.tools.view.standing import Standing

Numbers = tuple[float, ...]
"""A pose as the page has it: position in m, quaternion x, y, z, w."""


@dataclass(frozen=True, slots=True)
class Placed:
    """What is at standstill in a rigid group."""

    group: int
    pose: Numbers


@dataclass(frozen=True, slots=True)
class Shape(Placed):
    """A body: the size of a box in m, the radius of a sphere, radius and length of a cylinder along z, or a mesh.

    The size of a mesh is its number among those of the scene.

    Attributes:
        owner: device, or empty for the scene.
    """

    kind: str
    size: Numbers
    owner: str
    link: str


@dataclass(frozen=True, slots=True)
class FrameMark(Placed):
    """A frame of the cell; ``kind`` is that of the contract."""

    name: str
    parent: str
    kind: str


@dataclass(frozen=True, slots=True)
class ViewCone(Placed):
    """What a camera sees along z of its optical frame: whole angles in rad, distances in m."""

    name: str
    angles: Numbers
    depths: Numbers


@dataclass(frozen=True, slots=True)
class GoalMark(Placed):
    """Where a tip goes, and where it comes from; ``approach`` in the tip's axes, m."""

    name: str
    tip: str
    frame: str
    approach: Numbers


@dataclass(frozen=True, slots=True)
class PoseMark:
    """A posture of the whole cell: seven numbers for each group."""

    name: str
    groups: Numbers


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that is at standstill, and the postures that can be chosen.

    Attributes:
        kinds: which shapes of each device are drawn, in words.
        left_out: links whose shapes are not drawn, and why.
        parts: what grippers take, as wide as the cell states.
    """

    groups: tuple[str, ...]
    devices: tuple[str, ...]
    kinds: tuple[str, ...]
    shapes: tuple[Shape, ...]
    meshes: tuple[DrawnMesh, ...]
    frames: tuple[FrameMark, ...]
    cones: tuple[ViewCone, ...]
    goals: tuple[GoalMark, ...]
    poses: tuple[PoseMark, ...]
    left_out: tuple[tuple[str, str], ...]
    parts: tuple[Shape, ...]


def scene_of(standing: Standing, views: Mapping[str, FieldOfView], skeleton: Skeleton) -> Scene:
    """Return what is drawn of the static parts."""
    links = standing.description.links
    meshes = meshes_at_hand(links, standing.mesh_roots)
    owners = _owners(standing)
    bodies = [(link, *_bodies(link, meshes)) for link in links]
    kinds: dict[str, dict[str, None]] = {name: {} for name in standing.roots}
    for link, kind, shapes in bodies:
        if shapes and owners[link.name]:
            kinds[owners[link.name]][kind] = None
    return Scene(
        groups=skeleton.groups,
        devices=tuple(standing.roots),
        kinds=tuple(" and ".join(names) for names in kinds.values()),
        shapes=tuple(
            _shape(skeleton, owners[link.name], link.name, pose, *_measured(geometry, meshes))
            for link, _, shapes in bodies
            for pose, geometry in shapes
        ),
        meshes=meshes.drawn,
        frames=tuple(_frames(standing, skeleton)),
        cones=tuple(
            _cone(name, skeleton.frames[name], view) for name, view in views.items() if name in skeleton.frames
        ),
        goals=tuple(_goals(standing, skeleton)),
        poses=tuple(_poses(standing, skeleton)),
        left_out=tuple(_left_out(links, owners, meshes)),
        parts=tuple(_parts(standing, skeleton)),
    )


def numbers(pose: Pose) -> Numbers:
    """Return a pose in tenths of a millimeter and about a hundredth of a degree: the page shows no more."""
    return tuple(round(value, 4) + 0.0 for value in (*pose.position, *pose.quaternion))


def rounded(poses: Values) -> list[Numbers]:
    """Return many poses, shape (7, times), in the same digits; one where they are all the same."""
    still = (poses == poses[:, :1]).all()
    columns = ([round(value, 4) + 0.0 for value in values] for values in (poses[:, :1] if still else poses).tolist())
    return list(zip(*columns, strict=True))


def _bodies(link: Link, meshes: Meshes) -> tuple[str, list[tuple[Pose, Geometry]]]:
    """Return what is seen of a link, what collides where that is not at hand, and which of them it is."""

    def at_hand(shapes: Sequence[Visual | Collision]) -> list[tuple[Pose, Geometry]]:
        return [(shape.pose, shape.geometry) for shape in shapes if _drawable(shape.geometry, meshes)]

    seen = at_hand(link.visuals)
    if seen and len(seen) == len(link.visuals):
        return "visual meshes" if meshes_of(link.visuals) else "visual shapes", seen
    touched = at_hand(link.collisions)
    meshed = any(isinstance(geometry, Mesh) for _, geometry in touched)
    return "collision meshes" if meshed else "collision shapes", touched


def _drawable(geometry: Geometry, meshes: Meshes) -> bool:
    return not isinstance(geometry, Mesh) or geometry in meshes.numbers


def _left_out(links: Iterable[Link], owners: Mapping[str, str], meshes: Meshes) -> Iterator[tuple[str, str]]:
    """Yield of each device, or of the cell itself, the links that have a shape and none that is drawn, and why."""
    bare: dict[str, list[Link]] = {}
    for link in links:
        if (link.visuals or link.collisions) and not _bodies(link, meshes)[1]:
            bare.setdefault(owners[link.name], []).append(link)
    for owner, bare_links in bare.items():
        named = [mesh for link in bare_links for mesh in (*meshes_of(link.visuals), *link.collision_meshes())]
        why = next((meshes.absent[mesh] for mesh in named if mesh in meshes.absent), "")
        yield f"shapes of {count(len(bare_links), 'link')} of {owner or 'the cell'}", why


def _owners(standing: Standing) -> dict[str, str]:
    """Return the device of each link: that of the nearest mount above it; a mounted device has its own links."""
    roots = {link: name for name, link in standing.roots.items()}
    above = {joint.child: joint.parent for joint in standing.description.joints}
    beside = {name for name, frame in standing.frames.items() if frame.kind not in ("link", "mount")}
    owners: dict[str, str] = {}
    for link in standing.description.links:
        name = link.name
        while name in above and name not in roots and name not in beside:
            name = above[name]
        owners[link.name] = roots.get(name, "")
    return owners


def _shape(skeleton: Skeleton, owner: str, link: str, pose: Pose, kind: str, size: Numbers) -> Shape:
    held = skeleton.held(link)
    return Shape(held.group, numbers(held.pose @ pose), kind, tuple(round(value, 5) for value in size), owner, link)


def _measured(shape: Geometry, meshes: Meshes) -> tuple[str, Numbers]:
    if isinstance(shape, Box):
        return "box", shape.size
    if isinstance(shape, Cylinder):
        return "cylinder", (shape.radius, shape.length)
    return ("sphere", (shape.radius,)) if isinstance(shape, Sphere) else ("mesh", (meshes.numbers[shape],))


def _parts(standing: Standing, skeleton: Skeleton) -> Iterator[Shape]:
    """Yield a cylinder for each part: its width is all that is known, and fingers meet it there at any turn.

    It is where a tip grips it, along the tip, or at its frame where no goal does.
    """
    for name, held in skeleton.parts.items():
        grasp = standing.frames[name].grasp
        width_m = None if grasp is None else grasp.width_m
        if width_m is not None:
            gripped = (goal.pose.pose for goal in standing.goals.values() if goal.frame == name)
            pose = held.pose @ next(gripped, identity())
            size = (round(width_m / 2.0, 5), round(width_m, 5))
            yield Shape(held.group, numbers(pose), "cylinder", size, "", f"part {name}")


def _frames(standing: Standing, skeleton: Skeleton) -> Iterator[FrameMark]:
    for name, held in skeleton.frames.items():
        frame = standing.frames[name]
        yield FrameMark(held.group, numbers(held.pose), name, frame.parent, frame.kind)


def _cone(name: str, held: Held, view: FieldOfView) -> ViewCone:
    angles = (round(view.horizontal, 4), round(view.vertical, 4))
    return ViewCone(held.group, numbers(held.pose), name, angles, (view.nearest_m, view.farthest_m))


def _goals(standing: Standing, skeleton: Skeleton) -> Iterator[GoalMark]:
    for name, goal in standing.goals.items():
        held = skeleton.frames.get(goal.frame)
        if held is not None:
            pose, tip = held.pose @ goal.pose.pose, standing.groups[goal.group].tip_frame
            yield GoalMark(held.group, numbers(pose), name, tip, goal.frame, goal.approach or ())


def _poses(standing: Standing, skeleton: Skeleton) -> Iterator[PoseMark]:
    """Yield the named poses, and where the mock begins."""
    for name, targets in standing.poses.items():
        positions = {
            joint: position
            for target in targets
            for joint, position in zip(standing.groups[target.group].joints, target.positions, strict=True)
        }
        yield PoseMark(name, _flat(skeleton.posture(positions)))
    yield PoseMark("start of the mock" if standing.poses else "as it starts", _flat(skeleton.posture({})))


def _flat(poses: tuple[Pose, ...]) -> Numbers:
    return tuple(value for pose in poses for value in numbers(pose))
