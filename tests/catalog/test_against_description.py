"""What a device.yaml says other than the description beside it, and figures of cameras and grippers that contradict."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.catalog.load import device_names, read_device
from cellc.compiler.pipeline import judge
from tests.catalog.test_own_devices import DEVICE as JAWS_DEVICE
from tests.catalog.test_own_devices import JAWS

JOINT = """<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
<origin xyz="0 0 0.3"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="3" effort="50"/></joint>
"""
HAS = '<command_interface name="position"/><state_interface name="position"/>'
ARM = (
    '<robot name="arm"><link name="base"/><link name="upper"/><link name="lower"/><link name="tool"/>\n'
    + JOINT.format(name="first", parent="base", child="upper")
    + JOINT.format(name="second", parent="upper", child="lower")
    + '<joint name="flange" type="fixed"><parent link="lower"/><child link="tool"/></joint>\n'
    + '<ros2_control name="arm" type="system"><hardware><plugin>acme/Arm</plugin></hardware>\n'
    + f'<joint name="first">{HAS}</joint>\n<joint name="second">{HAS}</joint></ros2_control></robot>\n'
)
DEVICE = """format: 1
model: arm
vendor: demo
summary: two joints
kind: arm
as_of: 2026-08-01
sources: [manual]
description: {file: arm.urdf}
base: base
frames: {base: base}
tool_frame: tool
limits:
  position: {first: {lower: -2 rad, upper: 2 rad, source: manual}}
  velocity: {"*": {value: 3 rad/s, source: manual}}
  effort: {second: {value: 50 N m, source: manual}}
packages: {}
control:
  component: arm
  hardware:
    real: {plugin: acme/Arm, source: manual}
    mock: {plugin: mock_components/GenericSystem, source: manual}
  joints:
    "*": {command: [position], state: [position]}
"""
CAMERA_ROBOT = """<robot name="eye"><link name="case"/><link name="optical"/>
<joint name="to" type="fixed"><parent link="case"/><child link="optical"/>
<origin rpy="-1.5707963 0 -1.5707963"/></joint></robot>
"""
CAMERA = """format: 1
model: eye
vendor: demo
summary: a camera
kind: camera
as_of: 2026-08-01
sources: [manual]
description: {file: eye.urdf}
base: case
frames: {case: case, optical: optical}
optical_frames: [optical]
packages: {}
camera:
  hardware_clock: false
  exposure: 8 ms
  source: manual
  streams:
    color:
      topic: /eye/image
      type: sensor_msgs/msg/Image
      info_topic: /eye/info
      frame: optical
      rate: 30 Hz
      qos: default
      info_qos: default
      image: {width: 1280, height: 720, bytes_per_pixel: 3, encoding: rgb8, source: manual}
      view: {horizontal: 69 deg, vertical: 42 deg, nearest: 0.1 m, farthest: 5 m, source: manual}
