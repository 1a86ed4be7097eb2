"""Meshes on the page: those to look at where they are at hand, as fine as a page may weigh, and told what is shown."""

from __future__ import annotations

import base64
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from cellc.tools.view.meshes import coarsened
from tests.cli.run import run
from tests.robustness.fuzz.meshes import binary_stl
from tests.view.page import Page

_LINK = """
  <link name="{name}">
    <visual><geometry><mesh filename="package://bench/{name}.stl" scale="0.001 -0.001 0.001"/></geometry></visual>
    <collision><geometry>{collision}</geometry></collision>
  </link>"""
_JOINT = """
  <joint name="{name}_mount" type="fixed"><parent link="seen"/><child link="{name}"/></joint>"""


def _robot(folder: Path) -> Path:
    """Write a robot of three links: the mesh of the first is there, those of the others are not."""
    (folder / "bench").mkdir()
    (folder / "bench/package.xml").write_text("<package><name>bench</name></package>", encoding="utf-8")
    (folder / "bench/seen.stl").write_bytes(binary_stl(1000.0))
    box, missing = '<box size="0.1 0.1 0.1"/>', '<mesh filename="package://bench/hull.stl"/>'
    links = "".join(
        _LINK.format(name=name, collision=shape) for name, shape in (("seen", box), ("boxed", box), ("bare", missing))
    )
    joints = "".join(_JOINT.format(name=name) for name in ("boxed", "bare"))
    file = folder / "bench/robot.urdf"
    file.write_text(f'<robot name="bench">{links}{joints}\n</robot>\n', encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Page:
    folder = tmp_path_factory.mktemp("meshes")
    ran = run("view", _robot(folder).as_posix(), "-o", (folder / "x.html").as_posix())
    assert ran.err == ""
    return Page((folder / "x.html").read_text(encoding="utf-8"))


def _unpacked(text: str) -> NDArray[np.uint16]:
    return np.frombuffer(base64.b64decode(text), dtype="<u2").reshape(-1, 3)


def test_a_link_is_drawn_with_its_mesh_where_that_is_at_hand(page: Page) -> None:
    scene: Any = page.data["scene"]
    shapes = {shape["link"]: (shape["kind"], shape["size"]) for shape in scene["shapes"]}
    assert shapes == {"seen": ("mesh", [0]), "boxed": ("box", [0.1, 0.1, 0.1])}
    (mesh,) = scene["meshes"]
    points = np.array(mesh["low"]) + mesh["step"] * _unpacked(mesh["vertices"])
    # By hand: a corner of a cube of 4 cm, written in mm, mirrored at y.
    written = {(0, 0, 0), (0.04, 0, 0), (0, -0.04, 0), (0, 0, 0.04)}
    assert {tuple(np.round(point, 3) + 0.0) for point in points} == written
    assert _volume(points, _unpacked(mesh["triangles"])) == pytest.approx(0.04**3 / 6, rel=2e-3)


def test_the_page_tells_which_shapes_are_drawn_and_what_is_missing(page: Page) -> None:
    assert page.data["scene"]["kinds"] == ["visual meshes and collision shapes"]
    assert "shapes of 1 link of robot mesh `package://bench/hull.stl` could not be found" in page.text


def test_a_fine_mesh_keeps_its_form_with_few_triangles() -> None:
    # A cube of 1 m whose faces have 40 x 40 squares: 19,200 triangles.
    vertices: list[NDArray[np.float64]] = []
    triangles: list[tuple[int, int, int]] = []
    for axis, side in product(range(3), (0.0, 1.0)):
        corner = len(vertices)
        for i, j in product(range(41), repeat=2):
            vertices.append(np.roll([side, i / 40, j / 40], axis))
        for i, j in product(range(40), repeat=2):
            a = corner + 41 * i + j
            two = [(a, a + 41, a + 42), (a, a + 42, a + 1)]
            triangles += two if side else [one[::-1] for one in two]
    points, few = coarsened(np.array(vertices), np.array(triangles), 1500)
    assert 400 < len(few) <= 1500
    assert _volume(points, few) == pytest.approx(1.0, abs=0.12)
    assert np.ptp(points, axis=0) == pytest.approx((1.0, 1.0, 1.0), abs=0.06)


def _volume(points: NDArray[np.float64], triangles: NDArray[Any]) -> float:
    """Return what closed triangles hold, positive where they are seen from outside against the clock."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return float((a * np.cross(b, c)).sum() / 6)
