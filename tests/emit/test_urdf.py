"""The emitted description, read by parsers that cellc did not write."""

from __future__ import annotations

import io
import math
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yourdfpy

from tests.cells import spec_text
from tests.emit.cells import CELLS, artifacts_of, emitted

ARM = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")


def _loaded(text: str) -> yourdfpy.URDF:
    return yourdfpy.URDF.load(io.BytesIO(text.encode()))


def _robot(cell: str, target: str) -> ElementTree.Element:
    return ElementTree.fromstring(artifacts_of(cell)[f"urdf/{cell}.{target}.urdf"])


@pytest.mark.parametrize("target", ["mock", "real"])
@pytest.mark.parametrize("cell", CELLS)
def test_tree_has_one_root_and_every_static_frame(cell: str, target: str) -> None:
    urdf = _loaded(artifacts_of(cell)[f"urdf/{cell}.{target}.urdf"])
    assert urdf.base_link == "world"
    children = [joint.child for joint in urdf.robot.joints]
    assert sorted([*children, "world"]) == sorted(link.name for link in urdf.robot.links)


def test_fixed_frames_and_scene_are_links_and_dynamic_frames_are_not() -> None:
    links = {link.get("name") for link in _robot("ur5e_pick", "mock").findall("link")}
    assert {"tcp", "fixture_A", "table"} <= links
    assert "object" not in links


def test_frames_stand_where_the_spec_puts_them() -> None:
    urdf = _loaded(artifacts_of("ur5e_pick")["urdf/ur5e_pick.mock.urdf"])
    fixture = urdf.get_transform("fixture_A", "world")
    assert fixture[:3, 3].tolist() == pytest.approx([0.45, 0.1, 0.85], abs=1e-12)
    tcp = urdf.get_transform("tcp", "gripper_base_link")
    assert tcp[:3, 3].tolist() == pytest.approx([0.0, 0.0, 0.162], abs=1e-12)


def test_velocity_limits_are_tightened_by_the_cell() -> None:
    # facts: pi rad/s for every joint of this arm; the cell allows 50 %.
    joints = {joint.get("name"): joint for joint in _robot("ur5e_pick", "real").findall("joint")}
    for name in ARM:
        limit = joints[f"arm_{name}_joint"].find("limit")
        assert limit is not None
        assert float(limit.attrib["velocity"]) == pytest.approx(math.pi / 2, abs=1e-15)


def test_mock_begins_at_home_and_real_hardware_tells_its_own_start() -> None:
    home = dict(zip(ARM, (0, -90, 90, -90, -90, 0), strict=True))
    for joint in _robot("ur5e_pick", "mock").findall("ros2_control/joint"):
        state = joint.find("state_interface[@name='position']/param[@name='initial_value']")
        assert state is not None
        assert state.text is not None
        name = joint.attrib["name"].removeprefix("arm_").removesuffix("_joint")
        if name in home:
            assert float(state.text) == pytest.approx(math.radians(home[name]), abs=1e-12)
    assert not _robot("ur5e_pick", "real").findall(".//param[@name='initial_value']")


def test_start_outside_the_limits_is_moved_to_the_limit(tmp_path: Path) -> None:
    # Observed: with an initial value outside the limits the trajectory controller dies in its first update.
    text = spec_text("minimal").replace("ready: {manipulator: 0 -90 90", "home: {manipulator: 0 -90 270", 1)
    text = text.replace("move: ready", "move: home")
    robot = ElementTree.fromstring(emitted(tmp_path, text)["urdf/minimal.mock.urdf"])
    path = "ros2_control/joint[@name='arm_elbow_joint']/state_interface[@name='position']/param"
    start = robot.find(path)
    assert start is not None
    assert float(start.text or "") == math.pi  # facts: the elbow's limit is pi


def test_targets_differ_in_hardware_alone() -> None:
    robots = [_robot("ur5e_pick", target) for target in ("mock", "real")]
    plugins = [[plugin.text for plugin in robot.findall("ros2_control/hardware/plugin")] for robot in robots]
    assert plugins[0] == ["mock_components/GenericSystem", "mock_components/GenericSystem"]
    assert plugins[1] == [
        "ur_robot_driver/URPositionHardwareInterface",
        "robotiq_driver/RobotiqGripperHardwareInterface",
    ]
    for robot in robots:
        for tag in robot.findall("ros2_control"):
            robot.remove(tag)
    assert ElementTree.tostring(robots[0]) == ElementTree.tostring(robots[1])


def test_share_folders_are_left_to_xacro() -> None:
    real = artifacts_of("ur5e_pick")["urdf/ur5e_pick.real.urdf"]
    assert "{share:" not in real
    assert "$(find ur_robot_driver)/resources/rtde_input_recipe.txt" in real


def test_real_addresses_stay_out_of_the_mock() -> None:
    assert "192.168." not in artifacts_of("ur5e_pick")["urdf/ur5e_pick.mock.urdf"]


def test_materials_of_two_devices_keep_their_colours() -> None:
    materials = {m.attrib["name"]: m for m in _robot("ur5e_pick", "mock").findall("material")}
    used = {m.attrib["name"] for m in _robot("ur5e_pick", "mock").findall("link/visual/material")}
    assert used == set(materials)
    assert {"arm_dark", "gripper_dark"} <= used
