"""What is drawn in 3D: shapes, frames, fields of view, named poses and goals, each held by a rigid group."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from cellc.cell.device import FieldOfView
from cellc.description.model import Box, Collision, Cylinder, Geometry, Link, Mesh, Sphere, Visual
from cellc.transforms import Pose
from cellc.view.skeleton import Held, Skeleton, pose_of
from cellc.view.standing import Standing

Numbers = tuple[float, ...]
"""A pose as the page has it: position in m, quaternion x, y, z, w."""


@dataclass(frozen=True, slots=True)
class Shape:
    """A body: the size of a box in m, the radius of a sphere, or radius and length of a cylinder along z.

    Attributes:
        owner: device, or empty for the scene.
    """

    group: int
    pose: Numbers
    kind: str
    size: Numbers
    owner: str
    link: str


@dataclass(frozen=True, slots=True)
class FrameMark:
    """A frame of the cell; ``kind`` is that of the contract."""

    group: int
    pose: Numbers
    name: str
    parent: str
    kind: str


@dataclass(frozen=True, slots=True)
class ViewCone:
    """What a camera sees along z of its optical frame: whole angles in rad, distances in m."""

    group: int
    pose: Numbers
    name: str
    angles: Numbers
    depths: Numbers


@dataclass(frozen=True, slots=True)
class GoalMark:
    """Where a tip goes, and where it comes from; ``approach`` in the tip's axes, m."""

    group: int
    pose: Numbers
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
    """Everything that stands still, and the postures that can be chosen.

    Attributes:
        left_out: shapes that are meshes, which are not drawn.
    """

    groups: tuple[str, ...]
    devices: tuple[str, ...]
    shapes: tuple[Shape, ...]
    frames: tuple[FrameMark, ...]
    cones: tuple[ViewCone, ...]
    goals: tuple[GoalMark, ...]
    poses: tuple[PoseMark, ...]
    left_out: int


def scene_of(standing: Standing, views: Mapping[str, FieldOfView], skeleton: Skeleton) -> Scene:
    """Return what is drawn of what stands."""
    found = [(link, *one) for link in standing.description.links for one in _bodies(link)]
    owners = _owners(standing)
    drawn = tuple(_shape(skeleton, owners, *one) for one in found)
    return Scene(
        groups=skeleton.groups,
        devices=tuple(standing.roots),
        shapes=tuple(one for one in drawn if one is not None),
        frames=tuple(_frames(standing, skeleton)),
        cones=tuple(
            _cone(name, skeleton.frames[name], view) for name, view in views.items() if name in skeleton.frames
        ),
        goals=tuple(_goals(standing, skeleton)),
        poses=tuple(_poses(standing, skeleton)),
        left_out=sum(one is None for one in drawn),
    )


def numbers(pose: Pose) -> Numbers:
    """Return a pose in tenths of a millimetre and about a hundredth of a degree: the page shows no more."""
    return (*(round(value, 4) + 0.0 for value in pose.position), *(round(value, 4) + 0.0 for value in pose.quaternion))


def _bodies(link: Link) -> Iterator[tuple[Pose, Geometry]]:
    """Yield what is seen of a link; what collides, where that is drawn more easily."""
    plain = bool(link.visuals) and not any(isinstance(shape.geometry, Mesh) for shape in link.visuals)
    shapes: tuple[Visual, ...] | tuple[Collision, ...] = link.visuals if plain else link.collisions
    return ((shape.pose, shape.geometry) for shape in shapes)


def _owners(standing: Standing) -> dict[str, str]:
    """Return the device of each link: that of the nearest mount above it; what is mounted on one is none of it."""
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


def _shape(skeleton: Skeleton, owners: Mapping[str, str], link: Link, pose: Pose, shape: Geometry) -> Shape | None:
    measured = _measured(shape)
    if measured is None:
        return None
    kind, size = measured
    held = skeleton.held(link.name)
    owner = owners[link.name]
    return Shape(held.group, numbers(held.pose @ pose), kind, tuple(round(one, 5) for one in size), owner, link.name)


def _measured(shape: Geometry) -> tuple[str, Numbers] | None:
    if isinstance(shape, Box):
        return "box", shape.size
    if isinstance(shape, Cylinder):
        return "cylinder", (shape.radius, shape.length)
    return ("sphere", (shape.radius,)) if isinstance(shape, Sphere) else None


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
            pose, tip = held.pose @ pose_of(goal.pose), standing.groups[goal.group].tip_frame
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
