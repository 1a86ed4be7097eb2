"""The one reader of URDF: what it takes, refuses, and changes to the letter."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from cellc.contract.diagnostics import Diagnostic, Span
from cellc.robot.description.model import Box, Cylinder, Description, HardwareInterface, Mesh, Sphere
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.xml_tree import with_values
from tests.cells import there
from tests.properties import given, settings, st

ROBOT = """<?xml version="1.0"?>
<robot name="r">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="a">
    <inertial>
      <origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
      <mass value="-2"/>
      <inertia ixx="1" ixy="0.1" ixz="0.2" iyy="9" iyz="0.3" izz="1"/>
    </inertial>
    <visual name="v"><geometry><sphere radius="0.1"/></geometry><material name="grey"/></visual>
    <collision><geometry><box size="1 2 3"/></geometry></collision>
    <collision><geometry><cylinder radius="0.1" length="-1"/></geometry></collision>
    <collision><geometry><mesh filename="package://p/m.stl" scale="0.001 0.001 0.001"/></geometry></collision>
  </link>
  <link name="b"/><link
    name="c"/>
  <joint name="j" type="revolute">
    <parent link="a"/><child link="b"/><axis xyz="0 0 0"/>
    <limit lower="2" upper="-2" velocity="1" effort="3"/>
    <dynamics damping="0.5"/>
    <safety_controller k_velocity="20" soft_lower_limit="-1" soft_upper_limit="1"/>
  </joint>
  <joint name="k" type="continuous">
    <origin xyz="0 0 1"/><parent link="b"/><child link="c"/><mimic joint="nothing" multiplier="-1"/>
  </joint>
