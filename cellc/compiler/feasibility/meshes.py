"""Which meshes of a cell can be used, and what an answer that rests on them is kept under."""

from __future__ import annotations

from pathlib import Path

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import Solid
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.frame_tree import ModelLink
from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.limits import as_options, limits
from cellc.contract.store.cache import recall
from cellc.contract.transforms import Vector3
from cellc.robot.description.meshes import (
    MESH_NOT_FOUND,
    MeshError,
    MeshFacts,
    MeshFile,
    identify_all,
    readable,
    unusable,
    without_shapes,
)
from cellc.robot.description.model import Mesh


@dataclass(frozen=True, slots=True)
class MeshFault:
    """A mesh that cannot be used: its name, code of a rule, message and help, and where the description names it."""

    name: str
    code: str
    message: str
    help: str
    span: Span
    path: YamlPath


def mesh_roots(cell: Cell) -> tuple[Path, ...]:
    """Return the folders under which meshes may lie: of the files that name the devices, and those the spec names."""
    places = (cell.locate(*device.path, "model").file for device in cell.devices)
    return tuple(dict.fromkeys((*(Path(place).parent for place in places), *map(Path, cell.packages))))


def spec_of(graph: CellGraph) -> Path:
    """Return the file that names the cell."""
    return Path(graph.cell.locate("cell").file)


def mesh_contents(graph: CellGraph) -> str:
    """Return what every mesh of the collision shapes is now: the hash of its content, or why it cannot be found."""
    files = identify_all((mesh for mesh, _ in _meshes(graph)), mesh_roots(graph.cell))
    return "\n".join(
        f"{name}\n{file if isinstance(file, MeshError) else file.suffix + file.digest}"
        for name, file in sorted(files.items())
    )


def with_shapes_at_hand(urdf: str, graph: CellGraph) -> str:
    """Return a description of the cell without the collision shapes whose meshes are not there."""
    missing = {fault.name for fault in mesh_faults(graph) if fault.code == MESH_NOT_FOUND}
    return without_shapes(urdf, missing) if missing else urdf


def mesh_faults(graph: CellGraph) -> tuple[MeshFault, ...]:
    """Return the meshes of collision shapes that cannot be used, in the order of the descriptions."""
    return graph.once(_faults)


def mesh_reach(graph: CellGraph, mesh: Mesh) -> Vector3 | None:
    """Return how far a mesh goes from its origin along each axis, m; None of one that is not there or unusable."""
    files, facts = graph.once(_read)
    file = files.get(mesh.filename)
    known = None if file is None or isinstance(file, MeshError) else facts.get(file)
    if known is None or known.fault is not None or not known.certain:
        return None
    x, y, z = (abs(factor) * length for factor, length in zip(mesh.scale, known.reach, strict=True))
    return x, y, z


def _read(graph: CellGraph) -> tuple[dict[str, MeshFile | MeshError], dict[MeshFile, MeshFacts]]:
    files = identify_all([mesh for mesh, _ in _meshes(graph)], mesh_roots(graph.cell))
    mesh_files = readable(files)
    return files, {file: _facts(file, mesh_files, spec_of(graph)) for file in mesh_files}


def _faults(graph: CellGraph) -> tuple[MeshFault, ...]:
    placed = _meshes(graph)
    meshes = [mesh for mesh, _ in placed]
    files, facts = graph.once(_read)
    owners = dict(reversed(placed))  # of each file and scale the first link
    return tuple(
        MeshFault(mesh.filename, why.code, why.message, why.help_text, mesh.span or owner.span, owner.path)
        for mesh, why in unusable(meshes, files, facts)
        for owner in (owners[mesh],)
    )


def _meshes(graph: CellGraph) -> list[tuple[Mesh, ModelLink | Solid]]:
    of_links = [(mesh, part) for part in graph.model.links() for mesh in part.link.collision_meshes()]
    return [*of_links, *((thing.shape, thing) for thing in graph.cell.scene if isinstance(thing.shape, Mesh))]


def _facts(file: MeshFile, files: tuple[MeshFile, ...], spec: Path) -> MeshFacts:
    """Return what is in a file, which is read together with the others, from the cache where it was read before."""

    def read() -> MeshFacts:
        from cellc.robot.description.mesh_numbers import facts_in  # loads numpy

        return facts_in(file, files)

    question = "\0".join((file.suffix, file.digest, *as_options(limits())))
    return recall("mesh", question, MeshFacts, read, lambda facts: facts.certain, spec)
