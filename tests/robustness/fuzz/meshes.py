"""Small meshes of the formats that descriptions name, and ways to damage them."""

from __future__ import annotations

import json
import random
import struct
from collections.abc import Callable
from functools import cache

from tests.robustness.fuzz.byte_mutations import mutate_bytes
from tests.robustness.fuzz.hostile import NUMBERS

_CORNERS = ((0.0, 0.0, 0.0), (0.04, 0.0, 0.0), (0.0, 0.04, 0.0), (0.0, 0.0, 0.04))
_FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
_ODD_FLOATS = (float("nan"), float("inf"), -float("inf"), 1e38, -1e38, 1e-45, 0.0)


@cache
def shapes() -> dict[str, bytes]:
    """Return a tetrahedron of 4 cm in each format, by file name."""
    return {
        "shape.stl": binary_stl(),
        "ascii.stl": _ascii_stl().encode(),
        "shape.obj": _obj().encode(),
        "shape.ply": _ply().encode(),
        "shape.dae": _dae().encode(),
        "shape.glb": _glb(),
    }


def damaged(name: str, data: bytes, chance: random.Random) -> bytes:
    """Return a mesh file changed once."""
    changes: list[Callable[[], bytes]] = [lambda: mutate_bytes(data, chance), lambda: _number_changed(data, chance)]
    if name == "shape.stl":
        changes += [lambda: _count_changed(data, chance), lambda: _float_changed(data, chance)] * 2
    if name.endswith(".dae"):
        changes += [lambda: _with_entities(data)]
    return chance.choice(changes)()


def binary_stl(scale: float = 1.0) -> bytes:
    """Return the tetrahedron as a binary STL file."""
    triangles = [
        struct.pack("<12fH", 0, 0, 0, *(scale * value for corner in face for value in _CORNERS[corner]), 0)
        for face in _FACES
    ]
    return b"made up".ljust(80) + struct.pack("<I", len(triangles)) + b"".join(triangles)


def _ascii_stl() -> str:
    lines = ["solid s"]
    for face in _FACES:
        lines += [
            "facet normal 0 0 0",
            "outer loop",
            *(f"vertex {' '.join(map(str, _CORNERS[i]))}" for i in face),
            "endloop",
            "endfacet",
        ]
    return "\n".join([*lines, "endsolid s"]) + "\n"


def _obj() -> str:
    corners = [f"v {' '.join(map(str, corner))}" for corner in _CORNERS]
    faces = [f"f {' '.join(str(index + 1) for index in face)}" for face in _FACES]
    return "\n".join(["mtllib shape.mtl", "o s", *corners, "usemtl m", *faces]) + "\n"


def _ply() -> str:
    head = ["ply", "format ascii 1.0", "element vertex 4", *(f"property float {axis}" for axis in "xyz")]
    head += ["element face 4", "property list uchar int vertex_indices", "end_header"]
    corners = [" ".join(map(str, corner)) for corner in _CORNERS]
    return "\n".join([*head, *corners, *(f"3 {' '.join(map(str, face))}" for face in _FACES)]) + "\n"


def _dae() -> str:
    floats = " ".join(str(value) for corner in _CORNERS for value in corner)
    indices = " ".join(str(index) for face in _FACES for index in face)
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">{floats}</float_array>
<technique_common><accessor source="#a" count="4" stride="3">{axes}</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


def _glb() -> bytes:
    positions = b"".join(struct.pack("<3f", *corner) for corner in _CORNERS)
    indices = struct.pack("<12H", *(index for face in _FACES for index in face))
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(positions + indices)}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 4,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": [0.04, 0.04, 0.04],
            },
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", 72, 0x004E4942) + positions + indices
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _count_changed(data: bytes, chance: random.Random) -> bytes:
    count = chance.choice((0, 1, 3, 5, 1000, 2**31 - 1, 2**32 - 1))
    return data[:80] + struct.pack("<I", count) + data[84:]


def _float_changed(data: bytes, chance: random.Random) -> bytes:
    place = 84 + 50 * chance.randrange(4) + 12 + 4 * chance.randrange(9)
    return data[:place] + struct.pack("<f", chance.choice(_ODD_FLOATS)) + data[place + 4 :]


def _number_changed(data: bytes, chance: random.Random) -> bytes:
    words = data.split(b" ")
    numbers = [place for place, word in enumerate(words) if any(48 <= byte < 58 for byte in word)]
    if numbers:
        words[chance.choice(numbers)] = chance.choice((*NUMBERS, "nan", "inf", "4294967295")).encode()
    return b" ".join(words)


def _with_entities(data: bytes) -> bytes:
    entities = "".join(f'<!ENTITY e{level} "{f"&e{level - 1};" * 10}">' for level in range(1, 10))
    doctype = f'<!DOCTYPE COLLADA [<!ENTITY e0 "0 "><!ENTITY x SYSTEM "file:///etc/passwd">{entities}]>'
    return data.replace(b"<COLLADA", doctype.encode() + b"<COLLADA", 1).replace(b"0.04 0.0", b"&e9; &x;", 1)
