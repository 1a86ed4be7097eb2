"""Forward kinematics against pinocchio, and joints that follow followers by hand."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

from cellc.compiler.catalog.load import device_names, load_device
from cellc.contract.transforms import Pose, identity
from cellc.robot.description.model import Description, Joint, Mimic
from cellc.robot.description.posture import farthest, posture
from cellc.robot.description.urdf_reader import read_urdf
from tests.cells import device_of, there

# A slider, a mimic with offset, an axis that is no unit vector, and a turned joint frame.
_ODD = """<robot name="odd"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="turn" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.1 0 0.2" rpy="0.3 -0.2 1"/>
  <axis xyz="0 2 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="0 0.3 0" rpy="1 0 0"/>
  <axis xyz="0 0 1"/><limit lower="0" upper="0.5" velocity="1" effort="1"/></joint>
<joint name="follow" type="continuous"><parent link="c"/><child link="d"/><origin xyz="0.2 0 0"/><axis xyz="1 0 0"/>
  <mimic joint="turn" multiplier="-0.5" offset="0.25"/></joint></robot>"""


def _read(text: str) -> Description:
    return there(read_urdf(text, "odd.urdf", None).value)


def test_odd_joints_stand_where_pinocchio_has_them() -> None:
    poses = posture(_read(_ODD), {"turn": 0.7, "slide": 0.2})
    model = pinocchio.buildModelFromXML(_ODD, mimic=False)
    data = model.createData()
    angle = -0.5 * 0.7 + 0.25
    q = np.array([0.7, 0.2, math.cos(angle), math.sin(angle)])
    pinocchio.framesForwardKinematics(model, data, q)
    for link, pose in poses.items():
        placed = data.oMf[model.getFrameId(link)]
        np.testing.assert_allclose(pose.position, placed.translation, atol=1e-12)
        np.testing.assert_allclose(pose.apply((1.0, 2.0, 3.0)), placed.act(np.array([1.0, 2.0, 3.0])), atol=1e-12)


def _upright(length: float) -> Description:
    def joint(name: str, parent: str, child: str, kind: str, up: float) -> Joint:
        return Joint(name, kind, parent, child, Pose((0.0, 0.0, up), (0.0, 0.0, 0.0, 1.0)), (0.0, 1.0, 0.0))

    base = Joint("pan", "continuous", "root", "base", identity(), (0.0, 0.0, 1.0))
    joints = (
        base,
        joint("lift", "base", "upper", "continuous", 0.0),
        joint("elbow", "upper", "lower", "continuous", length),
        joint("end", "lower", "tip", "fixed", length),
    )
    return Description("arm", (), joints)


def test_arm_of_two_links_reaches_as_far_as_both_are_long() -> None:
    # The base joint turns about z; lift and elbow lie in one plane, so that the tip gets 2 x 0.4 m from the axis.
    assert farthest(_upright(0.4), "tip", {"elbow": 1.0}) == pytest.approx(0.8, abs=1e-6)


def _arms() -> list[str]:
    found = []
    for name in device_names():
        entry = load_device(name).value
        if entry is not None and entry.model.kind == "arm" and entry.model.limits.reach is not None:
            found.append(name)
    return found


@pytest.mark.parametrize("name", _arms())
def test_arm_of_the_catalog_reaches_what_its_vendor_says(name: str) -> None:
    entry = device_of(name)
    reach = farthest(entry.description, there(entry.model.tool_frame), {})
    # Vendors measure to the wrist or to the flange; the tool frame lies at most a wrist beyond.
    assert 0.95 <= reach / there(entry.model.limits.reach).value.si <= 1.3


Follows = dict[str, tuple[str, float, float]]


def _direct(follows: Follows, *leaders: str) -> Follows:
    joints = tuple(
        Joint(name, "revolute", "base", f"{name}_link", identity(), (0.0, 0.0, 1.0), mimic=None) for name in leaders
    ) + tuple(
        Joint(name, "revolute", "base", f"{name}_link", identity(), (0.0, 0.0, 1.0), mimic=Mimic(*mimic))
        for name, mimic in follows.items()
    )
    direct = Description(name="chain", links=(), joints=joints).with_direct_mimics()
    assert [joint.name for joint in direct.joints] == [joint.name for joint in joints]
    return {
        joint.name: (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
        for joint in direct.joints
        if joint.mimic is not None
    }


@pytest.mark.parametrize(
    ("follows", "direct"),
    [
        ({"b": ("a", 3.0, 0.5)}, {"b": ("a", 3.0, 0.5)}),
        # c = 2 b + 0.1, b = 3 a + 0.5: c = 6 a + 1.1.
        ({"c": ("b", 2.0, 0.1), "b": ("a", 3.0, 0.5)}, {"c": ("a", 6.0, 1.1), "b": ("a", 3.0, 0.5)}),
        # d = -c + 1 = -6 a - 0.1.
        (
            {"b": ("a", 3.0, 0.5), "c": ("b", 2.0, 0.1), "d": ("c", -1.0, 1.0)},
            {"b": ("a", 3.0, 0.5), "c": ("a", 6.0, 1.1), "d": ("a", -6.0, -0.1)},
        ),
        # Two that follow each other, and one that follows them, stay as they are.
        (
            {"b": ("c", 2.0, 0.0), "c": ("b", 0.5, 0.0), "d": ("c", 1.0, 0.0)},
            {"b": ("c", 2.0, 0.0), "c": ("b", 0.5, 0.0), "d": ("c", 1.0, 0.0)},
        ),
        ({"b": ("b", 1.0, 0.2)}, {"b": ("b", 1.0, 0.2)}),
        ({"b": ("nothing", 2.0, 0.2)}, {"b": ("nothing", 2.0, 0.2)}),
    ],
)
def test_follower_of_a_follower_follows_the_first_leader(follows: Follows, direct: Follows) -> None:
    found = _direct(follows, "a")
    assert {name: leader for name, (leader, _, _) in found.items()} == {
        name: leader for name, (leader, _, _) in direct.items()
    }
    for name, (_, multiplier, offset) in direct.items():
        assert found[name][1:] == pytest.approx((multiplier, offset))
