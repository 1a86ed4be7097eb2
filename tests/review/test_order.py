"""Which heading stands first of several of one grade, what is one heading, what is not said twice, and who is asked."""

from __future__ import annotations

import re

import pytest

from cellc.contract.printing import as_text
from cellc.contract.review import Review
from cellc.tools.review.groups import groups_of
from cellc.tools.review.short import render_short
from tests.review.edits import review_of
from tests.review.revisions import Edit

_HOME: Edit = ("home: {arm: 0 -45 0 -135 0 90 45 deg}", "home: {arm: 20 -45 0 -135 0 90 45 deg}")
_TASK: Edit = (
    "task: {run: cell_tasks/tray_to_press, host: planner_pc",
    "task: {run: cell_tasks/tray_to_press, host: control_pc",
)
_FIRST: Edit = ("max_delta: 3 deg, velocity: 3 deg/s", "max_delta: 2 deg, velocity: 3 deg/s")
_SLOWER: Edit = ("limits: {velocity: 35 %, acceleration: 15 %}", "limits: {velocity: 25 %, acceleration: 15 %}")
_REAL_TIME: Edit = ("scheduling: generic", "scheduling: preempt_rt")
_ADDRESS: Edit = ("address: 10.50.0.11/24", "address: 10.50.0.21/24")
_PEERS: Edit = ("peers: [10.50.0.10, 10.50.0.11]", "peers: [10.50.0.10, 10.50.0.21]")
_POSTPONED: Edit = ("date: 2026-12-15}", "date: 2027-02-15}")
_FIRMWARE: Edit = ("polyscope 5.21.0", "polyscope 5.21.1")
_AUTHORITY: Edit = ("stop: {authority: safety_plc", "stop: {authority: scanner")
_FIXTURE: Edit = ("xyz: 450 100 850 mm", "xyz: 450 120 850 mm")
_FASTER: Edit = ("limits: {velocity: 50 %, acceleration: 50 %}", "limits: {velocity: 60 %, acceleration: 50 %}")
_LOOSER: Edit = ("goal_tolerance: 0.01 rad", "goal_tolerance: 0.012 rad")
_BASE: Edit = ("xyz: 0 0 0.8 m", "xyz: 0 0.1 0.8 m")


def _titles(found: Review) -> list[str]:
    return [re.sub(r"[: ].*", "", group.title) for group in groups_of(found)]


def _screen(found: Review) -> list[str]:
    return as_text(render_short(found), color=False).splitlines()


@pytest.mark.parametrize(
    ("cell", "edits", "titles"),
    [
        ("fr3_hand", (_HOME, _TASK), ["nodes.task.host", "motion.poses.home.arm"]),
        ("hybrid_sdk", (_FIRST, _SLOWER), ["devices.arm.limits.velocity", "bringup.first_motion.max_delta"]),
        (
            "hybrid_sdk",
            (_REAL_TIME, _ADDRESS, _PEERS),
            ["hosts.planner_pc.nics.cell.address", "hosts.planner_pc.scheduling"],
        ),
        ("ur5e_pick", (_POSTPONED, _FIRMWARE), ["devices.arm.firmware", "surroundings.fittings.open.date"]),
        (
            "ur5e_pick",
            (_LOOSER, _FASTER, _FIXTURE, _AUTHORITY, _BASE),
            [
                "devices.arm.mount.xyz",
                "safety.stop.authority",
                "frames.fixture_A.xyz",
                "devices.arm.limits.velocity",
                "control.controllers.arm_trajectory.goal_tolerance",
            ],
        ),
    ],
)
def test_the_largest_act_stands_first(cell: str, edits: tuple[Edit, ...], titles: list[str]) -> None:
    assert _titles(review_of(cell, *edits)) == titles


