"""Vertices and triangles of mesh files, as a confined child gives them; every number is checked again here."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from dataclasses import asdict
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from cellc.contract.frozen import dataclass
from cellc.contract.limits import Limits, limits
from cellc.contract.store.swap import temporary_folder
from cellc.robot.description.confined_child import ChildEndedError, ask_child
from cellc.robot.description.meshes import MALFORMED_MESH, MeshError, MeshFacts, MeshFile, too_large

_HEAD = struct.Struct("<II")
"""Bytes of the JSON head of an answer, and of the numbers behind it."""
EXPORT_AGAIN = "open it in a viewer, and export it again"


@dataclass(frozen=True, slots=True, eq=False)
class MeshNumbers:
    """A mesh as its file has it: vertices of shape (n, 3), and the three vertices of each triangle."""

    vertices: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int64]


def pack_numbers(mesh: MeshNumbers) -> bytes:
    """Write a mesh for the way from the child to the parent."""
    body = mesh.vertices.astype("<f8").tobytes() + mesh.triangles.astype("<u4").tobytes()
    return _packed({"vertices": len(mesh.vertices)}, body)


def pack_fault(fault: MeshError) -> bytes:
    """Write why a mesh cannot be used, for the way from the child to the parent."""
    return _packed({"fault": [fault.code, fault.message, fault.help_text, fault.certain]}, b"")


def _packed(head: dict[str, Any], body: bytes) -> bytes:
    text = json.dumps(head).encode()
    return _HEAD.pack(len(text), len(body)) + text + body


def read_meshes(files: tuple[MeshFile, ...]) -> tuple[MeshNumbers | MeshError, ...]:
    """Read mesh files in a child of bounded work and memory, and say of each what it holds, or why it cannot be used.

    The last answer is kept: a check asks first whether a mesh can be used, and then for its numbers.

    Returns:
        One for each file, in order; fewer where a file ended the child, the last of which says so.
    """
    return _read_within(files, limits()) if files else ()


@lru_cache(maxsize=1)
def _read_within(files: tuple[MeshFile, ...], allowed: Limits) -> tuple[MeshNumbers | MeshError, ...]:
    with temporary_folder("cellc-mesh-") as folder:
        request = {
            "limits": asdict(allowed),
            "folder": folder.as_posix(),
            "files": [[file.path, file.suffix, file.digest] for file in files],
        }
        try:
            answer = ask_child("cellc.robot.description.mesh_child", json.dumps(request).encode())
            return tuple(read_answers(answer, len(files)))
        except ChildEndedError as ended:
            last = too_large(f"{ended} with the meshes before it", "mesh-seconds", certain=False)
            return (*read_answers(ended.answer, len(files) - 1), last)


def facts_in(file: MeshFile, files: tuple[MeshFile, ...]) -> MeshFacts:
    """Tell what is in one of several files that are read together; nothing where another one ended the reading."""
    read = dict(zip(files, read_meshes(files), strict=False)).get(file)
    return MeshFacts(certain=False) if read is None else facts_of(read)


def facts_of(read: MeshNumbers | MeshError) -> MeshFacts:
    """Tell of a mesh what decides whether a shape can use it."""
    if isinstance(read, MeshError):
        return MeshFacts(fault=(read.code, read.message, read.help_text), certain=read.certain)
    x, y, z = (float(length) for length in np.abs(read.vertices).max(axis=0))
    return MeshFacts(len(read.triangles), (x, y, z))


def read_answers(data: bytes, most: int) -> Iterator[MeshNumbers | MeshError]:
    """Yield what the child said of each mesh, as far as it got, and trust none of it."""
    at = 0
    for _ in range(most):
        if len(data) < at + _HEAD.size:
            return
        head, body = _HEAD.unpack_from(data, at)
        middle, end = at + _HEAD.size + head, at + _HEAD.size + head + body
        if end > len(data):
            return
        yield _answer(json.loads(data[at + _HEAD.size : middle]), data[middle:end])
        at = end


def _answer(head: dict[str, Any], body: bytes) -> MeshNumbers | MeshError:
    if "fault" in head:
        return MeshError(*head["fault"])
    vertices = np.frombuffer(body, dtype="<f8", count=3 * head["vertices"]).astype(np.float64).reshape(-1, 3)
    triangles = np.frombuffer(body, dtype="<u4", offset=24 * head["vertices"]).astype(np.int64).reshape(-1, 3)
    if not np.isfinite(vertices).all():
        return MeshError(MALFORMED_MESH, "must have finite coordinates, got NaN or infinity", EXPORT_AGAIN)
    if not len(triangles) or triangles.max() >= len(vertices):
        return MeshError(MALFORMED_MESH, "must have triangles between its vertices", EXPORT_AGAIN)
    return MeshNumbers(vertices, triangles)
