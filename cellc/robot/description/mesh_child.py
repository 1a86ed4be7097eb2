"""The child that reads untrusted mesh files, with the library (assimp) that MoveIt and RViz read them with too.

It answers on stdout in plain numbers, one mesh after the other, so that where it ends early the first mesh without an
answer is the one that ended it. The library is given a private copy of exactly the bytes that were hashed, and nothing
in them that would make it open a further file.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from pathlib import Path
from typing import Any

import coal
import numpy as np

from cellc.contract.limits import MIB, Limits, limits, use
from cellc.contract.store.swap import remove_file, write_new
from cellc.robot.description.confined_child import confine_this_process
from cellc.robot.description.mesh_numbers import EXPORT_AGAIN, MeshNumbers, pack_fault, pack_numbers
from cellc.robot.description.meshes import MALFORMED_MESH, MeshError, read_pieces, too_large

_STL_HEAD, _STL_TRIANGLE = 84, 50
_GLB_HEAD, _GLB_CHUNK = 12, 8
_CONTINUED, _LINE_END = re.compile(rb"\\[ \t]*(?:\r\n|[\n\r\f\0])"), re.compile(rb"[\n\r\f\v\0]")
_OBJ_SHAPE = frozenset((b"v", b"vn", b"vt", b"f", b"g", b"o", b"s"))
_JSON_CHUNK = b"JSON"
_OTHER_SHAPE = "export the shape as one file of triangles, such as STL"


def main() -> None:
    """Read the meshes that stdin names, each with its suffix and hash."""
    request = json.load(sys.stdin)
    use(Limits(**request["limits"]))
    # An answer has at most three vertices for each triangle, of 24 bytes, and 12 bytes for the triangle itself.
    most_bytes = max(84 * limits().mesh_triangles_together + MIB, limits().mesh_bytes)
    confine_this_process(limits().mesh_seconds, limits().mesh_memory, most_bytes)
    together = 0
    for path, suffix, digest in request["files"]:
        try:
            mesh = _read(Path(path), digest, Path(request["folder"], f"mesh{suffix}"))
            together += len(mesh.triangles)
            if together > (most := limits().mesh_triangles_together):
                message = f"must have at most {most} triangles with the meshes before it, got {together}"
                raise too_large(message, "mesh-triangles-together", certain=False)
            answer = pack_numbers(mesh)
        except MeshError as fault:
            answer = pack_fault(fault)
        sys.stdout.buffer.write(answer)
        sys.stdout.buffer.flush()


def _read(file: Path, digest: str, copy: Path) -> MeshNumbers:
    try:
        content = b"".join(read_pieces(file))
    except OSError:
        content = b""
    if hashlib.sha256(content).hexdigest() != digest:
        raise MeshError(MALFORMED_MESH, "changes while it is read", "try again", certain=False)
    remove_file(copy)  # that of the mesh before
    write_new(copy, _self_contained(content, copy.suffix))
    try:
        # The boxes round its triangles, which the library builds too, are not needed here: the simplest kind of them.
        mesh = coal.MeshLoader(coal.NODE_TYPE.BV_AABB).load(str(copy), np.ones(3))
    except (ValueError, RuntimeError):
        message = f"cannot be read as `{copy.suffix}`"
        raise MeshError(MALFORMED_MESH, message, EXPORT_AGAIN) from None
    _bound(mesh.num_tris)
    return MeshNumbers(np.array(mesh.vertices(), dtype=np.float64).reshape(-1, 3), _triangles(mesh))


def _triangles(mesh: Any) -> np.ndarray[Any, np.dtype[np.int64]]:
    corners = np.empty((mesh.num_tris, 3), dtype=np.int64)
    for row in range(mesh.num_tris):
        triangle = mesh.tri_indices(row)
        corners[row] = triangle[0], triangle[1], triangle[2]
    return corners


def _bound(triangles: int) -> None:
    if triangles > (most := limits().mesh_triangles):
        raise too_large(f"must have at most {most} triangles, got {triangles}", "mesh-triangles")


def _self_contained(content: bytes, suffix: str) -> bytes:
    """Return the content without what names other files; refuse early what is an archive, or a count beyond bounds."""
    if content.startswith(b"PK"):
        raise MeshError(MALFORMED_MESH, f"must be a `{suffix}` file, got a zip archive", "unpack it")
    if suffix == ".stl" and len(content) >= _STL_HEAD:
        count = int.from_bytes(content[80:_STL_HEAD], "little")
        if not content.startswith(b"solid") or len(content) == _STL_HEAD + count * _STL_TRIANGLE:
            _bound(count)
    if suffix == ".obj":
        return _shape_of_obj(content)
    if suffix == ".glb":
        return _one_file(content)
    return content


def _shape_of_obj(content: bytes) -> bytes:
    """Return the lines of a Wavefront OBJ that make its shape, one by one: none of them names another file.

    Line ends, and backslashes that join lines, are resolved here, so that no other parser decides them differently.
    """
    lines = (line.split() for line in _LINE_END.split(_CONTINUED.sub(b" ", content)))
    shape = (b" ".join(words) for words in lines if words and words[0] in _OBJ_SHAPE)
    return b"\n".join(shape).replace(b"\\", b"_") + b"\n"


def _one_file(content: bytes) -> bytes:
    """Return a binary glTF 2.0 whose JSON is written again, so that every reader reads the same in it.

    Raises:
        MeshError: a buffer or image lies in another file (glTF 2.0 specification, section 4.4), or a key occurs twice.
    """
    magic, version = content[:4], int.from_bytes(content[4:8], "little")
    length = int.from_bytes(content[_GLB_HEAD : _GLB_HEAD + 4], "little")
    start = _GLB_HEAD + _GLB_CHUNK
    try:
        if (magic, version, content[start - 4 : start]) != (b"glTF", 2, _JSON_CHUNK):
            raise ValueError
        scene = json.loads(content[start : start + length], object_pairs_hook=_each_once)
        named = [part.get("uri", "data:") for kind in ("buffers", "images") for part in scene.get(kind, ())]
        outside = [uri for uri in named if not uri.startswith("data:")]
        text = json.dumps(scene, allow_nan=False).encode()
    except (ValueError, AttributeError, TypeError, RecursionError):
        raise MeshError(MALFORMED_MESH, "must be a binary glTF 2.0", _OTHER_SHAPE) from None
    if outside:
        raise MeshError(MALFORMED_MESH, "must be one file, and names others", _OTHER_SHAPE)
    text += b" " * (-len(text) % 4)
    chunks = len(text).to_bytes(4, "little") + _JSON_CHUNK + text + content[start + length :]
    return content[:8] + (_GLB_HEAD + len(chunks)).to_bytes(4, "little") + chunks


def _each_once(pairs: list[tuple[str, object]]) -> dict[str, object]:
    if len(members := dict(pairs)) < len(pairs):
        raise ValueError
    return members


if __name__ == "__main__":
    main()