@pytest.mark.parametrize(
    ("cell", "edits", "title"),
    [
        (
            "ur5e_pick",
            (
                ("    rate: 10 Hz\n    buffer", "    rate: 15 Hz\n    buffer"),
                ("rate: 10 Hz\n    max", "rate: 15 Hz\n    max"),
            ),
            "frames.object.rate, interfaces./object_pose.rate: 10 Hz -> 15 Hz (+50 %) (cell.yaml:",
        ),
        (
            "hybrid_sdk",
            (("update_rate: 250 Hz", "update_rate: 200 Hz"), ("rate: 250 Hz, max_age", "rate: 200 Hz, max_age")),
            "interfaces./joint_states.rate, control.update_rate: 250 Hz -> 200 Hz (-20 %) (cell.yaml:",
        ),
        (
            "rail_arm",
            (
                ("frame: press, rpy: 180 0 0 deg, xyz: 0 0 20 mm", "frame: press, rpy: 180 0 0 deg, xyz: 0 0 30 mm"),
                ("deburring, rpy: 180 0 0 deg, xyz: 0 0 20 mm", "deburring, rpy: 180 0 0 deg, xyz: 0 0 30 mm"),
            ),
            "motion.goals.{take,give}.xyz: 0 0 20 mm -> 0 0 30 mm (cell.yaml:",
        ),
    ],
)
def test_both_ends_of_a_rate_and_goals_that_move_alike_are_one_heading(
    cell: str, edits: tuple[Edit, ...], title: str
) -> None:
    (group,) = groups_of(review_of(cell, *edits))
    assert group.title.startswith(title)


@pytest.mark.parametrize(
    ("cell", "edit", "below"),
    [
        ("fr3_hand", _TASK, ["  asks controller (controls), time_tf (metrology), graph (integration)"]),
        (
            "ur5e_pick",
            ("cancel_within: 200 ms", "cancel_within: 150 ms"),
            [],
        ),
        (
            "hybrid_sdk",
            ("port: /dev/ttyUSB0", "port: /dev/ttyUSB1"),
            ["  because another device may answer at this address", "  asks vendor (robot), network (it)"],
        ),
        ("hybrid_sdk", ("address: 172.16.0.2}", "address: 172.16.0.3}"), ["  asks vendor (robot), network (it)"]),
        (
            "ur5e_pick",
            ("goal_time: 1 s", "goal_time: 2 s"),
            ["  because a failure is noticed later", "  asks controller (controls)"],
        ),
        (
            "dual_ur",
            (
                "rpy: 180 0 0 deg, xyz: 0 0 20 mm, approach: 0 0 -100 mm}\n    take",
                "rpy: 180 0 0 deg, xyz: 0 0 30 mm, approach: 0 0 -100 mm}\n    take",
            ),
            ["  motion  pose in its frame moves 10 mm: put", "  asks controller (controls)"],
        ),
    ],
)
def test_a_heading_is_not_said_again_and_what_it_means_is(cell: str, edit: Edit, below: list[str]) -> None:
    lines = _screen(review_of(cell, edit))
    end = next(number for number, line in enumerate(lines) if line.startswith("gates to repeat"))
    assert [line for line in lines[4:end] if not line.startswith("  (cell.yaml")] == below


@pytest.mark.parametrize(
    ("cell", "edit", "asks"),
    [
        ("ur5e_pick", ("exposure: 8 ms", "exposure: 10 ms"), "time_tf (perception)"),
        (
            "fr3_hand",
            ("connection: {host: control_pc, nic: robot}", "connection: {host: control_pc, nic: cell}"),
            "vendor (robot), network (it)",
        ),
        ("dual_ur", ("first_port: 50011", "first_port: 50021"), "vendor (robot), network (it)"),
        (
            "fr3_hand",
            ("run: cell_tasks/tray_to_press, host", "run: cell_tasks/tray_to_press, parameters: {speed: 0.5}, host"),
            "graph (integration)",
        ),
        (
            "fr3_hand",
            ("move_group, host: planner_pc", "move_group, parameters: {planning_time: 2.0}, host: planner_pc"),
            "controller (controls)",
        ),
        (
            "ur5e_pick",
            (
                "speed_scaling_state_broadcaster, device: arm}",
                "speed_scaling_state_broadcaster, device: arm, parameters: {state_publish_rate: 50.0}}",
            ),
            "controller (controls)",
        ),
    ],
)
def test_who_owns_what_changed_is_asked(cell: str, edit: Edit, asks: str) -> None:
    (group,) = groups_of(review_of(cell, edit))
    assert group.asks == asks
