"""What the gripper controllers answer, row by row of the table of facts (section 6)."""

from __future__ import annotations

import math

import pytest

from cellc.contract.vocabulary import Distro
from cellc.mock.control import ControllerManager, GoalStatus, GripperEnded, GripperGoal, JointFault

from .bench import S, Value, bench, only, urdf, wait
from .fact_rows import row

PARALLEL = "parallel_gripper_action_controller/GripperActionController"
POSITION = "position_controllers/GripperActionController"
_BOTH = [(Distro.KILTED, PARALLEL), (Distro.HUMBLE, POSITION)]


def _cell(
    distro: Distro, plugin: str, hand: dict[str, Value] | None = None, description: str = ""
) -> ControllerManager:
    manager = bench(hand=hand, types={"hand": plugin}, distro=distro, description=description)
    manager.disturbances.disturb("f", JointFault(max_velocity=0.2))  # Humble's manager limits no command
    return manager


def _grip(manager: ControllerManager, *position: float) -> int:
    response = manager.send_goal("hand", GripperGoal(position))
    assert response.accepted
    return response.goal_id


@row("6", 1)
@pytest.mark.parametrize("position", [(), (0.01, 0.02)])
def test_parallel_gripper_wants_exactly_one_position(position: tuple[float, ...]) -> None:
    response = _cell(Distro.KILTED, PARALLEL).send_goal("hand", GripperGoal(position))
    assert not response.accepted


@row("6", 1)
@pytest.mark.parametrize(("distro", "plugin"), _BOTH)
@pytest.mark.parametrize("position", [99.0, -1.0, math.nan])
def test_no_value_of_a_position_is_refused(distro: Distro, plugin: str, position: float) -> None:
    assert _cell(distro, plugin).send_goal("hand", GripperGoal((position,))).accepted


@row("6", 2)
def test_effort_and_velocity_of_the_goal_count_where_interfaces_are_configured() -> None:
    extra = '<command_interface name="set_gripper_max_effort"/><command_interface name="set_gripper_max_velocity"/>'
    described = urdf(dynamics=False).replace(
        '<joint name="f"><command_interface', f'<joint name="f">{extra}<command_interface'
    )
    named: dict[str, Value] = {
        "max_effort_interface": "f/set_gripper_max_effort",
        "max_velocity_interface": "f/set_gripper_max_velocity",
        "max_effort": 7.0,
    }
    manager = _cell(Distro.KILTED, PARALLEL, named, described)
    manager.send_goal("hand", GripperGoal((0.01,), velocity=(0.05,)))
    wait(manager, 0.1)
    assert manager.command("f/set_gripper_max_effort") == 7.0  # not given: the parameter
    assert manager.command("f/set_gripper_max_velocity") == 0.05


@row("6", 3)
@pytest.mark.parametrize(("distro", "plugin"), _BOTH)
def test_position_inside_the_tolerance_is_reached(distro: Distro, plugin: str) -> None:
    manager = _cell(distro, plugin)
    _grip(manager, 0.02)
    ended = only(wait(manager, 2.0), GripperEnded)
    assert (ended.status, ended.reached_goal, ended.stalled) == (GoalStatus.SUCCEEDED, True, False)


@row("6", 4)
@pytest.mark.parametrize(("distro", "plugin"), _BOTH)
@pytest.mark.parametrize(("allowed", "status"), [(False, GoalStatus.ABORTED), (True, GoalStatus.SUCCEEDED)])
def test_stall_ends_as_the_parameter_says(distro: Distro, plugin: str, allowed: bool, status: GoalStatus) -> None:
    manager = _cell(distro, plugin, {"allow_stalling": allowed})
    manager.disturbances.disturb("f", JointFault(lower=0.0, upper=0.01))
    sent_ns = manager.now_ns
    _grip(manager, 0.03)
    ended = only(wait(manager, 2.0), GripperEnded)
    assert (ended.status, ended.reached_goal, ended.stalled) == (status, False, True)
    # 10 mm at 0.2 m/s, then 0.3 s without motion
    assert (ended.decided_ns - sent_ns) / S == pytest.approx(0.35, abs=0.01)


@row("6", 5)
@pytest.mark.parametrize(("distro", "plugin"), _BOTH)
def test_cancel_holds_and_the_result_is_empty(distro: Distro, plugin: str) -> None:
    manager = _cell(distro, plugin)
    goal = _grip(manager, 0.04)
    wait(manager, 0.1)
    at = manager.state("f/position")
    manager.cancel_goal(goal)
    ended = only(wait(manager, 1.0), GripperEnded)
    assert (ended.status, ended.position, ended.reached_goal, ended.stalled) == (GoalStatus.CANCELED, (), False, False)
    assert manager.state("f/position") == pytest.approx(at, abs=0.001)  # 0.2 m/s for two cycles


@row("6", 6)
@pytest.mark.parametrize(("distro", "plugin"), _BOTH)
def test_goal_that_is_replaced_ends_as_canceled(distro: Distro, plugin: str) -> None:
    manager = _cell(distro, plugin)
    first = _grip(manager, 0.04)
    wait(manager, 0.05)
    second = _grip(manager, 0.0)
    ended = [event for event in wait(manager, 2.0) if isinstance(event, GripperEnded)]
    assert [(e.goal_id, e.status) for e in ended] == [(first, GoalStatus.CANCELED), (second, GoalStatus.SUCCEEDED)]
    assert ended[0].position == ()


@row("6", 7)
def test_success_is_seen_before_the_new_command_is_written() -> None:
    manager = _cell(Distro.KILTED, PARALLEL)
    sent_ns = manager.now_ns
    _grip(manager, 0.0005)  # inside the tolerance where it stands
    ended = only(wait(manager, 1.0), GripperEnded)
    assert ended.reached_goal
    assert ended.decided_ns - sent_ns <= manager.period_ns
    assert ended.position == (0.0,)


@row("6", 8)
def test_result_has_one_position_and_one_effort() -> None:
    manager = _cell(Distro.KILTED, PARALLEL)
    _grip(manager, 0.02)
    ended = only(wait(manager, 2.0), GripperEnded)
    assert len(ended.position) == len(ended.effort) == 1
    assert ended.position[0] == pytest.approx(0.019, abs=0.0005)  # as soon as inside 1 mm


@row("6", 9)
def test_without_dynamics_stall_time_begins_with_acceptance() -> None:
    manager = _cell(Distro.KILTED, PARALLEL, description=urdf(dynamics=False))
    manager.disturbances.disturb("f", JointFault(stuck=True))
    sent_ns = manager.now_ns
    _grip(manager, 0.03)
    ended = only(wait(manager, 2.0), GripperEnded)
    assert ended.stalled
    assert (ended.decided_ns - sent_ns) / S == pytest.approx(0.3, abs=0.005)
