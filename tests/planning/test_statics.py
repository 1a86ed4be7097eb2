"""What holds a robot still, against torques worked out by hand with 9.81 m/s²."""

from __future__ import annotations

import math

import pytest

from cellc.contract.control_law import LinkMass
from cellc.robot.planning import RobotModel, holding_efforts

_INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
_LIMIT = '<limit lower="-3" upper="3" velocity="1" effort="1"/>'
# A bar of 2 kg and 0.4 m that turns about y, then a hand without mass, on a lift whose axis leans by 60 degrees.
_URDF = f"""<robot name="bar">
  <link name="base"/>
  <link name="lift"/>
  <link name="bar"><inertial><origin xyz="0.2 0 0"/><mass value="2"/>{_INERTIA}</inertial></link>
  <link name="hand"/>
  <joint name="leaning" type="prismatic">
    <parent link="base"/><child link="lift"/><axis xyz="{math.sin(math.pi / 3)} 0 0.5"/>{_LIMIT}</joint>
  <joint name="turn" type="revolute"><parent link="lift"/><child link="bar"/><axis xyz="0 1 0"/>{_LIMIT}</joint>
  <joint name="wrist" type="revolute">
    <parent link="bar"/><child link="hand"/><origin xyz="0.4 0 0"/><axis xyz="1 0 0"/>{_LIMIT}</joint>
</robot>"""
ROBOT = RobotModel.from_urdf(_URDF)


@pytest.mark.parametrize(("angle_deg", "lever_m"), [(0.0, 0.2), (60.0, 0.1), (90.0, 0.0), (-60.0, 0.1)])
def test_level_bar_takes_most_and_an_upright_one_nothing(angle_deg: float, lever_m: float) -> None:
    efforts = holding_efforts(ROBOT, {"turn": math.radians(angle_deg)})
    assert abs(efforts["turn"]) == pytest.approx(2 * 9.81 * lever_m, abs=1e-9)


def test_joint_that_slides_holds_the_weight_along_its_axis() -> None:
    assert abs(holding_efforts(ROBOT, {})["leaning"]) == pytest.approx(2 * 9.81 * 0.5)


def test_carried_mass_is_held_at_its_center_as_the_links_turn_it() -> None:
    hand = LinkMass(link="hand", mass_kg=3.0, center=(0.1, 0.2, 0.0))
    level = holding_efforts(ROBOT, {}, [hand])
    assert abs(level["turn"]) == pytest.approx(9.81 * (2 * 0.2 + 3 * 0.5))
    assert abs(level["wrist"]) == pytest.approx(9.81 * 3 * 0.2)
    assert abs(level["leaning"]) == pytest.approx(9.81 * 5 * 0.5)
    turned = holding_efforts(ROBOT, {"wrist": math.pi / 2}, [hand])  # the center is above the axis of the wrist
    assert turned["wrist"] == pytest.approx(0.0, abs=1e-9)
    assert turned["turn"] == pytest.approx(level["turn"])
