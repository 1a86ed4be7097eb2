"""What things of the scene mean in SI, by hand; what was touched, by hand and by the singular values of numpy."""

from __future__ import annotations

import math
import random
from pathlib import Path

import numpy
import pytest

from cellc.compiler.cell.frame import Solid
from cellc.compiler.formats.urdf.elements import scene_link
from cellc.compiler.link.touched import plane_through
from cellc.robot.description.model import Cylinder, Mesh, Sphere
from tests.cells import diagnose, linked, spec_text, written

_SHAPES = """scene:
  post: {parent: world, xyz: 0 -600 400 mm, cylinder: {radius: 50 mm, length: 800 mm}}
  ball: {parent: world, xyz: 1 0 0 m, sphere: 150 mm}
  wall: {parent: world, xyz: 2 0 0 m, rpy: 0 -90 0 deg, plane: 3 m, kind: obstacle}
  jig: {parent: world, mesh: {file: "package://bench/jig.stl", unit: 1 mm}}
"""
_TOUCHED = """scene:
  bench:
    parent: world
    touched:
      shape: SHAPE
      points: POINTS
      within: 3 mm
      free: FREE
"""
# Four corners of a square of 1 m, and its middle 5 mm higher: the plane is 1 mm above the corners.
_PEAKED = "[0 0 700 mm, 1000 0 700 mm, 0 1000 700 mm, 1000 1000 700 mm, 500 500 702.5 mm]"


def _solids(folder: Path, scene: str) -> dict[str, Solid]:
    return {solid.name: solid for solid in linked(written(folder, spec_text("minimal") + scene)).scene}


def _touched(shape: str, points: str = _PEAKED, free: str = "0 0 2 m") -> str:
    return _TOUCHED.replace("SHAPE", shape).replace("POINTS", points).replace("FREE", free)


def test_each_shape_has_its_measures_in_meters(tmp_path: Path) -> None:
    solids = _solids(tmp_path, _SHAPES)
    assert solids["post"].geometry == Cylinder(0.05, 0.8)
    assert solids["ball"].geometry == Sphere(0.15)
    assert solids["jig"].geometry == Mesh("package://bench/jig.stl", (0.001, 0.001, 0.001))
    assert solids["wall"].size[:2] == (3.0, 3.0)
    assert [solid.is_plane for solid in solids.values()] == [False, False, True, False]


@pytest.mark.parametrize(
    ("thing", "point", "deep_m"),
    [
        ("post", (0.0, -0.6, 0.4), 0.05),
        ("post", (0.0, -0.6, 0.9), -0.1),
        ("post", (0.04, -0.64, 0.4), 0.05 - math.hypot(0.04, 0.04)),  # the corner of a box, outside of the round
        ("ball", (1.0, 0.0, 0.2), -0.05),
        ("wall", (1.9, 0.0, 0.0), -0.1),  # its z points to the arm, along -x
        ("wall", (2.04, 0.0, 0.0), 0.04),
    ],
)
def test_a_point_is_as_deep_in_a_shape_as_drawn(
    tmp_path: Path, thing: str, point: tuple[float, float, float], deep_m: float
) -> None:
    assert _solids(tmp_path, _SHAPES)[thing].depth_m(point) == pytest.approx(deep_m, abs=1e-9)


def test_a_plane_is_solid_behind_its_surface_in_the_description(tmp_path: Path) -> None:
    link = scene_link(_solids(tmp_path, _SHAPES)["wall"])
    origin, box = link.find("collision/origin"), link.find("collision/geometry/box")
    assert origin is not None
    assert box is not None
    depth = float(box.attrib["size"].split()[2])
    assert origin.attrib["xyz"] == f"0 0 {-depth / 2:g}"


@pytest.mark.parametrize(
    ("thing", "tag", "attributes"),
    [
        ("post", "cylinder", {"radius": "0.05", "length": "0.8"}),
        ("ball", "sphere", {"radius": "0.15"}),
        ("jig", "mesh", {"filename": "package://bench/jig.stl", "scale": "0.001 0.001 0.001"}),
    ],
)
def test_a_shape_is_seen_and_avoided_as_it_is(tmp_path: Path, thing: str, tag: str, attributes: dict[str, str]) -> None:
    link = scene_link(_solids(tmp_path, _SHAPES)[thing])
    for part in ("visual", "collision"):
        (shape,) = link.iterfind(f"{part}/geometry/*")
        assert (shape.tag, dict(shape.attrib)) == (tag, attributes)


