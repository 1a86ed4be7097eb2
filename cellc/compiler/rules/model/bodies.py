"""Rules on what a description of one's own says of bodies and joints: figures that no machine has, at their own line.

Descriptions of the catalog are held against those of their vendors, and are not judged again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from cellc.compiler.feasibility import mesh_reach
from cellc.compiler.graph.frame_tree import ModelJoint, ModelLink
from cellc.compiler.rules.bounds import Bound, Figure, outside
from cellc.compiler.rules.described import is_own
from cellc.compiler.rules.excuses import spared
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, Severity, rule
from cellc.compiler.rules.shapes import beside, box_corners, dot, edges
from cellc.contract.diagnostics import Span
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.robot.description.model import (
    Box,
    Collision,
    Cylinder,
    Description,
    Geometry,
    Joint,
    Link,
    Mesh,
    Sphere,
    Visual,
)


def _links(graph: CellGraph) -> tuple[ModelLink, ...]:
    return graph.once(_own_parts)[0]


def _joints(graph: CellGraph) -> tuple[ModelJoint, ...]:
    return graph.once(_own_parts)[1]


def _own_parts(graph: CellGraph) -> tuple[tuple[ModelLink, ...], tuple[ModelJoint, ...]]:
    own = {device.name for device in graph.cell.devices if is_own(graph, device)}
    if not own:
        return (), ()
    links = tuple(part for part in graph.model.links() if part.device.name in own)
    return links, tuple(part for part in graph.model.joints() if part.device.name in own)


@rule(Severity.WARNING)
def continuous_with_limits(graph: CellGraph) -> Findings:
    """Yield continuous joints for which ends are stated: nothing holds them."""
    for part in _joints(graph):
        lower, upper = part.joint.unheld or (0.0, 0.0)
        if -math.tau <= lower < upper <= math.tau:
            message = (
                f"joint `{part.joint.name}` is continuous, so its limits of {lower:g} and {upper:g} rad are not held"
            )
            yield Finding(message, _limit(part), part.path)


@rule(Severity.WARNING)
def limits_of_nothing(graph: CellGraph) -> Findings:
    """Yield joints whose range is from zero to zero or whose effort is zero, as exporters leave them."""
    for part in _joints(graph):
        limit = part.joint.limit
        assumed = any(joint.assumed for joint in part.device.joints if joint.name == part.joint.name)
        if limit is None or part.joint.mimic is not None or not part.joint.movable or assumed:
            continue
        if part.joint.type != "continuous" and limit.lower == limit.upper == 0.0:
            message = f"joint `{part.joint.name}` must have a range, got 0 for both of its limits"
            yield Finding(message, _limit(part), part.path)
        elif limit.effort == 0.0 and limit.velocity != 0.0:
            message = f"joint `{part.joint.name}` must have an effort above zero, got 0"
            yield Finding(message, _limit(part), part.path)


_LIGHT_KG, _SMALL_M3, _WEIGHED_KG, _CRUMB_M = 1e-3, 1e-6, 0.05, 5e-5
_CONCENTRATED = 0.08
"""Share of its length that the radius of gyration of a body is at least: a uniform rod has 0.29, a dumbbell 0.5."""
_JOINTS = 4
"""An arm has as many."""


@rule(Severity.WARNING, assumes=("joint-of-unknown-link", "link-with-two-parents"))
def moving_link_without_shape(graph: CellGraph) -> Findings:
    """Yield links that a joint moves, and that have a mass or something to look at, but nothing that can collide.

    Where no link of a device has a shape, that is one finding, of an arm.
    """
    shapeless = set[str]()
    for part in _joints(graph):
        if not part.joint.movable or part.device.name in shapeless:
            continue
        if not any(link.collisions for link in part.device.body.description.links):
            shapeless.add(part.device.name)
            if len([joint for joint in part.device.body.description.joints if joint.movable]) < _JOINTS:
                continue
        body = _rigid(graph.once(_trees)[part.device.name], part.joint.child)
        seen = body and any(
            link.visuals or (link.inertial is not None and link.inertial.mass > _LIGHT_KG) for link in body
        )
        if seen and not any(link.collisions for link in body):
            message = f"link `{part.joint.child}` moves with `{part.joint.name}`, but has no shape that can collide"
            yield Finding(message, body[0].span or part.span, part.path)


def _rigid(tree: _Tree, name: str) -> list[Link]:
    """Return a link, and all that is fixed to it and nearer to the tip."""
    body, names, seen = list[Link](), [name], {name}
    while names:
        name = names.pop()
        body += [tree.links[name]] if name in tree.links else []
        fixed = [joint.child for joint in tree.below.get(name, ()) if not joint.movable and joint.child not in seen]
        names += fixed
        seen.update(fixed)
    return body


@dataclass(frozen=True, slots=True)
class _Tree:
    """A description by name: its links, the joints on each of them, and how far each reaches to its tips at most, m."""

    links: Mapping[str, Link]
    below: Mapping[str, list[Joint]]
    reach: Mapping[str, float]


def _trees(graph: CellGraph) -> Mapping[str, _Tree]:
    """Return the own descriptions by device."""
    return {device.name: _tree(device.body.description) for device in graph.cell.devices if is_own(graph, device)}


def _tree(description: Description) -> _Tree:
    below: dict[str, list[Joint]] = {}
    above: dict[str, Joint] = {}
    for joint in description.joints:
        below.setdefault(joint.parent, []).append(joint)
        above[joint.child] = joint
    links = {link.name: link for link in description.links}
    reach = dict.fromkeys(links, 0.0)
    left = {name: len(below.get(name, ())) for name in links}
    tips = [name for name, count in left.items() if not count]
    while tips:  # from the tips to the root: what is in a cycle is never reached
        name = tips.pop()
        carrier = above.get(name)
        if carrier is not None and carrier.parent in left:
            travel = math.hypot(*carrier.pose.position) + reach[name]
            reach[carrier.parent] = max(reach[carrier.parent], travel)
            left[carrier.parent] -= 1
            tips += [carrier.parent] if not left[carrier.parent] else []
    return _Tree(links, below, reach)


_FASTEST = {"revolute": (50.0, "rad/s"), "continuous": (1000.0, "rad/s"), "prismatic": (15.0, "m/s")}
"""What drives reach; a spindle has no ends."""


def _velocities(graph: CellGraph) -> Iterator[Figure]:
    for part in _joints(graph):
        velocity = None if part.joint.limit is None else part.joint.limit.velocity
        if velocity and part.joint.movable and part.joint.mimic is None:
            most, unit = _FASTEST[part.joint.type]
            yield Figure(part.path, velocity, 1e-5, most, f"joint `{part.joint.name}`", unit, span=_limit(part))


def _tips(graph: CellGraph) -> Iterator[Figure]:
    for part in _joints(graph):
        velocity = None if part.joint.limit is None else part.joint.limit.velocity
        if velocity and part.joint.type == "revolute" and part.joint.mimic is None:
            far = graph.once(_trees)[part.device.name].reach.get(part.joint.child, 0.0)
            why = f"joint `{part.joint.name}` with {velocity:g} rad/s: what arms reach"
            yield Figure(part.path, velocity * far, most=25.0, because=why, span=_limit(part))


def _efforts(graph: CellGraph) -> Iterator[Figure]:
    for part in _joints(graph):
        effort = None if part.joint.limit is None else part.joint.limit.effort
        if effort and part.joint.movable and part.joint.mimic is None:
            unit = "N" if part.joint.slides else "N m"
            yield Figure(part.path, effort, 1e-4, 1e5, f"joint `{part.joint.name}`", unit, span=_limit(part))


def _ranges(graph: CellGraph) -> Iterator[Figure]:
    for part in _joints(graph):
        limit = part.joint.limit
        if limit is None or limit.lower is None or limit.upper is None or limit.lower >= limit.upper:
            continue
        if part.joint.type in ("revolute", "prismatic") and part.joint.mimic is None:
            unit, most = ("m", 100.0) if part.joint.slides else ("rad", math.inf)
            way, why = limit.upper - limit.lower, f"joint `{part.joint.name}`"
            yield Figure(part.path, way, 1e-4, most, why, unit, span=_limit(part))


def _offsets(graph: CellGraph) -> Iterator[Figure]:
    for part in _joints(graph):
        away, why = math.hypot(*part.joint.pose.position), f"joint `{part.joint.name}`, in m"
        yield Figure(part.path, away, most=15.0, because=why, span=part.span)


def _masses(graph: CellGraph) -> Iterator[Figure]:
    for part in _links(graph):
        if part.link.inertial is not None and part.link.inertial.mass > 0.0:
            limit = part.device.limits.payload_limit_kg
            most, why = (
                (5000.0, "in kg") if not limit else (min(5000.0, 150.0 * limit), "150 times the payload of the arm")
            )
            mass = part.link.inertial.mass
            yield Figure(part.path, mass, most=most, because=f"link `{part.link.name}`, {why}", span=_weighed(part))


def _densities(graph: CellGraph) -> Iterator[Figure]:
    """Yield the mass of each link by the volume of its simple shapes; a mesh tells no volume."""
    for part in _links(graph):
        sizes = [edges(shape.geometry) for shape in _simple(part.link)]
        volume = sum(map(math.prod, sizes)) if all(min(size) >= _CRUMB_M for size in sizes) else 0.0
        mass = 0.0 if part.link.inertial is None else part.link.inertial.mass
        if volume > 0.0 and mass > (_LIGHT_KG if volume > _SMALL_M3 else _WEIGHED_KG):
            why = f"link `{part.link.name}`, by the boxes around its shapes"
            yield Figure(part.path, mass / volume, 2.0, 2e4, why, span=_weighed(part))


def _gyrations(graph: CellGraph) -> Iterator[Figure]:
    """Yield the radius of gyration of each link, which its shapes and what is joined to it bound on both sides."""
    for part in _links(graph):
        inertial = part.link.inertial
        if inertial is None or inertial.mass <= 0.0 or spared(graph, part.device, "", "impossible-inertia"):
            continue
        largest = max(inertial.ixx, inertial.iyy, inertial.izz)
        if largest == 0.0 and inertial.mass > _WEIGHED_KG:
            why = f"link `{part.link.name}`, of {inertial.mass:g} kg, for a simulation to hold it"
            yield Figure(part.path, 0.0, 1e-3, because=why, span=_weighed(part))
        elif largest > 0.0:
            longest = max((edge for shape in _simple(part.link) for edge in edges(shape.geometry)), default=0.0)
            least = _CONCENTRATED * longest if inertial.mass > _LIGHT_KG else 0.0
            why = f"link `{part.link.name}`, within its body"
            why += f", which is {longest * 1e3:.0f} mm long" if least else ""
            most, radius = _size(graph.once(_trees)[part.device.name], part.link), math.sqrt(largest / inertial.mass)
            yield Figure(part.path, radius, least or -math.inf, most, why, span=_weighed(part))


def _centers(graph: CellGraph) -> Iterator[Figure]:
    for part in _links(graph):
        if part.link.inertial is not None:
            away = math.hypot(*part.link.inertial.pose.position)
            most = 2.0 * _size(graph.once(_trees)[part.device.name], part.link)
            yield Figure(part.path, away, most=most, because=f"link `{part.link.name}`", span=_weighed(part))


def _beside(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far centers of mass are outside of the box around the shapes of their links."""
    for part in _links(graph):
        corners = [corner for shape in _simple(part.link) for corner in box_corners(shape)]
        inertial = part.link.inertial
        if inertial is not None and inertial.mass > _WEIGHED_KG and corners:
            off = beside(inertial.pose.position, corners)
            longest = max(edge for shape in _simple(part.link) for edge in edges(shape.geometry))
            most = max(0.03, 0.5 * longest)
            yield Figure(part.path, off, most=most, because=f"link `{part.link.name}`", span=_weighed(part))


