"""Images of cameras: depth and pixels by hand, encodings as REP 118 has them, and the bag that holds them."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from cellc.contract.devices import ContractImages
from cellc.contract.transforms import Pose, from_xyz_rpy, identity
from cellc.mock import MockCell
from cellc.mock.command.evidence import recorded
from cellc.mock.evidence.images.photographer import painted, pixels
from cellc.mock.evidence.images.rays import BACKGROUND, Body, Pinhole, Solid, View, pinhole, seen
from cellc.mock.world.world import link_tree
from cellc.robot.description.model import Box, Cylinder, Mesh, Sphere
from cellc.robot.description.urdf_reader import read_urdf
from tests.cells import generated
from tests.cli.run import run
from tests.mock.conftest import received, stamp_ns

RED = (1.0, 0.0, 0.0)
CAMERA = Pinhole(161, 121, 100.0)
"""With a pixel on the optical axis: 80, 60."""


def _stream(encoding: str) -> ContractImages:
    return ContractImages(
        topic="/camera/depth/image",
        info_topic="/camera/depth/camera_info",
        frame="camera_depth_optical_frame",
        width=161,
        height=121,
        encoding=encoding,
        horizontal=1.2,
        vertical=1.0,
        nearest_m=0.1,
        farthest_m=2.0,
    )


def _seen(shape: Solid, pose: Pose) -> View:
    return seen(CAMERA, [Body(shape, pose, RED)])


def _at(z: float, x: float = 0.0, y: float = 0.0) -> Pose:
    return Pose((x, y, z), (0.0, 0.0, 0.0, 1.0))


@pytest.mark.parametrize(
    ("shape", "pose"),
    [
        (Box((0.2, 0.2, 0.1)), _at(0.55)),
        (Box((0.1, 0.2, 0.2)), from_xyz_rpy((0.0, 0.0, 0.55), (0.0, math.pi / 2, 0.0))),
        (Sphere(0.1), _at(0.6)),
        (Cylinder(0.1, 0.3), from_xyz_rpy((0.0, 0.0, 0.6), (math.pi / 2, 0.0, 0.0))),
        (Cylinder(0.2, 0.2), _at(0.6)),
        (Cylinder(0.2, 0.2), from_xyz_rpy((0.0, 0.0, 0.6), (math.pi, 0.0, 0.0))),
    ],
    ids=str,
)
def test_a_face_half_a_meter_away_is_500_mm_at_the_center(shape: Solid, pose: Pose) -> None:
    view = _seen(shape, pose)
    assert view.depth[60, 80] == pytest.approx(0.5)
    assert pixels(view, _stream("16UC1"))[60, 80] == 500
    assert pixels(view, _stream("32FC1"))[60, 80] == np.float32(0.5)
    assert view.color[60, 80] == pytest.approx(RED)  # looked at squarely
    assert math.isinf(view.depth[0, 0])
    assert view.color[0, 0] == pytest.approx(BACKGROUND)


def test_depth_is_along_the_axis_and_not_along_the_ray() -> None:
    view = _seen(Box((2.0, 2.0, 0.1)), _at(0.55))
    assert np.ptp(view.depth) < 1e-12
    assert view.depth[0, 0] == pytest.approx(0.5)
    # Its face is looked at from the side there: 80 and 60 pixels at a focal length of 100.
    slope = 100.0 / math.hypot(100.0, 80.0, 60.0)
    assert view.color[0, 0, 0] == pytest.approx(0.35 + 0.65 * slope)


def test_a_known_point_is_where_the_projection_of_a_pinhole_puts_it() -> None:
    view = _seen(Sphere(0.004), _at(0.8, x=0.2, y=-0.12))
    rows, columns = np.nonzero(np.isfinite(view.depth))
    assert (columns.mean(), rows.mean()) == pytest.approx((80 + 100 * 0.2 / 0.8, 60 - 100 * 0.12 / 0.8), abs=0.01)


def test_the_nearer_of_two_is_seen_and_what_is_behind_or_around_the_camera_is_not() -> None:
    near, far = Body(Box((0.1, 0.1, 0.1)), _at(0.5), RED), Body(Box((0.4, 0.4, 0.1)), _at(0.9), (0.0, 1.0, 0.0))
    for order in ((near, far), (far, near)):
        view = seen(CAMERA, order)
        assert view.depth[60, 80] == pytest.approx(0.45)
        assert view.depth[60, 60] == pytest.approx(0.85)
    for unseen in (Body(Box((0.1, 0.1, 0.1)), _at(-0.5), RED), Body(Box((0.1, 0.1, 0.1)), identity(), RED)):
        assert not np.isfinite(seen(CAMERA, [unseen]).depth).any()


def test_a_cylinder_is_no_longer_than_it_is() -> None:
    view = _seen(Cylinder(0.1, 0.1), from_xyz_rpy((0.0, 0.0, 0.6), (math.pi / 2, 0.0, 0.0)))
    assert np.isfinite(view.depth[60 - 9, 80])
    assert math.isinf(view.depth[60 - 11, 80])


def test_what_is_too_near_or_too_far_is_told_as_the_encoding_has_it() -> None:
    for z, whole, real in ((0.1, 0, -np.inf), (2.5, 0, np.inf)):
        view = _seen(Box((1.0, 1.0, 0.1)), _at(z))
        assert pixels(view, _stream("16UC1"))[60, 80] == whole
        assert pixels(view, _stream("32FC1"))[60, 80] == real


def test_colors_come_in_the_order_of_the_encoding() -> None:
    view = _seen(Box((0.2, 0.2, 0.1)), _at(0.55))
    assert pixels(view, _stream("rgb8"))[60, 80].tolist() == [255, 0, 0]
    assert pixels(view, _stream("bgr8"))[60, 80].tolist() == [0, 0, 255]
    assert pixels(view, _stream("mono8"))[60, 80] == 85


def test_an_image_is_scaled_by_a_whole_factor_and_sees_no_more_than_the_sensor() -> None:
    camera = pinhole(640, 480, math.radians(69.0), math.radians(42.0), 160)
    assert (camera.width, camera.height, camera.center) == (160, 120, (79.5, 59.5))
    assert 2 * math.degrees(math.atan(60 / camera.focal)) == pytest.approx(42.0)
    assert 2 * math.degrees(math.atan(80 / camera.focal)) < 69.0


def test_meshes_are_boxes_where_they_are_there_and_else_what_collides_is_drawn(tmp_path: Path) -> None:
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 0.2 0 0\nv 0 0.1 0\nv 0 0 0.4\nf 1 2 3\nf 1 2 4\n", encoding="utf-8")
    urdf = """<robot name="r"><link name="a"><visual><geometry><mesh filename="part.obj"/></geometry></visual>
      <collision><geometry><sphere radius="0.3"/></geometry></collision></link></robot>"""
    read = read_urdf(urdf, (tmp_path / "r.urdf").as_posix())
    assert read.value is not None
    (shape,) = painted(read.value, ())
    assert shape.shape == Sphere(0.3)
    (link,) = read.value.links
    assert isinstance(link.visuals[0].geometry, Mesh)
    whole = urdf.replace("part.obj", (tmp_path / "part.obj").as_posix())
    found = read_urdf(whole, (tmp_path / "r.urdf").as_posix()).value
    assert found is not None
    (shape,) = painted(found, (tmp_path,))
    assert isinstance(shape.shape, Box)
    assert shape.shape.size == pytest.approx((0.2, 0.1, 0.4))
    assert shape.pose.position == pytest.approx((0.1, 0.05, 0.2))


def test_a_bag_with_images_has_each_delivery_with_its_stamp_and_intrinsics(tmp_path: Path, cell: MockCell) -> None:
    entry, file = cell.entry("stale_camera"), tmp_path / "run.mcap"
    with file.open("wb") as opened:
        with_images, _ = recorded(cell, entry, opened, 0, images=True)
    with (tmp_path / "plain.mcap").open("wb") as opened:
        assert recorded(cell, entry, opened, 0)[0] == with_images  # who looks changes nothing
    images = tuple(received(file, "/camera/color/image_raw"))
    infos = tuple(received(file, "/camera/color/camera_info"))
    depths = tuple(received(file, "/camera/depth/image_rect_raw"))
    assert len(images) == len(infos) == len(depths) > 50
    first, info, depth = images[0].message, infos[0].message, depths[0].message
    assert (first.width, first.height, first.encoding, first.step, len(first.data)) == (160, 120, "rgb8", 480, 57_600)
    assert (depth.encoding, depth.step, len(depth.data)) == ("16UC1", 320, 38_400)
    assert first.header.frame_id == "camera_color_optical_frame"
    assert (info.k[2], info.k[5], info.k[0]) == pytest.approx((79.5, 59.5, 60 / math.tan(math.radians(21.0))))
    assert info.p.reshape(3, 4)[:, :3].tolist() == info.k.reshape(3, 3).tolist()
    assert [stamp_ns(each.message.header) for each in images] == [stamp_ns(each.message.header) for each in infos]
    # Frozen 2 s after the start, the camera repeats its last image with its old stamp.
    assert images[-1].message.data.tobytes() == images[-2].message.data.tobytes()
    assert stamp_ns(images[-1].message.header) == stamp_ns(images[-2].message.header)


def test_depth_at_the_middle_is_the_distance_to_the_table_by_forward_kinematics(tmp_path: Path, cell: MockCell) -> None:
    file = tmp_path / "run.mcap"
    with file.open("wb") as opened:
        recorded(cell, cell.entry("stale_camera"), opened, 0, images=True)
    first = next(iter(received(file, "/camera/depth/image_rect_raw"))).message
    depth = first.data.view("<u2").reshape(120, 160)[60, 80]
    home = json.loads((generated("ur5e_pick") / "contract.json").read_text(encoding="utf-8"))["poses"]["home"][0]
    joints = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
    positions = dict(zip((f"arm_{each}_joint" for each in joints), home["positions"], strict=True))
    camera = link_tree(cell.folder.description).pose("camera_depth_optical_frame", positions)
    ahead = camera.apply((0.0, 0.0, 1.0))[2] - camera.position[2]
    # The top of the table is at 0.8 m; the middle pixel is half a pixel off the axis.
    assert depth / 1e3 == pytest.approx((0.8 - camera.position[2]) / ahead, rel=0.02)


def test_images_need_a_bag() -> None:
    ran = run("mock", generated("ur5e_pick").as_posix(), "--images")
    assert ran.code == 2
    assert "--images needs --evidence" in ran.err


def test_a_camera_without_a_known_view_has_no_image(cell: MockCell) -> None:
    (device,) = (each for each in cell.contract.devices.values() if each.camera is not None)
    assert device.camera is not None
    assert [each.encoding for each in device.camera.images] == ["rgb8", "16UC1"]