"""


def found(folder: Path, robot: str, device: str) -> list[tuple[str, int, str, list[int]]]:
    """Return the findings of the code that the catalog stage has for figures: code, line, message, related lines."""
    name = device.partition("description: {file: ")[2].partition("}")[0]
    (folder / name).write_text(robot, encoding="utf-8")
    (folder / "device.yaml").write_text(device, encoding="utf-8")
    codes = ("device-against-description", "implausible-fact", "gripper-against-description")
    return [
        (item.code, item.span.line, item.message, [related.span.line for related in item.related])
        for item in judge(folder / "device.yaml")
        if item.code in codes
    ]


def line(text: str, part: str) -> int:
    return text.partition(part)[0].count("\n") + 1


@pytest.mark.parametrize(("robot", "device"), [(ARM, DEVICE), (CAMERA_ROBOT, CAMERA), (JAWS, JAWS_DEVICE)])
def test_sound_devices_have_no_finding(robot: str, device: str, tmp_path: Path) -> None:
    assert found(tmp_path, robot, device) == []


def test_no_device_of_the_catalog_contradicts_its_description() -> None:
    assert [str(item) for name in device_names() for item in read_device(name).diagnostics] == []


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("lower: -2 rad, upper", "lower: -180 deg, upper", "at least that of its description, -2 rad, got -180 deg"),
        ("upper: 2 rad", "upper: 2.1 rad", "at most that of its description, 2 rad, got 2.1 rad"),
        ("value: 3 rad/s", "value: 180 deg/s", "at most that of its description, 3 rad/s, got 180 deg/s"),
        ("value: 50 N m", "value: 60 N m", "at most that of its description, 50 N m, got 60 N m"),
        ("command: [position]", "command: [position, effort]", "the command interface `effort` must be one"),
        ("state: [position]", "state: [position, velocity]", "the state interface `velocity` must be one"),
        ("real: {plugin: acme/Arm", "real: {plugin: acme/Arm6", "must be that of `<ros2_control>`"),
        ("base: base\nframes", "base: upper\nframes", "got `upper`, which hangs on `base`"),
        ("tool_frame: tool", "tool_frame: upper", "the last joint of the arm, `second`, got `upper`"),
    ],
)
def test_a_device_that_contradicts_its_description_is_reported_there(
    old: str, new: str, said: str, tmp_path: Path
) -> None:
    device = DEVICE.replace(old, new)
    assert device != DEVICE
    (one,) = found(tmp_path, ARM, device)
    assert one[0] == "device-against-description"
    assert said in one[2]
    assert one[1] == line(device, new.partition("\n")[0])
    assert one[3]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (f'<joint name="second">{HAS}</joint>', "", "`second` must be a joint of `<ros2_control>`"),
        (
            f'<joint name="first">{HAS}',
            '<joint name="first"><command_interface name="position"><param name="max">2.5</param></command_interface>'
            '<state_interface name="position"/>',
            "`position` of `first` in `<ros2_control>` must keep within -2 to 2 rad of its joint",
        ),
        ('<parent link="lower"/>', '<parent link="upper"/>', "`tool_frame` must hang on the last joint"),
    ],
)
def test_a_description_that_contradicts_its_device_is_related(old: str, new: str, said: str, tmp_path: Path) -> None:
    robot = ARM.replace(old, new)
    assert robot != ARM
    (one,) = found(tmp_path, robot, DEVICE)
    assert said in one[2]
    where = new[:22] if new else "<ros2_control"
    assert line(robot, where) in one[3] or line(robot, '<joint name="flange"') in one[3]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("bytes_per_pixel: 3", "bytes_per_pixel: 2", "must be 3, as `rgb8` has, got 2"),
        ("horizontal: 69 deg", "horizontal: 1.2 deg", "must have the shape of the images"),
        ("width: 1280, height: 720", "width: 720, height: 1280", "must have the shape of the images, 720 by 1280"),
        ("frame: optical", "frame: case", "must be one of `optical_frames`, got `case`"),
        ("info_topic: /eye/info", "info_topic: /eye/image", ""),
        ("exposure: 8 ms", "exposure: 40 ms", "must be below the period of `color`, 33.3 ms, got 40 ms"),
        ("type: sensor_msgs/msg/Image", "type: sensor_msgs/msg/PointCloud2", "must be that of an image"),
    ],
)
def test_streams_that_contradict_are_reported(old: str, new: str, said: str, tmp_path: Path) -> None:
    device = CAMERA.replace(old, new)
    assert device != CAMERA
    findings = found(tmp_path, CAMERA_ROBOT, device)
    if not said:  # one stream may name one topic twice: that is a matter of its types
        assert findings == []
        return
    ((_, at, message, related),) = findings
    assert said in message
    assert line(device, new) in (at, *related)


def test_two_streams_have_topics_of_their_own(tmp_path: Path) -> None:
    head, _, color = CAMERA.partition("    color:\n")
    device = f"{head}    color:\n{color}    depth:\n{color.replace('/eye/info', '/eye/depth_info')}"
    ((_, at, message, related),) = found(tmp_path, CAMERA_ROBOT, device)
    assert message == "`topic` of `depth` must be a topic of its own, got that of `color`"
    assert related == [line(device, "topic: /eye/image")]
    assert at > related[0]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "closed: 0 mm",
            "closed: -5 mm",
            "`closed` must lie within the limits of `left_joint`, 0 to 0.04 m, got -5 mm",
        ),
        ("open: 40 mm", "open: 45 mm", "`open` must lie within the limits of `left_joint`, 0 to 0.04 m, got 45 mm"),
        ("goal_tolerance: 0.5 mm", "goal_tolerance: 5 mm", "at most a tenth of the way of the joint, got 5 mm"),
        # 0.1 m/s of the joint, and two jaws of it.
        ("max_speed: 0.2 m/s", "max_speed: 1 m/s", "with which the jaws have 0.2 m/s, got 1 m/s"),
        ("max_force: 60 N", "max_force: 600 N", "60 N for each jaw, got 600 N"),
    ],
)
def test_figures_of_a_gripper_fit_its_joint(old: str, new: str, said: str, tmp_path: Path) -> None:
    device = JAWS_DEVICE.replace(old, new)
    assert device != JAWS_DEVICE
    (one,) = found(tmp_path, JAWS, device)
    assert said in one[2]
    assert one[1] == line(device, new)


def test_a_gripper_is_driven_by_the_joint_that_leads(tmp_path: Path) -> None:
    device = JAWS_DEVICE.replace("  joint: left_joint", "  joint: right_joint")
    messages = [message for _, _, message, _ in found(tmp_path, JAWS, device)]
    assert "`joint` must be the one that is driven, got `right_joint`, which follows `left_joint`" in messages
