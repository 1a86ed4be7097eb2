"""A mesh is checked for collisions as pinocchio checks the file that it opens itself."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import pytest

from cellc.robot.description.packages import on_package_path
from cellc.robot.planning import RobotModel

CORNERS = ((0, 0, 0), (0.1, 0, 0), (0, 0.2, 0), (0, 0, 0.3))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
ROBOT = """<robot name="r"><link name="base">
<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
<collision><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>
<geometry><mesh filename="package://parts/a.stl" scale="2 -1 0.5"/></geometry></collision>
</link><link name="a_1"><visual><geometry><mesh filename="package://absent/b.dae"/></geometry></visual>
<collision><geometry><mesh filename="package://parts/b.obj"/></geometry></collision>
<collision><geometry><sphere radius="0.1"/></geometry></collision>
<collision><geometry><mesh filename="package://parts/a.stl"/></geometry></collision></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="a_1"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"""


@pytest.fixture(name="shelf")
def shelf_fixture(tmp_path: Path) -> Iterator[Path]:
    parts = tmp_path / "parts"
    parts.mkdir()
    triangles = [[value for corner in face for value in CORNERS[corner]] for face in FACES]
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *values, 0) for values in triangles)
    (parts / "a.stl").write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + body)
    lines = [f"v {x} {y} {z}" for x, y, z in CORNERS] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in FACES]
    (parts / "b.obj").write_text("mtllib absent.mtl\n" + "\n".join(lines) + "\n")
    with on_package_path([str(tmp_path)]):
        yield tmp_path


def _shown(geometry: Any) -> list[tuple[object, ...]]:
    shapes: list[tuple[object, ...]] = []
    for each in geometry.geometryObjects:
        placement = np.asarray(each.placement.homogeneous).round(12).tolist()
        shape = each.geometry
        numbers: object = None
        if hasattr(shape, "num_tris"):
            corners = [tuple(shape.tri_indices(row)[at] for at in range(3)) for row in range(shape.num_tris)]
            numbers = (np.asarray(shape.vertices()).tolist(), corners, shape.getNumBVs())
        shapes.append((each.name, each.parentFrame, each.parentJoint, placement, shape.getNodeType(), numbers))
    return shapes


def test_shapes_are_those_that_pinocchio_reads_from_the_files(shelf: Path) -> None:
    model = pinocchio.buildModelFromXML(ROBOT)
    expected = pinocchio.buildGeomFromUrdfString(model, ROBOT, pinocchio.GeometryType.COLLISION, None, [str(shelf)])
    found = RobotModel.from_urdf(ROBOT).geometry
    assert _shown(found) == _shown(expected)
    assert sum(entry[-1] is not None for entry in _shown(found)) == 3
