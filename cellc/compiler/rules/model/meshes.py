"""Rules on the shapes of a description."""

from __future__ import annotations

from collections.abc import Sequence

from cellc.compiler.feasibility import MeshFault, mesh_faults, motion_answer
from cellc.compiler.rules.geometry import SOUND_MODEL, USABLE_MESHES, beyond_limits
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule, rules


@rule(Severity.ERROR, assumes=(*SOUND_MODEL, *USABLE_MESHES))
def geometry_too_large(graph: CellGraph) -> Findings:
    """Yield the limit that the geometry is beyond."""
    yield from beyond_limits(graph, motion_answer(graph))


def _unusable_meshes(graph: CellGraph, code: str) -> Findings:
    """Yield the meshes of collision shapes that cannot be used for the reason that a rule reports.

    Those of one device that are not there are one finding: one package is missing, not twenty files.
    """
    faults: dict[object, list[MeshFault]] = {}
    for number, fault in enumerate(fault for fault in mesh_faults(graph) if fault.code == code):
        faults.setdefault(fault.path if code == "mesh-not-found" else number, []).append(fault)
    for first, *others in faults.values():
        more = f"; nor {', '.join(f'`{fault.name}`' for fault in others)}" if others else ""
        more += _unseen(graph, [first, *others]) if code == "mesh-not-found" else ""
        yield Finding(first.message + more, first.span, first.path, first.help)


def _unseen(graph: CellGraph, faults: Sequence[MeshFault]) -> str:
    """Say which links of a device touch nothing for want of a shape: those that move may hit anything."""
    if faults[0].path[0] == "scene":
        return "; contact with it is not checked"
    missing = {fault.name for fault in faults}
    links = [
        part.link.name
        for part in graph.model.links()
        if part.path == faults[0].path and any(mesh.filename in missing for mesh in part.link.collision_meshes())
    ]
    moving = [link for link in links if any(frame.moving for frame in graph.frames.chain(link))]
    of_these = f", {len(moving)} of which move" if moving else ", which do not move"
    return f"; contact of {', '.join(f'`{link}`' for link in links)}{of_these}, is not checked"


UNUSABLE = rules(Severity.ERROR, _unusable_meshes, {code: code for code in USABLE_MESHES})
ABSENT = rules(Severity.WARNING, _unusable_meshes, {"mesh-not-found": "mesh-not-found"})
