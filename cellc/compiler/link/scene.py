"""Binds the solid things of the cell: each shape with its place, by figures or by points that were touched."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import field

from cellc.compiler.cell.frame import Frame, FrameKind, Solid, TouchedFit
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER, FrameNames
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import pose, vector
from cellc.compiler.link.touched import box_around, plane_through
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.scene import (
    BoxSpec,
    CylinderSpec,
    MeshSpec,
    PlaneSpec,
    SolidSpec,
    SphereSpec,
    TouchedPoints,
    TouchedSpec,
)
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3, from_xyz_rpy, identity
from cellc.robot.description.model import Cylinder, Mesh, Sphere

PLANE_DEPTH_M = 0.1
"""A plane is a box to URDF, which has no planes: deeper than what a checked motion moves from one check to the next."""
_EDGE_M = 4.0
_NOWHERE = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class _Body:
    """What a thing is, and where: the fields of a `Solid` that follow from its shape."""

    transform_to_parent: Pose
    size: Vector3
    shape: Cylinder | Sphere | Mesh | None = None
    center: Pose = field(default_factory=identity)
    touched: TouchedFit | None = None


def link_scene(spec: CellSpec, document: SourceDocument, names: FrameNames) -> Outcome[tuple[Solid, ...]]:
    """Bind the solid things of the cell, and the names of those that its surroundings are said to be."""
    solids: list[Solid] = []
    problems: list[Diagnostic] = list(_unknown_surroundings(spec, document))
    for name, solid in until_hopeless(spec.scene.items(), problems):
        path = ("scene", name)
        parent, body = names.bind(solid.parent, (*path, "parent")), _body(solid, document, path)
        problems += (*parent.diagnostics, *body.diagnostics)
        if parent.value is not None and body.value is not None:
            made = body.value
            solids.append(
                Solid(
                    name=name,
                    path=path,
                    span=document.locate(path),
                    parent=parent.value,
                    transform_to_parent=made.transform_to_parent,
                    size=made.size,
                    kind=solid.kind,
                    shape=made.shape,
                    center=made.center,
                    touched=made.touched,
                )
            )
    return Outcome(tuple(solids), tuple(problems))


def scene_frames(solids: Iterable[Solid]) -> tuple[Frame, ...]:
    """Return the frame of each solid thing."""
    return tuple(
        Frame(
            name=solid.name,
            path=solid.path,
            span=solid.span,
            kind=FrameKind.SCENE,
            parent=solid.parent,
            transform_to_parent=solid.transform_to_parent,
            authority=ROBOT_STATE_PUBLISHER,
            designed=True,
        )
        for solid in solids
    )


def _unknown_surroundings(spec: CellSpec, document: SourceDocument) -> Iterator[Diagnostic]:
    for part, known in spec.surroundings:
        for number, name in enumerate(known.shapes):
            if name not in spec.scene:
                path = ("surroundings", part, "shapes", number)
                yield unknown_name("unknown-frame", name, "thing of the scene", spec.scene, document, path)


def _body(solid: SolidSpec, document: SourceDocument, path: YamlPath) -> Outcome[_Body]:
    if isinstance(solid, TouchedSpec):
        return _fitted(solid.touched, document, (*path, "touched"))
    place = pose(solid.xyz, solid.rpy)
    if isinstance(solid, BoxSpec):
        return Outcome(_Body(place, vector(solid.box)))
    if isinstance(solid, CylinderSpec):
        radius, length = solid.cylinder.radius.si, solid.cylinder.length.si
        return Outcome(_Body(place, (2.0 * radius, 2.0 * radius, length), Cylinder(radius, length)))
    if isinstance(solid, SphereSpec):
        edge = 2.0 * solid.sphere.si
        return Outcome(_Body(place, (edge, edge, edge), Sphere(solid.sphere.si)))
    if isinstance(solid, PlaneSpec):
        return Outcome(_plane(place, solid.plane.si))
    assert isinstance(solid, MeshSpec)
    unit = 1.0 if solid.mesh.unit is None else solid.mesh.unit.si
    mesh = Mesh(solid.mesh.file, (unit, unit, unit), document.locate((*path, "mesh", "file")))
    return Outcome(_Body(place, _NOWHERE, mesh))


def _plane(surface: Pose, edge: float, touched: TouchedFit | None = None) -> _Body:
    behind = from_xyz_rpy((0.0, 0.0, -PLANE_DEPTH_M / 2.0), _NOWHERE)
    return _Body(surface, (edge, edge, PLANE_DEPTH_M), center=behind, touched=touched)


def _fitted(touched: TouchedPoints, document: SourceDocument, path: YamlPath) -> Outcome[_Body]:
    """Fit a shape to touched points, or say what keeps it from them."""
    points = [vector(point) for point in touched.points]
    is_plane = touched.shape == "plane"
    fit = plane_through(points, vector(touched.free)) if is_plane else box_around(points)
    if fit is None:
        message = "must not be on one line, and `free` must lie beside them" if is_plane else "must span a volume"
        return Outcome(None, (_apart(f"the touched points {message}", document, (*path, "points")),))
    worst = max(fit.distances_m)
    if worst > touched.within.si:
        number = fit.distances_m.index(worst)
        message = f"each touched point must lie within {touched.within.text} of the {touched.shape}, got {_mm(worst)}"
        return Outcome(None, (_apart(message, document, (*path, "points", number)),))
    mean = math.sqrt(math.fsum(each * each for each in fit.distances_m) / len(points))
    residuals = TouchedFit(points=len(points), root_mean_square_m=mean, largest_m=worst)
    if is_plane:
        return Outcome(_plane(fit.pose, _EDGE_M if touched.edge is None else touched.edge.si, residuals))
    return Outcome(_Body(fit.pose, fit.size, touched=residuals))


def _mm(length_m: float) -> str:
    return f"{length_m * 1e3:.3g} mm"


def _apart(message: str, document: SourceDocument, path: YamlPath) -> Diagnostic:
    advice = "touch them again, leave out what is not part of the surface, or state a larger `within`"
    return Diagnostic("touched-points-apart", Severity.ERROR, message, document.locate(path), path, advice)