def test_touched_points_give_the_plane_of_least_squares(tmp_path: Path) -> None:
    """The mean of the heights, because the fifth is in the middle: 0.5 mm up, 2 mm below the peak."""
    bench = _solids(tmp_path, _touched("plane"))["bench"]
    assert bench.transform_to_parent.position == pytest.approx((0.5, 0.5, 0.7005))
    assert bench.transform_to_parent.rpy() == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    assert bench.touched is not None
    assert bench.touched.largest_m == pytest.approx(0.002)
    assert bench.touched.root_mean_square_m == pytest.approx(0.001)  # of 4 times 0.5 and once 2 mm


def test_z_of_a_touched_plane_points_to_the_free_side(tmp_path: Path) -> None:
    ceiling = _solids(tmp_path, _touched("plane", free="0 0 0 m"))["bench"]
    assert ceiling.depth_m((0.5, 0.5, 0.6)) == pytest.approx(-0.1005)
    assert ceiling.depth_m((0.5, 0.5, 0.71)) == pytest.approx(0.0095)


def test_a_touched_box_holds_its_points(tmp_path: Path) -> None:
    points = "[300 0 700 mm, 500 0 700 mm, 400 -100 650 mm, 400 100 650 mm, 400 0 700 mm, 400 0 600 mm]"
    box = _solids(tmp_path, _touched("box", points))["bench"]
    assert box.size == pytest.approx((0.2, 0.2, 0.1))
    assert box.transform_to_parent.position == pytest.approx((0.4, 0.0, 0.65))
    assert box.touched is not None
    assert box.touched.largest_m == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (_touched("plane", "[0 0 0 m, 1 0 0 m, 2 0 0 m, 3 0 0 m]"), "on one line"),
        (_touched("plane", "[0 0 0 m, 1 0 0 m, 1 1 0 m, 0 1 0 m]", free="5 5 0 m"), "`free` must lie beside them"),
        (_touched("box", "[0 0 0 m, 1 0 0 m, 1 1 0 m, 0 1 0 m]"), "span a volume"),
        (_touched("plane", _PEAKED.replace("702.5", "710")), "within 3 mm of the plane, got 8 mm"),
    ],
)
def test_points_that_give_no_surface_are_refused_at_their_place(tmp_path: Path, scene: str, said: str) -> None:
    (found,) = diagnose(written(tmp_path, spec_text("minimal") + scene))
    assert (found.code, found.yaml_path[:4]) == ("touched-points-apart", ("scene", "bench", "touched", "points"))
    assert said in found.message


def test_a_plane_agrees_with_singular_values() -> None:
    """A hundred sets of points about a plane of any direction; numpy decomposes them on its own way."""
    chance = random.Random(7)
    for _ in range(100):
        axes = numpy.linalg.qr(numpy.array([[chance.gauss(0, 1) for _ in range(3)] for _ in range(3)]))[0]
        spread = [(chance.uniform(-1, 1), chance.uniform(-0.5, 0.5), chance.gauss(0, 0.002)) for _ in range(12)]
        points = [tuple(map(float, axes @ numpy.array(each) + 2.0)) for each in spread]
        about = numpy.array(points) - numpy.mean(points, axis=0)
        normal = numpy.linalg.svd(about)[2][2]
        fit = plane_through([(x, y, z) for x, y, z in points], (0.0, 0.0, 9.0))
        assert fit is not None
        x, y, z = (a - b for a, b in zip(fit.pose.apply((0.0, 0.0, 1.0)), fit.pose.position, strict=True))
        assert abs(numpy.dot(normal, (x, y, z))) == pytest.approx(1.0, abs=1e-9)
        assert fit.distances_m == pytest.approx(abs(about @ normal), abs=1e-9)


def test_a_name_of_no_shape_is_refused(tmp_path: Path) -> None:
    text = (
        spec_text("minimal") + "surroundings: {floor: {shapes: [flor]}}\nscene: {floor: {parent: world, plane: 4 m}}\n"
    )
    (found,) = diagnose(written(tmp_path, text))
    assert (found.code, found.fix and found.fix.text) == ("unknown-frame", "floor")


def test_a_mesh_that_is_not_there_or_outside_is_reported_at_its_line(tmp_path: Path) -> None:
    text = spec_text("minimal") + _SHAPES
    (found,) = (diagnosis for diagnosis in diagnose(written(tmp_path, text)) if diagnosis.code == "mesh-not-found")
    assert found.message.endswith("contact with it is not checked")
    assert found.span.line == text[: text.index("jig.stl")].count("\n") + 1
    (tmp_path / "bench").mkdir()
    (tmp_path / "bench" / "jig.stl").symlink_to("/etc/hostname")
    (found,) = (diagnosis for diagnosis in diagnose(written(tmp_path, text)) if diagnosis.code.startswith("mesh-"))
    assert found.code == "mesh-outside-root"
