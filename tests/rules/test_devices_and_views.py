"""Own devices against their connection, mounts against supports, grips and views, worked out by hand."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.diagnostics import Diagnostic
from tests.cells import ROOT
from tests.rules.examples import BASE, Example, diagnose_example

DEPTH = """      view: {horizontal: 120 deg, vertical: 100 deg, nearest: 0.1 m, farthest: 5 m, source: made up}
    depth:
      topic: "/camera/{device}/depth/image"
      type: sensor_msgs/msg/Image
      info_topic: "/camera/{device}/depth/camera_info"
      frame: depth_optical
      image: {width: 1280, height: 720, bytes_per_pixel: 2, encoding: 16UC1, source: made up}
      rate: 30 Hz
      qos: default
      info_qos: default
      view: {horizontal: 120 deg, vertical: 100 deg, nearest: NEAREST, farthest: 5 m, source: made up}
"""
READ = """interfaces:
  /camera/camera/depth/image: {topic: sensor_msgs/msg/Image, from: camera, to: {move_group: {reliability: best_effort,
    depth: 1}}, wants: newest, rate: 30 Hz, max_age: 200 ms, on_stale: reject_goal}
  /camera/camera/depth/camera_info: {topic: sensor_msgs/msg/CameraInfo, from: camera, to: {move_group: {reliability:
    best_effort, depth: 1}}, wants: newest, rate: 30 Hz, max_age: 200 ms, on_stale: reject_goal}
