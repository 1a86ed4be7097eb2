"""Bounds of lengths: edges, residuals, tolerances and maps that no cell means."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.feasibility import mesh_reach
from cellc.compiler.graph.commissioning import chain_of
from cellc.compiler.rules.bounds import Bound, Figure, outside, stated
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, rule
from cellc.contract.fault_declaration import Amount
from cellc.robot.description.model import Cylinder, Mesh, Sphere

_Owners = Iterator[tuple[YamlPath, object]]
_THIN_M, _SMALL_M, _ROOM_M, _HALL_M = 2e-4, 5e-3, 20.0, 50.0
"""A foil, a thing that planning need not know, a room and a hall."""
_MAP: YamlPath = ("motion", "octomap")


def _boxes(graph: CellGraph) -> Iterator[Figure]:
    """Yield the shortest and the longest edge of each box of the scene."""
    for solid in graph.cell.scene:
        if solid.shape is None and not solid.is_plane and solid.touched is None:
            yield Figure((*solid.path, "box"), min(solid.size), _THIN_M, _HALL_M)
            yield Figure((*solid.path, "box"), max(solid.size), _SMALL_M, _HALL_M)


def _areas(graph: CellGraph) -> Iterator[Figure]:
    for area in graph.cell.areas:
        yield Figure((*area.path, "box"), min(area.size), 0.01, _HALL_M)
        yield Figure((*area.path, "box"), max(area.size), 0.01, _HALL_M)


def _places(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far areas are from the nearest arm that may be in them, and simulated parts from their parent."""
    chains = [(graph.frames.in_world(group.base_link), chain_of(graph, group).length) for group in graph.cell.groups]
    reaches = [(base.position, length) for base, length in chains if base is not None] if graph.cell.areas else []
    for area in graph.cell.areas:
        parent = graph.frames.in_world(area.parent)
        if parent is not None and reaches:
            center, half = (parent @ area.transform_to_parent).position, math.hypot(*area.size) / 2.0
            yield Figure(
                (*area.path, "xyz"), min(math.dist(center, base) - length - half for base, length in reaches), most=0.0
            )
    for frame in graph.cell.frames:
        if frame.simulated_pose is not None:
            away = math.hypot(*frame.simulated_pose.pose.position)
            yield Figure((*frame.path, "simulated_pose", "xyz"), away, most=20.0, because="the size of a cell")


def _round(graph: CellGraph) -> Iterator[Figure]:
    for solid in graph.cell.scene:
        if isinstance(solid.shape, Cylinder):
            yield Figure((*solid.path, "cylinder", "radius"), solid.shape.radius, 1e-3, 10.0)
            yield Figure((*solid.path, "cylinder", "length"), solid.shape.length, _SMALL_M, _HALL_M)
        elif isinstance(solid.shape, Sphere):
            yield Figure((*solid.path, "sphere"), solid.shape.radius, _SMALL_M, 10.0)


def _planes(graph: CellGraph) -> Iterator[Figure]:
    for solid in graph.cell.scene:
        if solid.is_plane:
            key = ("touched", "edge") if solid.touched is not None else ("plane",)
            yield Figure((*solid.path, *key), solid.size[0], 0.05, 100.0)


def _meshes(graph: CellGraph) -> Iterator[Figure]:
    for solid in graph.cell.scene:
        if isinstance(solid.shape, Mesh):
            yield Figure((*solid.path, "mesh", "unit"), solid.shape.scale[0], 9e-4, 1.0)


