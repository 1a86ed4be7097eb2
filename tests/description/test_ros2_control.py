"""Hardware components of a URDF, and the words in which hardware_interface refuses one."""

from __future__ import annotations

import pytest

from cellc.robot.description.model import Description, HardwareInterface
from cellc.robot.description.urdf_reader import read_urdf

COMPONENT = """<ros2_control name="arm_hw" type="system" rw_rate="50">
    <hardware><plugin> mock_components/GenericSystem </plugin><param name="calculate_dynamics">true</param></hardware>
    <joint name="slide">
      <command_interface name="position"><param name="min">-1</param><param name="max">2</param></command_interface>
      <state_interface name="position"><param name="initial_value">0.5</param></state_interface>
      <limits enable="false"/>
    </joint>
    <sensor name="wrist"><state_interface name="force.x" data_type="float32"/></sensor>
  </ros2_control>"""


def described(hardware: str) -> Description:
    """Return the model of a robot with one joint and the given hardware."""
    read = read_urdf(
        f"""<robot name="r"><link name="a"/><link name="b"/>
        <joint name="slide" type="prismatic"><parent link="a"/><child link="b"/></joint>{hardware}</robot>""",
        "robot_description",
    )
    assert read.value is not None
    return read.value


def test_component_is_read_with_its_parts() -> None:
    (component,) = described(COMPONENT).hardware
    assert (component.name, component.type, component.rw_rate) == ("arm_hw", "system", 50)
    assert component.plugin == "mock_components/GenericSystem"
    assert component.parameters == {"calculate_dynamics": "true"}
    (joint,), (sensor,) = component.joints, component.sensors
    assert joint.command_interfaces == (HardwareInterface("position", "double", "", "-1", "2"),)
    assert joint.state_interfaces == (HardwareInterface("position", "double", "0.5", "", ""),)
    assert not joint.limits_enabled
    assert sensor.state_interfaces[0].data_type == "float32"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<ros2_control name="arm_hw"', "<ros2_control", "no attribute 'name' in 'ros2_control' tag"),
        (
            "<plugin> mock_components/GenericSystem </plugin>",
            "",
            "Missing <plugin> tag of <hardware> element for 'arm_hw'",
        ),
        ('rw_rate="50"', 'rw_rate="fast"', 'Invalid value: "fast", expected a positive integer.'),
        ('data_type="float32"', 'size="0"', 'Got "0", but expected a non-zero positive integer.'),
    ],
)
def test_refused_component_leaves_links_and_joints_readable(old: str, new: str, message: str) -> None:
    description = described(COMPONENT.replace(old, new))
    assert message in description.hardware_error
    assert description.hardware == ()
    assert [joint.name for joint in description.joints] == ["slide"]


def test_robot_without_hardware_is_no_error() -> None:
    assert (described("").hardware, described("").hardware_error) == ((), "")


def test_links_of_a_cycle_are_unreached() -> None:
    loop = "".join(
        f'<link name="{child}"/><joint name="to_{child}" type="fixed"><parent link="{parent}"/>'
        f'<child link="{child}"/></joint>'
        for parent, child in (("d", "c"), ("c", "d"))
    )
    description = described(loop)
    assert description.roots() == ("a",)
    assert description.unreached("a") == ("c", "d")