motion: {octomap: {source: /camera/camera/depth/image, resolution: 25 mm, range: 2 m, padding: 30 mm}}
"""


def own(folder: Path, name: str, *pairs: tuple[str, str]) -> None:
    """Copy a device of the base, with some of its texts replaced."""
    shutil.copytree(BASE / name, folder / name)
    for file in (file for file in (folder / name).iterdir() if file.is_file()):
        text = file.read_text(encoding="utf-8")
        for old, new in pairs:
            text = text.replace(old, new)
        file.write_text(text, encoding="utf-8")


def with_depth(folder: Path, nearest: str) -> None:
    link = '<link name="color_optical"/>'
    joint = '<joint name="optical" type="fixed">'
    other = '<link name="depth_optical"/><joint name="depth" type="fixed"><parent link="link"/><child '
    other += 'link="depth_optical"/><origin rpy="-1.5707963 0 -1.5707963"/></joint>'
    own(
        folder,
        "demo_camera",
        (link, link + other),
        (joint, joint),
        ("color_optical: color_optical}", "color_optical: color_optical, depth_optical: depth_optical}"),
        ("optical_frames: [color_optical]", "optical_frames: [color_optical, depth_optical]"),
        ("      info_qos: default\n", "      info_qos: default\n" + DEPTH.replace("NEAREST", nearest)),
    )


def found(text: str, folder: Path) -> list[Diagnostic]:
    return list(diagnose_example(Example("yaml", text), folder))


def codes(text: str, folder: Path) -> list[str]:
    return sorted(item.code for item in found(text, folder))


@pytest.mark.parametrize(
    ("literal", "said"),
    [
        ("192.168.56.102", "must be the address of the connection, 192.168.56.101, got 192.168.56.102"),
        ("192.168.56.101", ""),
        ("{address}", ""),
        ("{port}", "needs the port of the connection, which states none"),
    ],
)
def test_a_plugin_is_told_the_address_of_its_connection(literal: str, said: str, tmp_path: Path) -> None:
    own(tmp_path, "demo_arm", ("{address}", literal))
    wrong = [item for item in found("cell: demo", tmp_path) if item.code == "parameter-against-connection"]
    assert [said in item.message for item in wrong] == ([True] if said else [])
    assert all(related.span.file.endswith("device.yaml") for item in wrong for related in item.related)


@pytest.mark.parametrize(
    ("kept", "line"),
    [("  acceleration: {joint_1: {value: 5 rad/s^2, source: made up}}\n", "  acceleration:"), ("", "limits:")],
)
def test_what_an_own_device_lacks_is_shown_in_its_file(kept: str, line: str, tmp_path: Path) -> None:
    own(tmp_path, "demo_arm", ('  acceleration: {"*": {value: 5 rad/s^2, source: made up}}\n', kept))
    lines = (tmp_path / "demo_arm" / "device.yaml").read_text(encoding="utf-8").splitlines()
    wrong = [item for item in found("cell: demo", tmp_path) if item.code == "unplannable-joint"]
    shown = {item.span.line for finding in wrong for item in finding.related if item.span.file.endswith("device.yaml")}
    assert [lines[number - 1].startswith(line) for number in shown] == [True]


def test_what_is_found_at_an_own_model_names_its_file(tmp_path: Path) -> None:
    own(tmp_path, "demo_arm", ("laws: [{loop: position, source: made up}]\n", ""))
    unknown = [item for item in found("cell: demo", tmp_path) if item.code == "unknown-control-law"]
    assert [(item.span.file[-11:], item.span.line) for found in unknown for item in found.related] == [
        ("device.yaml", 2)
    ]


@pytest.mark.parametrize(
    ("box", "said"),
    [
        # The foot is at 0.8 m.
        ("xyz: 0 0 0.395 m, box: 0.3 0.3 0.79 m", ""),
        ("xyz: 0 0 0.405 m, box: 0.3 0.3 0.81 m", "must end at the foot of `arm`, got 10 mm above it"),
        ("xyz: 0 0 0.85 m, box: 0.3 0.3 0.02 m", "must end at the foot of `arm`, got 60 mm above it"),
        ("xyz: 0 0 0.2 m, box: 0.3 0.3 0.4 m", "must carry `arm`, got 400 mm between it and the foot"),
        ("xyz: 1 0 0.2 m, box: 0.3 0.3 0.4 m", ""),
    ],
)
def test_a_support_ends_at_the_foot(box: str, said: str, tmp_path: Path) -> None:
    scene = f"scene: {{pedestal: {{parent: world, {box}}}}}"
    wrong = [item.message for item in found(scene, tmp_path) if item.code == "foot-off-its-support"]
    assert [said in message for message in wrong] == ([True] if said else [])


@pytest.mark.parametrize(
    ("payload", "code"),
    [
        # 0.8 kg at the root of the gripper and 0.1 kg of camera 70 mm aside: 0 -8 3 mm; its fingers are 100 mm away.
        ("center_of_mass: 90 0 0 mm", "implausible-center-of-mass"),
        ("center_of_mass: 0 0 120 mm", "implausible-center-of-mass"),
        ("center_of_mass: 0 0 40 mm", ""),
        ("inertia: 0 0 0 0 0 0 kg m^2", "implausible-mass"),
    ],
)
def test_a_payload_is_that_of_its_tools(payload: str, code: str, tmp_path: Path) -> None:
    assert codes(f"devices: {{arm: {{payload: {{mass: 1.0 kg, {payload}}}}}}}", tmp_path) == ([code] if code else [])


@pytest.mark.parametrize(
    ("text", "code"),
    [
        # The fingers open to 80 mm over a part of 60 mm: 10 mm to each side, and a quarter more.
        ("uncertainty: {tolerances: {pick: 13 mm, place: 3 mm}}", "implausible-grip"),
        ("uncertainty: {tolerances: {pick: 12 mm, place: 3 mm}}", ""),
        # 1 mm of the joint are 2 mm of the jaws.
        ("frames: {object: {grasp: {width: 60 mm, tolerance: 0.9 mm, mass: 0.2 kg}}}", "implausible-grip"),
        ("frames: {object: {grasp: {width: 60 mm, tolerance: 16 mm, mass: 0.2 kg}}}", "implausible-grip"),
        ("control: {controllers: {gripper_action: {parameters: {stall_timeout: 0.01}}}}", "implausible-grip"),
        ("control: {controllers: {gripper_action: {parameters: {goal_tolerance: 0.005}}}}", "implausible-grip"),
        (
            "control: {controllers: {gripper_action: {parameters: {stall_velocity_threshold: 0.04}}}}",
            "implausible-grip",
        ),
        ("control: {controllers: {gripper_action: {parameters: {stall_velocity_threshold: 0.02}}}}", ""),
    ],
)
def test_grips_are_what_the_gripper_tells(text: str, code: str, tmp_path: Path) -> None:
    assert codes(text, tmp_path) == ([code] if code else [])


def test_a_note_on_a_parameter_hides_no_bound(tmp_path: Path) -> None:
    text = "control: {controllers: {gripper_action: {parameters: {max_effort: 500.0}}}}"
    own(tmp_path, "demo_gripper")
    assert "implausible-grip" in codes(text, tmp_path)


@pytest.mark.parametrize(("nearest", "said"), [("0.1 m", []), ("0.6 m", [True])])
def test_a_part_is_beyond_the_least_distance_of_depth(nearest: str, said: list[bool], tmp_path: Path) -> None:
    with_depth(tmp_path, nearest)
    views = [item for item in found(READ, tmp_path) if item.code == "implausible-view"]
    assert ["`/camera/camera/depth/image`" in item.message for item in views] == said


@pytest.mark.parametrize(
    ("old", "new", "codes_"),
    [
        ("range: 2 m", "range: 7 m", ["implausible-view"]),
        ("resolution: 25 mm", "resolution: 110 mm", ["implausible-view"]),
        ("padding: 30 mm", "padding: 4 mm", ["implausible-view"]),
        ("depth/image, resolution", "color/image_raw, resolution", ["unfed-octomap"]),
    ],
)
def test_a_map_is_what_its_camera_sees(old: str, new: str, codes_: list[str], tmp_path: Path) -> None:
    with_depth(tmp_path, "0.1 m")
    wrong = codes(READ.replace(old, new), tmp_path)
    assert [code for code in wrong if code in ("implausible-view", "unfed-octomap")] == codes_


def test_a_region_is_within_the_view(tmp_path: Path) -> None:
    with_depth(tmp_path, "0.1 m")
    wide = "regions: {object: {box: 2000 60 0 mm}}\nuncertainty: {tolerances: {pick: 4 mm, place: 3 mm}}\n"
    messages = [item.message for item in found(wide, tmp_path) if item.code == "implausible-view"]
    assert ["the range of the part must be at most" in message for message in messages] == [True]


@pytest.mark.parametrize(("speed", "codes_"), [("1 Gbit/s", []), ("100 Mbit/s", ["images-beyond-link"])])
def test_a_camera_with_an_address_sends_its_images_to_its_card(speed: str, codes_: list[str], tmp_path: Path) -> None:
    # 1280 by 720 pixels of one byte on the wire, 30 times a second: 221 Mbit/s.
    text = "devices: {camera: {connection: {address: 10.10.0.20}}}\n"
    text += f"hosts: {{control_pc: {{nics: {{bulk: {{speed: {speed}}}}}}}}}"
    assert codes(text, tmp_path) == codes_


def test_a_calibration_is_finer_than_the_goal_that_rests_on_it(tmp_path: Path) -> None:
    text = "uncertainty: {tolerances: {pick: 0.5 mm, place: 3 mm}}"
    (one,) = [item for item in found(text, tmp_path) if item.code == "coarse-calibration"]
    assert one.message == "the residual of `hand_eye` must be at most 0.5 mm, got 0.8 mm"


def test_an_axis_is_not_posed_a_hair_from_zero(tmp_path: Path) -> None:
    cell = (ROOT / "cells" / "rail_arm" / "cell.yaml").read_text(encoding="utf-8")
    assert cell.count("at_press: {rail_and_arm: 0 mm") == 1
    file = tmp_path / "cell.yaml"
    file.write_text(cell.replace("at_press: {rail_and_arm: 0 mm", "at_press: {rail_and_arm: 1 mm"), encoding="utf-8")
    messages = [item.message for item in check(file) if item.code == "implausible-size"]
    assert ["way of 2 m, got 1 mm" in message for message in messages] == [True]


BODY = """<link name="base"><inertial>ORIGIN<mass value="2"/><inertia ixx="MOMENT" ixy="0" ixz="0" iyy="MOMENT" iyz="0"
 izz="MOMENT"/></inertial><collision><geometry><box size="1 0.2 0.2"/></geometry></collision></link>"""


@pytest.mark.parametrize(
    ("moment", "origin", "said"),
    [
        ("0.1", '<origin xyz="0.4 0 0"/>', ""),
        ("0", "", "the radius of gyration must be at least 1 mm"),
        ("0.1", '<origin xyz="0 0 0.7"/>', "the center of mass beside the shapes"),
    ],
)
def test_bodies_have_their_mass_within_their_shapes(moment: str, origin: str, said: str, tmp_path: Path) -> None:
    body = BODY.replace("MOMENT", moment).replace("ORIGIN", origin)
    own(tmp_path, "stage", ('<link name="base"/>', body))
    text = "devices: {copy: {model: ./stage, mount: {parent: world, xyz: 0 3 0 m}, revision: A, firmware: stage 1.0.0}}"
    (tmp_path / "stage").rename(tmp_path / "own_stage")
    wrong = found(text.replace("./stage", "./own_stage"), tmp_path)
    messages = [item.message for item in wrong if item.code == "implausible-description"]
    assert [said in message for message in messages] == ([True] if said else [])


@pytest.mark.parametrize(
    ("axis", "codes_"),
    [("1 0 0", []), ("-1 0 0", ["implausible-description"]), ("0 1 0", ["implausible-description"])],
)
def test_a_carriage_stays_on_its_rail(axis: str, codes_: list[str], tmp_path: Path) -> None:
    # 1 m of rail about its middle; the carriage begins at the left end of it, and goes 0.5 m.
    rail = '<link name="base"><collision><geometry><box size="1 0.2 0.2"/></geometry></collision></link>'
    slide = '<child link="carriage"/> <origin xyz="-0.5 0 0"/> <axis xyz="AXIS"/>'.replace("AXIS", axis)
    old = '<child link="carriage"/> <axis xyz="0 0 1"/>'
    own(tmp_path, "stage", ('<link name="base"/>', rail), (old, slide), ("kind: arm", "kind: axis"))
    (tmp_path / "stage").rename(tmp_path / "own_stage")
    text = "devices: {copy: {model: ./own_stage, mount: {parent: world, xyz: 0 3 0 m}, revision: A, firmware: s 1.0}}"
    wrong = found(text, tmp_path)
    assert [item.code for item in wrong if "carriage" in item.message] == codes_
