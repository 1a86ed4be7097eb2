"""Durations, curves and bounds of motion, reach and torques, worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cellc.contract.control_law import LinkMass
from cellc.contract.transforms import Pose
from cellc.robot.planning import RobotModel, beyond_reach, holding_efforts
from cellc.robot.planning.cartesian import _extrapolated, _step_count
from cellc.robot.planning.motion_law import fastest_bounds, jerk_changes, rest_to_rest, rest_to_rest_durations
from cellc.robot.planning.problem import JointLimits
from cellc.robot.planning.splines import SectionCurve


@pytest.mark.parametrize(
    ("bounds", "duration_s"),
    [
        # Full speed after a/j + v/a = 0.25 + 0.5 s. Each ramp covers 0.75/2, and 0.25 is left at 1/s.
        ((1.0, 2.0, 8.0), 1.75),
        # After 1/6 + 1/3 s; each ramp covers 0.25, half is left. Then after 0.25 + 0.5 s, and 0.625 is left at 0.5/s.
        ((1.0, 3.0, 18.0), 1.5),
        ((0.5, 1.0, 4.0), 2.75),
        # The acceleration reaches sqrt(v j) = 4 of 10. Each ramp takes 2 sqrt(v/j) = 0.5 s and covers 0.25.
        ((1.0, 10.0, 16.0), 1.5),
        # Never at full speed: half the time h has (h - a/j) h a = 1, and (1.5 - 0.5) * 1.5 * 2/3 = 1.
        ((10.0, 2.0 / 3.0, 4.0 / 3.0), 3.0),
        ((10.0, 1.0, 12.0 / 7.0), 8.0 / 3.0),  # (4/3 - 7/12) * 4/3 = 1
        ((1.5, 2.0, 2.0 / (0.95 - 1.0 / 1.9)), 1.9),  # (0.95 - a/j) * 0.95 * 2 = 1; full speed would take 1.76 of 1
        # Neither speed nor acceleration is full: four phases of t with 2 j t^3 = 1, and j t is less than a.
        ((10.0, 10.0, 4.0), 2.0),
        ((10.0, 1.0, 32.0 / 27.0), 3.0),
        ((10.0, 2.0, 0.5 / 0.52**3), 2.08),
    ],
)
def test_motion_from_rest_to_rest_takes(bounds: tuple[float, float, float], duration_s: float) -> None:
    assert rest_to_rest_durations(np.array([bounds])) == pytest.approx([duration_s])
    assert rest_to_rest(bounds).duration == pytest.approx(duration_s)


def test_jerk_changes_at_the_ends_of_the_phases() -> None:
    # Ramp of 0.25 s, 0.25 s of full acceleration, ramp of 0.25 s, 0.25 s of full speed, and the same back.
    assert jerk_changes(rest_to_rest((1.0, 2.0, 8.0))) == pytest.approx(
        [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75], abs=1e-9
    )


@pytest.mark.parametrize(
    ("samples", "at", "expected"),
    [
        ([0.0, 2.0], 0.25, (0.5, 2.0, 0.0, 0.0)),  # 2u
        ([u * u for u in (0.0, 0.5, 1.0)], 0.25, (0.0625, 0.5, 2.0, 0.0)),  # u^2: value, 2u, 2, 0
        ([u**3 - u for u in (0.0, 0.25, 0.5, 0.75, 1.0)], 0.6, (-0.384, 0.08, 3.6, 6.0)),  # u^3 - u: 3u^2 - 1, 6u, 6
        ([u**3 for u in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)], 0.5, (0.125, 0.75, 3.0, 6.0)),
    ],
)
def test_curve_of_a_cubic_is_that_cubic(samples: list[float], at: float, expected: tuple[float, ...]) -> None:
    found = SectionCurve([(value,) for value in samples]).derivatives(np.array([at]))
    assert [float(finding[0, 0]) for finding in found] == pytest.approx(expected, abs=1e-9)


def test_straight_line_is_as_fast_as_its_slowest_joint() -> None:
    limits = JointLimits(("a", "b"), (-9.0, -9.0), (9.0, 9.0), (1.0, 0.1), (2.0, 1.6), (4.0, 2.4))
    # Ways of 2 and 0.5: speed min(1/2, 0.1/0.5), acceleration min(2/2, 1.6/0.5), jerk min(4/2, 2.4/0.5).
    assert fastest_bounds(SectionCurve([(0.0, 0.0), (2.0, -0.5)]), limits) == pytest.approx((0.2, 1.0, 2.0))


def test_bounds_on_a_curve_leave_room_for_what_its_bends_cost() -> None:
    limits = JointLimits(("a",), (-9.0,), (9.0,), (1.0,), (1.0,), (8.0,))
    speed, acceleration, jerk = fastest_bounds(SectionCurve([(0.0,), (0.25,), (1.0,)]), limits)  # u^2: slope 2, bend 2
    # q's'' + q''s'^2 <= 1 and q's''' + 3q''s's'' <= 8, with the acceleration or a share of it.
    room = (1.0 - 2.0 * speed**2) / 2.0
    assert any(acceleration == pytest.approx(share * room) for share in (1.0, 0.5, 0.25))
    assert jerk == pytest.approx((8.0 - 3.0 * 2.0 * speed * acceleration) / 2.0)


@pytest.mark.parametrize(
    ("joints", "followed", "guess"),
    [
        (6, [5.0], 5.0),
        (6, [1.0, 3.0], 5.0),  # the straight line
        (6, [0.0, 1.0, 4.0], 9.0),  # squares
        (6, [0.0, 1.0, 8.0, 27.0], 64.0),  # cubes
        (6, [9.0, 0.0, 1.0, 8.0, 27.0], 64.0),  # the last four alone
        (7, [0.0, 1.0, 8.0, 27.0], 46.0),  # a redundant arm: straight on from 8 over 27
    ],
)
def test_next_waypoint_of_a_line_is_looked_for_on_the_curve_of_those_before(
    joints: int, followed: list[float], guess: float
) -> None:
    assert _extrapolated([np.full(joints, value) for value in followed]) == pytest.approx([guess] * joints)


@pytest.mark.parametrize(
    ("way_m", "turn_rad", "steps"),
    [
        (0.0, 0.0, 2),
        (0.004, 0.0, 2),
        (0.1, 0.0, 20),
        (0.1001, 0.0, 21),
        (0.0, 1.0, 20),
        (0.0, 1.001, 21),
        (0.1, 1.2, 24),
    ],
)
def test_steps_of_a_line_are_5_mm_or_50_mrad(way_m: float, turn_rad: float, steps: int) -> None:
    start = Pose((0.3, 0.1, 0.2), (0.0, 0.0, 0.0, 1.0))
    goal = Pose((0.3, 0.1, 0.2 - way_m), (math.sin(turn_rad / 2), 0.0, 0.0, math.cos(turn_rad / 2)))
    assert _step_count(start, goal) == steps


def _swing(post_m: float, kind: str = "revolute", travel_m: float = 1.0) -> RobotModel:
    """Return a bar from 0 to 0.4 m on a joint, and a cube of 0.1 m at a distance from that joint."""
    return RobotModel.from_urdf(f"""<robot name="swing"><link name="floor"/>
    <link name="bar"><collision><origin xyz="0.2 0 0"/>
    <geometry><box size="0.4 0.04 0.04"/></geometry></collision></link>
    <link name="post"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="turn" type="{kind}"><parent link="floor"/><child link="bar"/><axis xyz="0 0 1"/>
    <limit lower="{-travel_m}" upper="{travel_m}" velocity="1" effort="1"/></joint>
    <joint name="stand" type="fixed"><parent link="floor"/><child link="post"/><origin xyz="0 {-post_m} 0"/></joint>
    </robot>""")


# The bar's box is held by a ball of 0.2020 m round its middle, 0.2 m from the joint; the cube by one of 0.0866 m:
# together 0.4886 m.
@pytest.mark.parametrize(("post_m", "apart"), [(0.482, False), (0.488, False), (0.490, True)])
def test_balls_round_the_chains_decide(post_m: float, apart: bool) -> None:
    assert beyond_reach(_swing(post_m), margin_m=0.0) == ({("bar", "post")} if apart else set())


def test_the_margin_is_kept() -> None:
    assert beyond_reach(_swing(0.490), margin_m=0.005) == set()
    assert beyond_reach(_swing(0.495), margin_m=0.005) == {("bar", "post")}


def test_a_sliding_joint_reaches_as_far_as_it_travels() -> None:
    assert beyond_reach(_swing(0.6, "prismatic", 0.1), margin_m=0.0) == {("bar", "post")}
    assert beyond_reach(_swing(0.6, "prismatic", 0.2), margin_m=0.0) == set()


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