</robot>
"""


def _read(text: str) -> Description:
    outcome = read_urdf(text, "r.urdf")
    assert outcome.value is not None, outcome.diagnostics
    return outcome.value


def _refused(body: str) -> Diagnostic:
    outcome = read_urdf(f'<robot name="r">\n{body}\n</robot>', "r.urdf")
    assert outcome.value is None
    (found,) = outcome.diagnostics
    return found


def test_shapes_keep_their_dimensions() -> None:
    link = there(_read(ROBOT).link("a"))
    assert [collision.geometry for collision in link.collisions] == [
        Box((1.0, 2.0, 3.0)),
        Cylinder(0.1, -1.0),
        Mesh("package://p/m.stl", (0.001, 0.001, 0.001)),
    ]
    (visual,) = link.visuals
    assert (visual.geometry, visual.material, visual.rgba) == (Sphere(0.1), "grey", (0.5, 0.5, 0.5, 1.0))


def test_what_is_wrong_survives_for_the_rules() -> None:
    description = _read(ROBOT)
    joint, link = description.joint("j"), description.link("a")
    assert joint is not None
    assert joint.limit is not None
    assert (joint.limit.lower, joint.limit.upper, joint.axis) == (2.0, -2.0, (0.0, 0.0, 0.0))
    assert link is not None
    assert link.inertial is not None
    assert (link.inertial.mass, link.inertial.iyy) == (-2.0, 9.0)


def test_what_is_absent_takes_the_defaults_of_the_specification() -> None:
    joint = there(_read(ROBOT).joint("k"))
    assert joint.axis == (1.0, 0.0, 0.0)
    assert joint.limit is None
    assert joint.mimic is not None
    assert (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset) == ("nothing", -1.0, 0.0)


def test_absent_limits_are_none_and_not_zero() -> None:
    text = ROBOT.replace('lower="2" upper="-2" ', "")
    joint = there(_read(text).joint("j"))
    assert joint.limit is not None
    assert (joint.limit.lower, joint.limit.upper, joint.limit.velocity) == (None, None, 1.0)


def test_soft_limits_are_read() -> None:
    joint = there(_read(ROBOT).joint("j"))
    assert joint.safety is not None
    assert (joint.safety.soft_lower, joint.safety.soft_upper, joint.safety.k_velocity) == (-1.0, 1.0, 20.0)


def test_inertial_pose_turns_fixed_axes() -> None:
    link = there(_read(ROBOT).link("a"))
    assert link.inertial is not None
    assert link.inertial.pose.position == (1.0, 2.0, 3.0)
    assert link.inertial.pose.quaternion == pytest.approx((0, 0, math.sqrt(0.5), math.sqrt(0.5)))


def test_span_of_a_link_is_its_start_tag() -> None:
    description = _read(ROBOT)
    spans = {link.name: link.span for link in description.links}
    assert spans["a"] == Span("r.urdf", 4, 3, 4, 18)
    assert spans["b"] == Span("r.urdf", 15, 3, 15, 19)
    assert spans["c"] == Span("r.urdf", 15, 19, 16, 15)


def test_prefix_reaches_every_reference() -> None:
    renamed = _read(ROBOT).renamed("left_")
    assert [link.name for link in renamed.links] == ["left_a", "left_b", "left_c"]
    joint = there(renamed.joint("left_k"))
    assert (joint.parent, joint.child, there(joint.mimic).joint) == ("left_b", "left_c", "left_nothing")


def test_roots_are_the_links_that_are_nobodys_child() -> None:
    assert _read(ROBOT).roots() == ("a",)
    assert _read('<robot name="r"><link name="a"/><link name="b"/></robot>').roots() == ("a", "b")


def test_duplicate_names_survive_for_the_rules() -> None:
    description = _read('<robot name="r"><link name="a"/><link name="a"/></robot>')
    assert [link.name for link in description.links] == ["a", "a"]


def _shape(shape: str) -> str:
    return f'<link name="a"><collision><geometry>{shape}</geometry></collision></link>'


REFUSALS = {
    "nan": (_shape('<sphere radius="nan"/>'), "bad-number"),
    "inf": (_shape('<sphere radius="inf"/>'), "bad-number"),
    "overflow": (_shape('<sphere radius="1e999"/>'), "bad-number"),
    "underscore": (_shape('<sphere radius="1_0"/>'), "bad-number"),
    "comma": (_shape('<sphere radius="1,5"/>'), "bad-number"),
    "two_numbers": (_shape('<box size="1 2"/>'), "bad-number"),
    "no_link_name": ("<link/>", "missing-attribute"),
    "empty_link_name": ('<link name=" "/>', "missing-attribute"),
    "no_joint_type": ('<joint name="j"><parent link="a"/><child link="b"/></joint>', "missing-attribute"),
    "no_parent": ('<joint name="j" type="fixed"><child link="b"/></joint>', "missing-element"),
    "no_mass": ('<link name="a"><inertial><inertia/></inertial></link>', "missing-element"),
    "two_shapes": (_shape('<sphere radius="1"/><sphere radius="1"/>'), "bad-geometry"),
    "no_shape": ('<link name="a"><visual><geometry/></visual></link>', "bad-geometry"),
    "unknown_shape": ('<link name="a"><visual><geometry><cone/></geometry></visual></link>', "bad-geometry"),
    "unknown_type": ('<joint name="j" type="rotary"><parent link="a"/><child link="b"/></joint>', "unknown-joint-type"),
    "xacro_left": ("<xacro:include filename='x'/>", "not-expanded"),
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(REFUSALS))
def test_malformed_element_is_reported_on_its_line(name: str) -> None:
    body, code = REFUSALS[name]
    found = _refused(body)
    assert (found.code, found.span.line) == (f"urdf-{code}", 2)


def test_every_malformed_link_is_reported_at_once() -> None:
    outcome = read_urdf('<robot name="r"><link/><link name="a"/><joint/><link/></robot>', "r.urdf")
    assert [found.code for found in outcome.diagnostics] == ["urdf-missing-attribute"] * 3


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "xml-not-well-formed"),
        ("name: cell", "xml-not-well-formed"),
        ("<sdf/>", "urdf-not-a-robot"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><robot name="r"/>', "xml-entities"),
        ("<a>" * 65 + "</a>" * 65, "xml-too-deep"),
        (f"<robot name='r'><!--{'x' * 9_000_000}--></robot>", "xml-too-large"),
    ],
    ids=["empty", "yaml", "sdf", "entity", "deep", "large"],
)
def test_what_is_no_urdf_is_refused(text: str, code: str) -> None:
    outcome = read_urdf(text, "r.urdf")
    assert outcome.value is None
    assert [found.code for found in outcome.diagnostics] == [code]


_FRAGMENTS = st.sampled_from(
    ["<robot name='r'>", "</robot>", "<link name='a'>", "</link>", "<joint name='j' type='fixed'>", "</joint>",
     "<origin xyz='0 0'/>", "<geometry>", "</geometry>", "<box size='1 1 1'/>", "<limit lower='", "'/>", "&#0;", "&a;",
     "<![CDATA[", "]]>", "<!--", "<?xml version='1.0' encoding='utf-16'?>", "\x00", "\ud800", "\u2028",
     "<mass value='1e5'/>"]
)  # fmt: skip


@settings(max_examples=150)
@given(st.one_of(st.binary().map(lambda data: data.decode("latin-1")), st.text(), st.lists(_FRAGMENTS).map("".join)))
def test_reader_answers_any_text(text: str) -> None:
    outcome = read_urdf(text, "r.urdf")
    assert (outcome.value is None) == bool(outcome.diagnostics)


@given(st.integers(0, len(ROBOT)), st.integers(0, 40), _FRAGMENTS)
def test_reader_answers_any_damage(start: int, length: int, patch: str) -> None:
    outcome = read_urdf(ROBOT[:start] + patch + ROBOT[start + length :], "r.urdf")
    assert (outcome.value is None) == bool(outcome.diagnostics)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("${1+1}", "urdf-not-expanded"),
        ("$(env HOME)", "urdf-not-expanded"),
        ("$$", "urdf-not-expanded"),
        ("x&#x202E;y", "control-character"),
        ("x&#10;y", "control-character"),
        ("x&#x9B;y", "control-character"),
    ],
)
@pytest.mark.parametrize(
    "body",
    [
        '<link name="TEXT"/>',
        '<material name="TEXT"/>',
        '<link name="a"><visual name="TEXT"><geometry><sphere radius="1"/></geometry></visual></link>',
        '<link name="a"><collision><geometry><mesh filename="TEXT"/></geometry></collision></link>',
        '<joint name="j" type="fixed"><parent link="TEXT"/><child link="b"/></joint>',
        '<ros2_control name="TEXT" type="system"><hardware><plugin>p</plugin></hardware></ros2_control>',
        '<ros2_control name="n" type="system"><hardware><plugin>p</plugin></hardware>'
        '<gpio name="g"><command_interface name="TEXT"/></gpio></ros2_control>',
    ],
)
def test_a_user_brings_no_text_that_is_evaluated_or_hidden_later(body: str, text: str, code: str) -> None:
    urdf = f'<robot name="r">\n{body.replace("TEXT", text)}\n</robot>'
    outcome = read_urdf(urdf, "r.urdf", from_user=True)
    assert outcome.value is None
    assert {(found.code, found.span.line) for found in outcome.diagnostics} == {(code, 2)}
    # What hides text is no more welcome in a folder that somebody else generated.
    assert (read_urdf(urdf, "r.urdf").value is None) == (text.startswith("x&#x"))


@pytest.mark.parametrize(
    ("text", "changed"),
    [
        ('<r><mesh filename="a"/></r>', '<r><mesh filename="A"/></r>'),
        (
            "<r><mesh a='1'\n filename='a' /><mesh  filename = 'b'/></r>",
            '<r><mesh a=\'1\'\n filename="A" /><mesh  filename = "B"/></r>',
        ),
        ('<r filename="a"><box/><mesh name="a"/></r>', '<r filename="a"><box/><mesh name="a"/></r>'),
        (
            '<!-- <mesh filename="a"/> --><mesh filename="a&amp;b"/>',
            '<!-- <mesh filename="a"/> --><mesh filename="A&amp;B"/>',
        ),
        ("<mesh filename='A'>é</mesh>", "<mesh filename='A'>é</mesh>"),  # nothing to change, not even the quotes
        ('<r>é<mesh filename="é"/>ü</r>', '<r>é<mesh filename="É"/>ü</r>'),
    ],
)
def test_values_are_changed_in_their_places(text: str, changed: str) -> None:
    assert with_values(text, "mesh", "filename", str.upper) == changed


PACKAGE = Path(__file__).resolve().parents[2] / "cellc"
READING = re.compile(r"\b(fromstring|parseString|iterparse|XMLParser|ParserCreate)\(|\b(minidom|ElementTree)\.parse\(")
READERS = {
    "robot/description/meshes.py",  # takes meshes out of a text that the reader has accepted
    "robot/description/xacro_confinement.py",
    "robot/description/xml_tree.py",
    "compiler/verify/read_back.py",
    "compiler/verify/scene.py",  # reads back what cellc has written
    "compiler/emit/launch/observe_listener.py",  # it runs on the robot's host, without cellc
    "compiler/emit/launch/observe_program.py",  # it runs on the robot's host, without cellc
}


def test_xml_is_read_in_one_place() -> None:
    reading = {
        file.relative_to(PACKAGE).as_posix()
        for file in PACKAGE.rglob("*.py")
        if READING.search(file.read_text(encoding="utf-8"))
    }
    assert reading == READERS


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
    return there(read.value)


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
