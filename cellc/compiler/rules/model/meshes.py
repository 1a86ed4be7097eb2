"""Rules on the shapes of a description."""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import SOUND_MODEL, USABLE_MESHES, beyond_limits, unusable_meshes
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule


@rule(Severity.ERROR, assumes=(*SOUND_MODEL, *USABLE_MESHES))
def geometry_too_large(graph: CellGraph) -> Findings:
    """Yield the limit that the geometry is beyond."""
    yield from beyond_limits(graph, motion_answer(graph))


@rule(Severity.ERROR)
def malformed_mesh(graph: CellGraph) -> Findings:
    """Yield meshes that cannot be read."""
    yield from unusable_meshes(graph, "malformed-mesh")


@rule(Severity.WARNING)
def mesh_not_found(graph: CellGraph) -> Findings:
    """Yield meshes that are not there."""
    yield from unusable_meshes(graph, "mesh-not-found")


@rule(Severity.ERROR)
def mesh_outside_root(graph: CellGraph) -> Findings:
    """Yield meshes that lie elsewhere."""
    yield from unusable_meshes(graph, "mesh-outside-root")


@rule(Severity.ERROR)
def mesh_too_large(graph: CellGraph) -> Findings:
    """Yield meshes beyond the limits."""
    yield from unusable_meshes(graph, "mesh-too-large")
