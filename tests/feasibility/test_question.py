"""What the planner is asked of the complete cell, with figures worked out by hand from its spec."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from cellc.compiler.cell.device import Device
from cellc.compiler.feasibility.question import (
    MotionQuestion,
    PoseQuestion,
    ViewQuestion,
    motion_question,
)
from cellc.compiler.graph.cell_graph import CellGraph, build_graph
from cellc.contract.control_law import LinkMass
from cellc.contract.transforms import Pose
from tests.cells import COMPLETE, graph_of

Triple = tuple[float, float, float]


@cache
def _graph() -> CellGraph:
    return graph_of(COMPLETE)


def _question(**changes: Any) -> MotionQuestion:
    """Ask about the cell with another arm."""
    cell = _graph().cell
    devices = tuple(replace(device, **changes) if device.name == "arm" else device for device in cell.devices)
    return motion_question(build_graph(replace(cell, devices=devices)))


def _arm() -> Device:
    return _graph().cell.device("arm")


@pytest.mark.parametrize(
    ("payload_kg", "rest_kg"),
    [(1.0, 0.1), (2.5, 1.6), (0.9, None), (0.5, None)],  # the tool: gripper 0.8 kg + camera 0.1 kg = 0.9 kg
)
def test_arm_carries_its_payload_without_the_tools_that_are_described(payload_kg: float, rest_kg: float | None) -> None:
    payload = _arm().robot.payload
    assert payload is not None
    carried = _question(robot=replace(_arm().robot, payload=replace(payload, mass_kg=payload_kg))).carried
    due = [] if rest_kg is None else [LinkMass(link="arm_tool0", mass_kg=rest_kg, center=(0.0, 0.0, 0.058))]
    assert [replace(one, mass_kg=round(one.mass_kg, 9)) for one in carried] == due


def test_arm_without_payload_or_without_a_place_for_it_carries_nothing() -> None:
    assert _question(robot=replace(_arm().robot, payload=None)).carried == ()
    assert _question(body=replace(_arm().body, tool_frame=None)).carried == ()


# The frame of a goal in the world, its z reversed by 180 degrees about x, and 10 mm above; the tip `tcp` is 162 mm
# before the link `gripper_base`, so that the link stands at 0.85 + 0.01 + 0.162 m; the approach begins 100 mm higher.
@pytest.mark.parametrize(("goal", "y"), [("place", 0.1), ("pick", 0.1 - 0.25)])
def test_goal_is_a_pose_of_the_link_that_carries_the_tip(goal: str, y: float) -> None:
    asked = next(one for one in _question().goals if one.name == goal)
    assert asked.before is not None
    assert asked.target.position == pytest.approx((0.45, y, 1.022))
    assert asked.before.position == pytest.approx((0.45, y, 1.122))
    assert asked.target.quaternion == pytest.approx((1.0, 0.0, 0.0, 0.0))


def test_group_is_asked_between_its_limits_and_a_continuous_joint_without_any() -> None:
    turn = round(2 * math.pi, 7)
    (group,) = _question().groups
    assert (group.base_link, group.tip_link) == ("arm_base_link", "gripper_base")
    assert (group.lower, group.upper) == ((-turn,) * 6, (turn,) * 6)
    first, second, *others = _arm().joints
    free = (replace(first, type="continuous"), replace(second, lower=None, upper=2.0), *others)
    (group,) = _question(joints=free).groups
    assert (group.lower[:3], group.upper[:3]) == ((-math.inf, -math.inf, -turn), (math.inf, 2.0, turn))


def test_pose_and_view_are_asked_as_the_spec_has_them() -> None:
    quarter = math.pi / 2
    asked = _question()
    angles = (0.0, -quarter, quarter, -quarter, -quarter, 0.0)
    home = tuple((f"arm_joint_{number}", angle) for number, angle in enumerate(angles, start=1))
    assert asked.poses == (PoseQuestion("home", home),)
    assert asked.start == (*home, ("gripper_finger_joint", 0.0))
    place = Pose((0.45, -0.15, 0.85), (0.0, 0.0, 0.0, 1.0))  # fixture_A, and 250 mm to the side of it
    assert asked.views == (ViewQuestion("object", "camera_color_optical", "home", place),)


def test_joints_without_a_limit_of_effort_are_held_by_nothing() -> None:
    first, *others = _arm().joints
    assert "arm_joint_1" in _question().held
    assert "arm_joint_1" not in _question(joints=(replace(first, effort=None), *others)).held
