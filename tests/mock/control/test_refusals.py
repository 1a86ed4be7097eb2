"""What a client is told of a goal or a message that no controller takes, in the words of the real ones."""

from __future__ import annotations

import pytest

from cellc.mock.control import GoalResponse, GripperGoal, Trajectory, TrajectoryGoal, TrajectoryPoint

from .bench import S, bench, point

_JOINTS = ("a", "b")
_NEAR = (point(0.1, 0.1),)
# joint_trajectory_controller 4.x, src/joint_trajectory_controller.cpp, validate_trajectory_msg: what it logs.
_MESSAGES: list[tuple[tuple[str, ...], tuple[TrajectoryPoint, ...], int, str]] = [
    (("a",), (point(0.1),), 0, "Joints on incoming trajectory don't match the controller joints."),
    (_JOINTS, (), 0, "Empty trajectory received."),
    (("a", "c"), _NEAR, 0, "Incoming joint c doesn't match the controller's joints."),
    (
        _JOINTS,
        (point(0.1, 0.1, v=(0.0, 0.5)),),
        0,
        "Velocity of last trajectory point of joint b is not zero: 0.500000000000000",
    ),
    (
        _JOINTS,
        _NEAR,
        99 * S,
        "Received trajectory with non-zero start time (99.000000) that ends in the past (100.000000)",
    ),
    (
        _JOINTS,
        (point(0.1, 0.1, at=0.5), point(0.1, 0.1, at=0.25)),
        0,
        "Time between points 0 and 1 is not strictly increasing, it is 0.500000 and 0.250000 respectively",
    ),
]


@pytest.mark.parametrize(("joints", "points", "stamp_ns", "reason"), _MESSAGES)
def test_message_on_the_topic_is_answered_as_a_goal_is(
    joints: tuple[str, ...], points: tuple[TrajectoryPoint, ...], stamp_ns: int, reason: str
) -> None:
    manager = bench(start_ns=100 * S)
    assert manager.publish_trajectory("arm", Trajectory(joints, points, stamp_ns)) == reason
    assert manager.send_goal("arm", TrajectoryGoal(joints, points, stamp_ns)) == GoalResponse(False, 0, reason)


def test_message_that_is_taken_has_no_reason() -> None:
    assert bench().publish_trajectory("arm", Trajectory(_JOINTS, _NEAR)) == ""
    inactive = bench(up=("joints",))
    assert inactive.spawn(["arm"], inactive=True).ok
    assert inactive.publish_trajectory("arm", Trajectory(_JOINTS, _NEAR)) == "the controller is not active"


_ARM_GOAL = TrajectoryGoal(_JOINTS, _NEAR)
_HAND_GOAL = GripperGoal((0.01,), (), (), ("f",))


@pytest.mark.parametrize(
    ("controller", "goal", "reason"),
    [
        ("arm", _ARM_GOAL, "Can't accept new action goals. Controller is not running."),
        ("hand", _HAND_GOAL, "the action server of 'hand' exists only while it is active"),
        ("nobody", _ARM_GOAL, "no action server for this goal at 'nobody'"),
        ("joints", _ARM_GOAL, "no action server for this goal at 'joints'"),
        ("arm", _HAND_GOAL, "no action server for this goal at 'arm'"),
        ("hand", _ARM_GOAL, "no action server for this goal at 'hand'"),
    ],
)
def test_goal_that_nobody_takes_gets_no_number(
    controller: str, goal: TrajectoryGoal | GripperGoal, reason: str
) -> None:
    manager = bench(up=("joints",))
    assert manager.spawn(["arm"], inactive=True).ok
    assert manager.spawn(["hand"], inactive=True).ok
    assert manager.send_goal(controller, goal) == GoalResponse(False, 0, reason)


def test_gripper_takes_one_position() -> None:
    refused = bench().send_goal("hand", GripperGoal((0.01, 0.02), (), (), ("f",)))
    reason = "Received action goal with wrong number of position values, expects 1, got 2"
    assert refused == GoalResponse(False, 0, reason)


def test_goals_of_all_controllers_are_counted_from_one_and_refused_ones_are_not() -> None:
    manager = bench()
    sent: list[tuple[str, TrajectoryGoal | GripperGoal]] = [
        ("arm", _ARM_GOAL),
        ("arm", TrajectoryGoal(_JOINTS, ())),
        ("hand", _HAND_GOAL),
        ("arm", _ARM_GOAL),
    ]
    answers = [manager.send_goal(controller, goal) for controller, goal in sent]
    assert [(each.accepted, each.goal_id) for each in answers] == [(True, 1), (False, 0), (True, 2), (True, 3)]
