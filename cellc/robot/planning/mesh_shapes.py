"""Mesh shapes of a description as pinocchio checks them, from numbers that a confined child has read.

pinocchio would open the files itself, in this process. It is given a ball in the place of each mesh, which is then
replaced by the mesh: same placement, same name, same order.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import coal
import numpy as np

from cellc.contract.transforms import Vector3
from cellc.robot.description.mesh_numbers import MeshNumbers, facts_of, read_meshes
from cellc.robot.description.meshes import MeshError, MeshFile, identify_all, readable, unusable
from cellc.robot.description.model import Description, Mesh

PinShape = Any  # coal ships no type information


def mesh_shapes(description: Description, roots: Sequence[Path]) -> dict[tuple[str, int], PinShape]:
    """Return coal's shape of each mesh by its link and its number among the collision shapes of the link.

    Args:
        roots: folders of the specs that bring the descriptions; see ``identify``.

    Raises:
        MeshError: one of them cannot be used.
    """
    placed = {
        (link.name, number): shape.geometry
        for link in description.links
        for number, shape in enumerate(link.collisions)
        if isinstance(shape.geometry, Mesh)
    }
    if not placed:
        return {}
    files = identify_all(placed.values(), roots)
    usable = readable(files)
    read = dict(zip(usable, read_meshes(usable), strict=False))
    facts = {file: facts_of(numbers) for file, numbers in read.items()}
    for _, fault in unusable(tuple(placed.values()), files, facts):
        raise fault
    numbers = {name: read[file] for name, file in files.items() if isinstance(file, MeshFile)}
    shapes = {mesh: _shape(numbers[mesh.filename], mesh.scale) for mesh in set(placed.values())}
    return {place: shapes[mesh] for place, mesh in placed.items()}


def _shape(mesh: MeshNumbers | MeshError, scale: Vector3) -> PinShape:
    """Build the tree of boxes round the triangles that pinocchio builds of a mesh file."""
    assert isinstance(mesh, MeshNumbers)  # a fault was raised
    shape = coal.BVHModelOBBRSS()
    shape.beginModel(len(mesh.triangles), len(mesh.vertices))
    shape.addVertices(mesh.vertices * np.array(scale))
    shape.addTriangles(mesh.triangles)
    shape.endModel()
    return shape
