"""Pairs that chains keep apart: radii by hand."""

from __future__ import annotations

import pytest

from cellc.robot.planning import RobotModel, beyond_reach


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
