"""Which robots of a cell can meet, and what is within their reach; the rest need not be looked at together.

A ball holds a shape in its own frame. On the way up to the world a joint that turns sweeps it round its axis, and one
that slides pushes it along: what is left in the world is a ball that the shape never leaves, wherever the joints are.
Robots whose balls meet are in one part of the cell, with the things that their balls touch, and so are those that share
a group, a goal or an area, or of which one carries the other. Distances are in meters, in the frame of the world.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Protocol, TypeVar

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.feasibility.answers import MARGIN_M
from cellc.compiler.feasibility.meshes import mesh_reach
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.neighbors import Neighbors
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3
from cellc.robot.description.model import Box, Cylinder, Geometry, Joint, Sphere

SLACK_M = 0.1
"""A prismatic joint may be so far outside its limits: behind a spring, or past its goal. A part in hand is held so far
from where fingers close."""
_LEAST_PART_M = 0.05
_HERE: Vector3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Ball:
    """Where something is, at the farthest."""

    center: Vector3
    radius: float


@dataclass(frozen=True, slots=True)
class Part:
    """Devices and things of the scene that have to be looked at together, by name, with the areas in their reach."""

    members: frozenset[str]
    movers: frozenset[str]
    areas: frozenset[str]


@dataclass(frozen=True, slots=True)
class Reach:
    """The parts of a cell in the order of its devices.

    Attributes:
        standing: pairs of links at rest within the margin of each other, and are in no common part.
    """

    parts: tuple[Part, ...]
    standing: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Owner:
    """Whose a frame is, a device or a thing of the scene, and the first joint below the world that moves it."""

    name: str
    joint: str


def swept(graph: CellGraph, frame: str, ball: Ball) -> Ball:
    """Return a ball in the world that a ball in a frame never leaves, whatever the joints above it do."""
    joints = graph.once(_joints)
    for above in graph.frames.chain(frame):
        if above.name in joints:
            ball = _moved(ball, joints[above.name], graph.cell)
        if above.transform_to_parent is not None:
            ball = Ball(above.transform_to_parent.apply(ball.center), ball.radius)
    return ball


def _moved(ball: Ball, joint: Joint, cell: Cell) -> Ball:
    """Return the ball of all places of a ball that a joint moves, in the frame of the joint."""
    length = math.hypot(*joint.axis)
    axis = tuple(part / length for part in joint.axis) if length else _HERE
    along = sum(part * way for part, way in zip(axis, ball.center, strict=True))
    if joint.type in ("revolute", "continuous"):
        on_axis = (axis[0] * along, axis[1] * along, axis[2] * along)
        return Ball(on_axis, ball.radius + math.dist(on_axis, ball.center))
    lower, upper = _way(joint, cell) if joint.type == "prismatic" else (-math.inf, math.inf)
    if not math.isfinite(upper - lower):
        return Ball(ball.center, math.inf)
    x, y, z = (way + part * (lower + upper) / 2.0 for part, way in zip(axis, ball.center, strict=True))
    return Ball((x, y, z), ball.radius + abs(upper - lower) / 2.0 + SLACK_M)


def _way(joint: Joint, cell: Cell) -> tuple[float, float]:
    """Return from where to where a joint moves, rad or m; a follower goes where its leader sends it."""
    if joint.mimic is None:
        return _ends(cell, joint.name)
    one, other = (joint.mimic.multiplier * end + joint.mimic.offset for end in _ends(cell, joint.mimic.joint))
    return min(one, other), max(one, other)


def _ends(cell: Cell, name: str) -> tuple[float, float]:
    joint = cell.joints_by_name.get(name)
    if joint is None or joint.type == "continuous" or joint.lower is None or joint.upper is None:
        return -math.inf, math.inf
    return joint.lower, joint.upper


def _joints(graph: CellGraph) -> Mapping[str, Joint]:
    """Return the joints that are not fixed by the frame that they move."""
    return {
        joint.child: joint
        for device in graph.cell.devices
        for joint in device.body.description.with_direct_mimics().joints
        if joint.type != "fixed"
    }


def owners(graph: CellGraph) -> Mapping[str, Owner]:
    """Return whose each frame is, parents first; the world and what hangs on it alone have no owner."""
    joints, known = graph.once(_joints), {"": Owner("", "")}
    for name in graph.frames.names():
        new = []
        for frame in graph.frames.chain(name):
            if frame.name in known:
                break
            new.append(frame)
        for frame in reversed(new):
            above = known.get(frame.parent, known[""])
            own = frame.device or (frame.name if frame.kind is FrameKind.SCENE else above.name)
            known[frame.name] = Owner(own, above.joint or (frame.name if frame.name in joints else ""))
    return known


class Sets:
    """Names that belong together."""

    def __init__(self) -> None:
        self._above: dict[str, str] = {}

    def first(self, name: str) -> str:
        """Return the first of the names that belong together."""
        while (above := self._above.get(name, name)) != name:
            self._above[name] = name = self._above.get(above, above)
        return name

    def join(self, one: str, other: str) -> None:
        """Let two names belong together."""
        self._above[self.first(other)] = self.first(one)


def reach_of(graph: CellGraph) -> Reach:
    """Cut a cell into what has to be looked at together; one part, without names, where that is all of it."""
    movers, sets = _movers(graph)
    whole = Reach((Part(frozenset(), frozenset(), frozenset()),))
    if len({sets.first(name) for name in movers}) < 2:
        return whole
    balls = _balls(graph, movers)
    blocks = list(_blocks(graph, movers))
    _join_near(balls, sets)
    touched = _touched(balls, blocks, sets)
    for area in (block for block in touched if block.is_area):
        for ball in touched[area][1:]:
            sets.join(touched[area][0], ball)
    members: dict[str, set[str]] = {}
    for name in movers:
        members.setdefault(sets.first(name), set()).add(name)
    if len(members) < 2:
        return whole
    around = {first: set[str]() for first in members}
    areas = {first: set[str]() for first in members}
    for block, by in touched.items():
        for first in {sets.first(name) for name in by}:
            (areas if block.is_area else around)[first].add(block.owner)
    parts = [
        Part(frozenset(own | around[first]), frozenset(own), frozenset(areas[first])) for first, own in members.items()
    ]
    return Reach(tuple(parts), tuple(_standing(blocks, parts)))


def swept_balls(graph: CellGraph) -> tuple[tuple[str, Ball], ...]:
    """Return each device that moves with a ball in the world that it never leaves, with what it may hold in hand."""
    return tuple((mover.name, mover.ball) for mover in _balls(graph, _movers(graph)[0]))


def resting_shapes(graph: CellGraph) -> tuple[Block, ...]:
    """Return the shapes at rest, in the world; not the surfaces of all that is behind them."""
    planes = {solid.name for solid in graph.cell.scene if solid.is_plane}
    blocks = _blocks(graph, _movers(graph)[0])
    return tuple(block for block in blocks if not block.is_area and block.link not in planes)


def _movers(graph: CellGraph) -> tuple[list[str], Sets]:
    """Return the devices and things that a joint moves or that hang on one of them, and which belong together."""
    owned, sets = graph.once(owners), Sets()
    at_joint: dict[str, str] = {}
    for owner in owned.values():
        if owner.joint:
            sets.join(at_joint.setdefault(owner.joint, owner.name), owner.name)
    movers = dict.fromkeys(owner.name for owner in owned.values() if owner.joint)
    for name, owner in owned.items():
        frame = graph.frames.get(name)
        carrier = owned[frame.parent].name if frame is not None and frame.parent in owned else ""
        if carrier in movers and owner.name != carrier:
            movers[owner.name] = None
            sets.join(carrier, owner.name)
    for shared in _shared(graph, owned):
        together = [name for name in shared if name in movers]
        for name in together[1:]:
            sets.join(together[0], name)
    return list(movers), sets


def _shared(graph: CellGraph, owned: Mapping[str, Owner]) -> Iterator[Iterable[str]]:
    """Yield what each group, goal and area has to do with."""
    cell, unowned = graph.cell, owned[""]
    of_groups = {
        group.name: [cell.holders[joint] for joint in group.joints if joint in cell.holders] for group in cell.groups
    }
    for group in cell.groups:
        frames = (owned.get(group.base_link, unowned), owned.get(group.tip_frame, unowned))
        yield [*of_groups[group.name], *(owner.name for owner in frames)]
    for goal in cell.goals:
        yield [*of_groups.get(goal.group, ())[:1], owned.get(goal.frame, unowned).name]


class _Round(Protocol):
    """What is somewhere within a ball."""

    @property
    def ball(self) -> Ball:
        """Where it is."""


_Thing = TypeVar("_Thing", bound=_Round)


@dataclass(frozen=True, slots=True)
class _Mover:
    """A ball round all that belongs together."""

    name: str
    ball: Ball


@dataclass(frozen=True, slots=True)
class Block:
    """A shape at rest, or an area: half the edges of a box around it, whose center is at ``pose``."""

    owner: str
    link: str
    pose: Pose
    half: Vector3

    @property
    def is_area(self) -> bool:
        """Whether it is no shape."""
        return not self.link

    @property
    def ball(self) -> Ball:
        """A ball round it."""
        return Ball(self.pose.position, math.hypot(*self.half))

    def is_near(self, ball: Ball, margin_m: float) -> bool:
        """Tell whether a ball can be within a margin of it."""
        place = self.pose.inverse().apply(ball.center)
        beyond = (max(0.0, abs(way) - half) for way, half in zip(place, self.half, strict=True))
        return math.hypot(*beyond) <= ball.radius + margin_m


def _balls(graph: CellGraph, movers: Iterable[str]) -> list[_Mover]:
    """Return a ball for each device that moves, with what it may hold in hand."""
    owned, held_m = graph.once(owners), _held_m(graph.cell)
    found: dict[str, list[Ball]] = {name: [] for name in movers}
    for name, owner in owned.items():
        frame = graph.frames.get(name)
        if owner.name in found and frame is not None and frame.kind is not FrameKind.DYNAMIC:
            found[owner.name].append(swept(graph, name, Ball(_HERE, held_m)))
    for name, owner_name, pose, half in _shapes(graph):
        if owner_name in found:
            ball = Ball(pose.position, math.hypot(*half))
            found[owner_name].append(swept(graph, name, ball))
    for area in graph.cell.areas:
        owner_name = owned[area.parent].name if area.parent in owned else ""
        if owner_name in found:
            ball = Ball(area.transform_to_parent.position, math.hypot(*area.size) / 2.0)
            found[owner_name].append(swept(graph, area.parent, ball))
    return [_Mover(name, _round(balls)) for name, balls in found.items() if balls]


def _round(balls: Sequence[Ball]) -> Ball:
    """Return a ball round balls."""
    center = max(balls, key=lambda ball: ball.radius).center
    return Ball(center, max(math.dist(center, ball.center) + ball.radius for ball in balls))


def _held_m(cell: Cell) -> float:
    """Return how far a part in hand goes from where it is held, m."""
    grasps = (frame.grasp for frame in cell.frames if frame.grasp is not None)
    sizes = (math.hypot(*(grasp.size_m or (grasp.width_m or 0.0,) * 3)) for grasp in grasps)
    return max(_LEAST_PART_M, *sizes, 0.0) + SLACK_M


def _shapes(graph: CellGraph) -> Iterator[tuple[str, str, Pose, Vector3]]:
    """Yield the link, the owner, and a box around each shape in the frame of its link."""
    for part in graph.model.links():
        for shape in part.link.collisions:
            yield part.link.name, part.device.name, shape.pose, _half(graph, shape.geometry)
    for solid in graph.cell.scene:
        yield solid.name, graph.once(owners)[solid.name].name, solid.center, _half(graph, solid.geometry)


def _half(graph: CellGraph, shape: Geometry) -> Vector3:
    """Return half the edges of a box around a shape; endless of a mesh that is not at hand."""
    if isinstance(shape, Box):
        x, y, z = shape.size
        return x / 2.0, y / 2.0, z / 2.0
    if isinstance(shape, Sphere):
        return shape.radius, shape.radius, shape.radius
    if isinstance(shape, Cylinder):
        return shape.radius, shape.radius, shape.length / 2.0
    return mesh_reach(graph, shape) or (math.inf, math.inf, math.inf)


def _blocks(graph: CellGraph, movers: Iterable[str]) -> Iterator[Block]:
    """Yield the shapes at rest, and the areas."""
    moving, owned = frozenset(movers), graph.once(owners)
    for name, owner, pose, half in _shapes(graph):
        place = None if owner in moving else graph.frames.in_world(name)
        if place is not None:
            yield Block(owner, name, place @ pose, half)
    for area in graph.cell.areas:
        place = graph.frames.in_world(area.parent)
        if place is not None and (area.parent not in owned or owned[area.parent].name not in moving):
            x, y, z = area.size
            yield Block(area.name, "", place @ area.transform_to_parent, (x / 2.0, y / 2.0, z / 2.0))


def _near(things: Sequence[_Thing], of: Iterable[_Round], margin_m: float) -> Iterator[list[_Thing]]:
    """Yield the things whose balls are within a margin of that of each of some others."""
    radii = sorted(thing.ball.radius for thing in things if math.isfinite(thing.ball.radius))
    edge_m = max(radii[len(radii) // 2], MARGIN_M) if radii else MARGIN_M
    large = [thing for thing in things if not thing.ball.radius <= 2.0 * edge_m]
    small = [(thing.ball.center, thing) for thing in things if thing.ball.radius <= 2.0 * edge_m]
    cubes = Neighbors(small, 4.0 * edge_m)
    for other in of:
        ball = other.ball
        reached = [thing for _, thing in cubes.within(ball.radius + 2.0 * edge_m + margin_m, ball.center)]
        yield [thing for thing in (*reached, *large) if _meet(thing.ball, ball, margin_m)]


def _meet(one: Ball, other: Ball, margin_m: float) -> bool:
    return math.dist(one.center, other.center) <= one.radius + other.radius + margin_m


def _join_near(movers: Sequence[_Mover], sets: Sets) -> None:
    for mover, others in zip(movers, _near(movers, movers, MARGIN_M), strict=True):
        for other in others:
            sets.join(mover.name, other.name)


def _touched(movers: Sequence[_Mover], blocks: Sequence[Block], sets: Sets) -> dict[Block, list[str]]:
    """Return the movers that can come within the margin of each block."""
    touched: dict[Block, list[str]] = {}
    for mover, near in zip(movers, _near(blocks, movers, MARGIN_M), strict=True):
        for block in near:
            if block.is_near(mover.ball, MARGIN_M):
                touched.setdefault(block, []).append(mover.name)
    return touched


def _standing(blocks: Sequence[Block], parts: Sequence[Part]) -> Iterator[tuple[str, str]]:
    """Yield the pairs of links at rest within the margin of each other, and that no part has both of."""
    inside: dict[str, set[int]] = {}
    for number, part in enumerate(parts):
        for name in part.members:
            inside.setdefault(name, set()).add(number)
    shapes = [block for block in blocks if not block.is_area]
    found: dict[tuple[str, str], None] = {}
    for one, near in zip(shapes, _near(shapes, shapes, MARGIN_M), strict=True):
        for other in near:
            apart = inside.get(one.owner, set()).isdisjoint(inside.get(other.owner, ()))
            both_near = one.is_near(other.ball, MARGIN_M) and other.is_near(one.ball, MARGIN_M)
            if one.link < other.link and apart and both_near:
                found[one.link, other.link] = None
    yield from sorted(found)