_OVERHANG = 0.15


def _overhangs(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far the carriage of an axis goes beyond the shapes of what it slides on."""
    for part in _joints(graph):
        limit, rail = part.joint.limit, part.device.body.description.link(part.joint.parent)
        if part.device.kind != "axis" or not part.joint.slides or limit is None or rail is None:
            continue
        turn = Pose((0.0, 0.0, 0.0), part.joint.pose.quaternion)
        along = turn.apply(part.joint.axis)
        ends = [dot(corner, along) for shape in _simple(rail) for corner in box_corners(shape)]
        if limit.lower is not None and limit.upper is not None and ends:
            zero, slack = dot(part.joint.pose.position, along), 0.05 + _OVERHANG * (max(ends) - min(ends))
            beyond = max(min(ends) - zero - limit.lower, zero + limit.upper - max(ends))
            why = f"joint `{part.joint.name}`, whose rail is {max(ends) - min(ends):.3g} m long that way"
            related = (Related("the joint is here", part.span),)
            yield Figure(part.path, beyond, most=slack, because=why, span=_limit(part), related=related)


def _limit(part: ModelJoint) -> Span:
    """Return where the limits of a joint are written."""
    limit = part.joint.limit
    return part.span if limit is None or limit.span is None else limit.span


def _weighed(part: ModelLink) -> Span:
    """Return where the mass of a link is written."""
    inertial = part.link.inertial
    return part.span if inertial is None or inertial.span is None else inertial.span


def _simple(link: Link) -> tuple[Collision | Visual, ...]:
    """Return the shapes of a link that collide, else those to look at; none where one of them is a mesh."""
    shapes = link.collisions or link.visuals
    return () if any(isinstance(shape.geometry, Mesh) for shape in shapes) else shapes


def _size(tree: _Tree, link: Link) -> float:
    """Return a length in m that a link does not exceed: its known shapes, the joints on it, and 1 m for a mesh."""
    sizes = [math.hypot(*shape.pose.position) + _extent(shape.geometry) for shape in _occupied(link)]
    sizes += (math.hypot(*joint.pose.position) for joint in tree.below.get(link.name, ()))
    return 0.1 + 2.0 * (max(sizes) if _occupied(link) else max(sizes, default=0.0) + 1.0)


def _occupied(link: Link) -> tuple[Collision | Visual, ...]:
    return (*link.collisions, *link.visuals)


def _extent(shape: Geometry) -> float:
    if isinstance(shape, Mesh):
        return 1.0
    return math.hypot(*_measures(shape))


def _measures(shape: Geometry) -> tuple[float, ...]:
    """Return the measures of a shape in m; none of a mesh."""
    if isinstance(shape, Box):
        return shape.size
    if isinstance(shape, Cylinder):
        return 2.0 * shape.radius, shape.length
    return (2.0 * shape.radius,) if isinstance(shape, Sphere) else ()


def _shapes(graph: CellGraph) -> Iterator[Figure]:
    for part in _links(graph):
        for shape in _occupied(part.link):
            for measure in (*_measures(shape.geometry), math.hypot(*shape.pose.position) or 1.0):
                yield Figure(part.path, measure, _CRUMB_M, 30.0, f"link `{part.link.name}`, in m", span=part.span)


def _mesh_extents(graph: CellGraph) -> Iterator[Figure]:
    for part in _links(graph):
        for mesh in part.link.collision_meshes():
            reach = mesh_reach(graph, mesh)
            if reach is not None:
                why = f"link `{part.link.name}`, with its scale"
                yield Figure(part.path, max(reach), _CRUMB_M, 30.0, why, span=mesh.span or part.span)


def _scales(graph: CellGraph) -> Iterator[Figure]:
    for part in _links(graph):
        for shape in _occupied(part.link):
            for factor in shape.geometry.scale if isinstance(shape.geometry, Mesh) else ():
                yield Figure(part.path, abs(factor), 1e-6, 1e4, f"link `{part.link.name}`", span=part.span)


BODIES = (
    Bound(("joint/limit/velocity",), "the velocity", "rad/s", "", _velocities),
    Bound(("joint/limit/velocity",), "the speed of the farthest link", "m/s", "", _tips),
    Bound(("joint/limit/effort",), "the effort", "N m", "", _efforts),
    Bound(("joint/limit",), "the range", "rad", "", _ranges),
    Bound(("joint/origin",), "the way from its parent", "m", "", _offsets),
    Bound(("link/inertial/mass",), "the mass", "kg", "", _masses),
    Bound(("link/inertial/mass",), "the density", "kg/m^3", "", _densities),
    Bound(("link/inertial/inertia",), "the radius of gyration", "mm", "", _gyrations),
    Bound(("link/inertial/origin",), "the distance of the center of mass", "mm", "", _centers),
    Bound(("link/inertial/origin",), "the center of mass beside the shapes", "mm", "", _beside),
    Bound(("joint/axis",), "the way of the carriage beyond its rail", "m", "", _overhangs),
    Bound(("link/collision", "link/visual"), "a measure of the shape", "m", "", _shapes),
    Bound(("link/collision/mesh",), "the reach of the mesh", "m", "", _mesh_extents),
    Bound(("link/collision/mesh",), "the scale of the mesh", "", "", _scales),
)


@rule(
    Severity.WARNING,
    assumes=(
        "duplicate-model-name",
        "joint-of-unknown-link",
        "link-with-two-parents",
        "impossible-inertia",
        "malformed-mesh",
        "negative-mass",
    ),
    gives_way=True,
)
def implausible_description(graph: CellGraph) -> Findings:
    """Yield figures of own descriptions that are outside of what machines have."""
    yield from outside(graph, BODIES)