def _extents(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far each mesh goes from its frame in the unit that is stated, or in m."""
    for solid in graph.cell.scene:
        reach = mesh_reach(graph, solid.shape) if isinstance(solid.shape, Mesh) else None
        if reach is not None:
            yield Figure((*solid.path, "mesh"), max(reach), _SMALL_M, _ROOM_M)


def _regions(graph: CellGraph) -> Iterator[Figure]:
    """Yield the longest edge of each region, which may be flat or a point."""
    uncertainty = graph.cell.uncertainty
    for name, region in () if uncertainty is None else uncertainty.regions.items():
        edge = 2.0 * max(region.half_m)
        yield Figure(("regions", name, "box"), edge, 1e-5 if edge else 0.0, 3.0)
        yaw = 2.0 * region.half_yaw_rad
        yield Figure(("regions", name, "yaw"), yaw, 1e-4 if yaw else 0.0, unit="deg")


def _calibrations(graph: CellGraph) -> _Owners:
    return ((calibration.path, calibration) for calibration in graph.cell.calibrations.values())


def _repeatability(graph: CellGraph) -> Iterator[Figure]:
    uncertainty = graph.cell.uncertainty
    for name, value in () if uncertainty is None else uncertainty.repeatability_m.items():
        yield Figure(("uncertainty", "repeatability", name), value, 1e-6, 5e-3)


def _allowed(graph: CellGraph) -> Iterator[Figure]:
    uncertainty = graph.cell.uncertainty
    for name, value in () if uncertainty is None else uncertainty.tolerances_m.items():
        yield Figure(("uncertainty", "tolerances", name), value, 2e-5, 0.1)


def _parts(graph: CellGraph) -> Iterator[Figure]:
    """Yield the tolerance of each part, which its width bounds."""
    for frame in graph.cell.frames:
        grasp = frame.grasp
        if grasp is None:
            continue
        path = (*frame.path, "grasp")
        if grasp.width_m is not None:
            yield Figure((*path, "width"), grasp.width_m, 1e-4, 3.0)
        if grasp.size_m is not None:
            yield Figure((*path, "size"), max(grasp.size_m), 1e-3, 3.0)
        if grasp.tolerance_m is not None:
            most = 0.05 if grasp.width_m is None else grasp.width_m / 2.0
            related = () if grasp.width_m is None else (Related("its width", graph.cell.locate(*path, "width")),)
            yield Figure((*path, "tolerance"), grasp.tolerance_m, 1e-5, most, related=related)


def _lengths(graph: CellGraph) -> float:
    """Return how far the longest chain of the cell reaches, straightened, m."""
    return max((chain_of(graph, group).length for group in graph.cell.groups), default=1.0)


def _ranges(graph: CellGraph) -> Iterator[Figure]:
    octomap = graph.cell.octomap
    if octomap is not None:
        reach = graph.once(_lengths)
        most, least = max(10.0, 5.0 * reach), max(5.0 * octomap.resolution_m, min(0.4 * reach, 1.0))
        related = (Related("an edge of its cells", graph.cell.locate(*_MAP, "resolution")),)
        yield Figure((*_MAP, "range"), octomap.range_m, least, most, related=related)


def _cells(graph: CellGraph) -> Iterator[Figure]:
    octomap = graph.cell.octomap
    if octomap is not None:
        related = (Related("as far as this", graph.cell.locate(*_MAP, "range")),)
        across = 2.0 * octomap.range_m / octomap.resolution_m
        yield Figure((*_MAP, "resolution"), across, 10.0, 1000.0, related=related)


def _padding(graph: CellGraph) -> Iterator[Figure]:
    octomap = graph.cell.octomap
    if octomap is not None:
        related = (Related("an edge of its cells", graph.cell.locate(*_MAP, "resolution")),)
        most = max(0.1, 3.0 * octomap.resolution_m)
        yield Figure((*_MAP, "padding"), octomap.padding_m, 1e-3, most, related=related)


def _reach(graph: CellGraph) -> Iterator[Figure]:
    caps, assessed = graph.cell.bringup.caps, graph.cell.safety.risk_assessment
    if caps is not None and caps.reach is not None:
        yield Figure(("bringup", "commissioning", "reach"), caps.reach, 0.05)
    if assessed is not None and assessed.reach is not None:
        yield Figure(("safety", "risk_assessment", "reach"), assessed.reach, 0.05, 3.0 * graph.once(_lengths))


def _moved(graph: CellGraph) -> Iterator[Figure]:
    """Yield by how much faults move what they hit: a length as far as an arm reaches, an angle within one turn."""
    for rehearsal in graph.cell.rehearsals:
        for fault in rehearsal.faults:
            by = fault.kind.by
            if by is None or fault.amount is None or by.amount not in (Amount.DISPLACEMENT, Amount.SIZE):
                continue
            length = fault.linear or by.amount is Amount.SIZE
            most, least = (1.0, 1e-6) if length else (math.tau, 1e-5)
            unit = "mm" if length else "deg"
            yield Figure((*fault.path, by.amount.key), abs(fault.amount), least, most, unit=unit)


_LONG_M, _STILL_M = 0.2, 2e-3


def _posed(graph: CellGraph) -> Iterator[Figure]:
    """Yield positions of long axes that are a hair from zero: meters were written as millimeters."""
    joints = {joint.name: joint for device in graph.cell.devices for joint in device.joints if joint.slides}
    for pose in graph.cell.poses:
        for name, position in zip(pose.joints, pose.positions, strict=False):
            joint = joints.get(name)
            if joint is not None and position and joint.upper is not None and joint.lower is not None:
                least = _STILL_M if joint.upper - joint.lower > _LONG_M else 0.0
                why = f"or zero, as `{name}` has a way of {joint.upper - joint.lower:.3g} m"
                yield Figure(pose.path, abs(position), least, because=why)


_EDGES = "from a foil to a hall"
BOUNDS = (
    Bound(("scene.*.box",), "an edge of the box", "mm", _EDGES, _boxes),
    Bound(
        ("areas.*.xyz", "frames.*.simulated_pose.xyz"), "the way beyond reach", "m", "where an arm is in it", _places
    ),
    Bound(("areas.*.box",), "an edge of the area", "mm", "in which an arm can be", _areas),
    Bound(
        ("scene.*.cylinder.radius", "scene.*.cylinder.length", "scene.*.sphere"),
        "a measure of the shape",
        "mm",
        "from a rod to a hall",
        _round,
    ),
    Bound(("scene.*.plane", "scene.*.touched.edge"), "the edge of the plane", "m", "from a plate to a hall", _planes),
    Bound(("scene.*.mesh.unit",), "`unit`", "mm", "from a millimeter to a meter", _meshes),
    Bound(
        ("scene.*.mesh.unit",),
        "the reach of the mesh",
        "mm",
        "from a small part to a room, in its `unit`, which is a meter where it is not stated",
        _extents,
    ),
    Bound(("regions.*.box", "regions.*.yaw"), "the range", "mm", "in which a part can lie", _regions),
    stated("calibrations.*.residual", _calibrations, "residual_m", 1e-6, math.inf, "mm", "what a fit leaves at least"),
    Bound(("uncertainty.repeatability.*",), "the repeatability", "mm", "what arms have by ISO 9283", _repeatability),
    Bound(("uncertainty.tolerances.*",), "the tolerance of the goal", "mm", "to which parts are placed", _allowed),
    Bound(
        ("frames.*.grasp.width", "frames.*.grasp.size", "frames.*.grasp.tolerance"),
        "the measure of the part",
        "mm",
        "a part that fingers hold, and at most half of its width for its tolerance",
        _parts,
    ),
    Bound(
        ("motion.octomap.range",),
        "`range`",
        "m",
        "from five of its cells and two fifths of what the arm reaches to five times that",
        _ranges,
    ),
    Bound(
        ("motion.octomap.resolution",),
        "the number of cells from side to side of the map",
        "",
        "what shows a thing and fits in memory",
        _cells,
    ),
    Bound(
        ("motion.octomap.padding",),
        "`padding`",
        "mm",
        "so that the arm is cut out of the map and nothing beside it, three cells at most",
        _padding,
    ),
    Bound(
        ("bringup.commissioning.reach", "safety.risk_assessment.reach"),
        "`reach`",
        "mm",
        "against what the arm reaches",
        _reach,
    ),
    Bound(
        ("rehearsals.*.inject.by", "rehearsals.*.inject.*.by"),
        "the size of the fault",
        "mm",
        "what it can be in a cell",
        _moved,
    ),
)
AXES = (Bound(("motion.poses.*.*",), "the position of the axis", "mm", "", _posed),)


@rule(Severity.WARNING, assumes=("frame-cycle",), gives_way=True)
def implausible_size(graph: CellGraph) -> Findings:
    """Yield lengths that are outside of what such things measure."""
    yield from outside(graph, (*BOUNDS, *AXES))
