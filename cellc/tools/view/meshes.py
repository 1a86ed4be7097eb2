"""Meshes of a description as the page draws them: read by the confined child, and no finer than a page may weigh."""

from __future__ import annotations

import base64
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellc.robot.description.mesh_numbers import MeshNumbers, facts_of, read_meshes
from cellc.robot.description.meshes import MeshFile, identify_all, readable, unusable
from cellc.robot.description.model import Collision, Link, Mesh, Visual

_MOST_TRIANGLES = 36_000
"""Of all meshes of a page together: about 12 bytes of the page each, 0.4 MB."""
_LEAST_SHARE, _LARGEST_SHARE = 200, 20_000
"""Of one mesh; the larger one keeps the numbers of its vertices within 16 bits."""
_UNREAD = "mesh `{}` cannot be read together with the others"
_CELLS = 4095
"""Steps along the longest edge of a mesh: 0.2 mm of a meter."""


@dataclass(frozen=True, slots=True)
class DrawnMesh:
    """Vertices in whole steps from a corner, and triangles as three of their numbers; both 16 bits, little endian.

    Attributes:
        low: the corner in m.
        step: in m.
    """

    low: tuple[float, ...]
    step: float
    vertices: str
    triangles: str


@dataclass(frozen=True, slots=True)
class Meshes:
    """The meshes that are drawn, where each that a description names is among them, and why others are not."""

    drawn: tuple[DrawnMesh, ...] = ()
    numbers: Mapping[Mesh, int] = field(default_factory=dict)
    absent: Mapping[Mesh, str] = field(default_factory=dict)


def meshes_at_hand(links: Sequence[Link], roots: Sequence[Path]) -> Meshes:
    """Read the meshes that links are drawn with: those to look at, or where one is missing those that collide.

    Args:
        roots: folders of the specs that bring the descriptions, beside the package path.
    """
    there = identify_all((mesh for link in links for mesh in meshes_of(link.visuals)), roots)
    named = {name for name, file in there.items() if isinstance(file, MeshFile)}
    wanted = tuple(dict.fromkeys(mesh for link in links for mesh in _chosen(link, named)))
    if not wanted:
        return Meshes()
    files = identify_all(wanted, roots)
    at_hand = readable(files)
    read = dict(zip(at_hand, read_meshes(at_hand), strict=False))
    facts = {file: facts_of(numbers) for file, numbers in read.items()}
    faults = {mesh: fault.message for mesh, fault in unusable(wanted, files, facts)}
    whole = {mesh: read.get(file) for mesh in wanted if isinstance(file := files.get(mesh.filename), MeshFile)}
    usable = {
        mesh: mesh_numbers
        for mesh, mesh_numbers in whole.items()
        if isinstance(mesh_numbers, MeshNumbers) and mesh not in faults
    }
    share = min(_LARGEST_SHARE, max(_LEAST_SHARE, _MOST_TRIANGLES // max(1, len(usable))))
    return Meshes(
        tuple(_drawn(mesh_numbers, mesh, share) for mesh, mesh_numbers in usable.items()),
        {mesh: number for number, mesh in enumerate(usable)},
        {mesh: faults.get(mesh, _UNREAD.format(mesh.filename)) for mesh in wanted if mesh not in usable},
    )


def meshes_of(shapes: Iterable[Visual | Collision]) -> tuple[Mesh, ...]:
    """Return the meshes among shapes, in their order."""
    return tuple(shape.geometry for shape in shapes if isinstance(shape.geometry, Mesh))


def _chosen(link: Link, found: Container[str]) -> tuple[Mesh, ...]:
    seen = meshes_of(link.visuals)
    return seen if link.visuals and all(mesh.filename in found for mesh in seen) else link.collision_meshes() or seen


def _drawn(read: MeshNumbers, mesh: Mesh, most: int) -> DrawnMesh:
    vertices = read.vertices * np.array(mesh.scale)
    low = vertices.min(axis=0)
    step = float(np.ptp(vertices, axis=0).max()) / _CELLS or 1.0
    points, triangles = coarsened(vertices, read.triangles, most)
    if np.prod(mesh.scale) < 0:  # mirrored: what was outside is inside
        triangles = triangles[:, ::-1]
    return DrawnMesh(
        tuple(round(float(item), 6) for item in low),
        float(f"{step:.6g}"),
        _packed(np.rint((points - low) / step)),
        _packed(triangles),
    )


def coarsened(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], most: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return a mesh of at most so many triangles: vertices that share a cell of a grid become their mean.

    The grid is as fine as the number allows (Rossignac and Borrel, Multi-resolution 3D approximations for rendering
    complex scenes, 1993).
    """
    low, edge = vertices.min(axis=0), float(np.ptp(vertices, axis=0).max()) or 1.0
    cells = float(_CELLS)
    while True:
        _, owner, count = np.unique(
            np.floor((vertices - low) * (cells / edge)), axis=0, return_inverse=True, return_counts=True
        )
        owner = owner.reshape(-1)
        merged = owner[triangles]
        a, b, c = merged.T
        merged = np.unique(merged[(a != b) & (b != c) & (c != a)], axis=0)
        if len(merged) <= most or cells < 2.0:
            means = np.stack([np.bincount(owner, vertices[:, axis]) for axis in range(3)], axis=1) / count[:, None]
            points, numbered = np.unique(merged, return_inverse=True)
            return means[points], numbered.reshape(-1, 3)
        cells *= max(0.4, min(0.9, (most / len(merged)) ** 0.5))


def _packed(numbers: NDArray[np.generic]) -> str:
    return base64.b64encode(numbers.astype("<u2").tobytes()).decode()
