"""Blocks of cycles give bit by bit what single cycles give, whatever the pieces that time is advanced in."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from cellc.mock.control import (
    ControlEvent,
    ControllerManager,
    GripperGoal,
    JointFault,
    JointStateBlock,
    JointTolerance,
    Noise,
    Recording,
    Strictness,
    TrajectoryGoal,
    TrajectoryPoint,
)
from cellc.mock.control.manager.cycles import CycleRunner

from .arm_of_two import MS, S

_JOINTS = ("a", "b", "c")


def _urdf(parameters: str) -> str:
    joints = "".join(
        f'<joint name="{name}" type="{kind}"><parent link="base"/><child link="{name}_link"/>'
        '<limit lower="-3" upper="3" velocity="2" effort="9"/></joint>'
        for name, kind in (("a", "revolute"), ("b", "continuous"), ("c", "revolute"))
    )
    arm = "".join(
        f'<joint name="{name}"><command_interface name="position"/><command_interface name="velocity"/>'
        '<state_interface name="position"/><state_interface name="velocity"/><state_interface name="acceleration"/>'
        "</joint>"
        for name in _JOINTS
    )
    finger = (
        '<joint name="f" type="prismatic"><parent link="base"/><child link="f_link"/>'
        '<limit lower="0" upper="0.04" velocity="0.2" effort="9"/></joint>'
        '<joint name="g" type="prismatic"><parent link="base"/><child link="g_link"/>'
        '<limit lower="0" upper="0.04" velocity="0.2" effort="9"/><mimic joint="f"/></joint>'
    )
    links = "".join(f'<link name="{name}_link"/>' for name in (*_JOINTS, "f", "g"))
    plugin = "<plugin>mock_components/GenericSystem</plugin>"
    return (
        f'<robot name="r"><link name="base"/>{links}{joints}{finger}'
        f'<ros2_control name="arm" type="system"><hardware>{plugin}{parameters}</hardware>{arm}'
        '<gpio name="scaling"><command_interface name="factor"/><state_interface name="factor">'
        '<param name="initial_value">1.0</param></state_interface></gpio></ros2_control>'
        f'<ros2_control name="hand" type="system"><hardware>{plugin}</hardware><joint name="f">'
        '<command_interface name="position"/><state_interface name="position"/><state_interface name="velocity"/>'
        '</joint><joint name="g"><state_interface name="position"/></joint></ros2_control></robot>'
    )


def _parameters(extra: str) -> str:
    return f"""
controller_manager:
  ros__parameters:
    update_rate: 250
    joints: {{type: joint_state_broadcaster/JointStateBroadcaster}}
    slow_joints: {{type: joint_state_broadcaster/JointStateBroadcaster}}
    arm: {{type: joint_trajectory_controller/JointTrajectoryController}}
    hand: {{type: parallel_gripper_action_controller/GripperActionController}}
    speed: {{type: forward_command_controller/ForwardCommandController}}
slow_joints:
  ros__parameters: {{update_rate: 50}}
arm:
  ros__parameters:
    joints: [a, b, c]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
    speed_scaling: {{state_interface: scaling/factor}}
    {extra}
    constraints:
      goal_time: 0.4
      a: {{trajectory: 0.2, goal: 0.01}}
      b: {{trajectory: 0.2, goal: 0.01}}
      c: {{trajectory: 0.2, goal: 0.01}}
hand:
  ros__parameters: {{joint: f, goal_tolerance: 0.001, stall_timeout: 0.2}}
speed:
  ros__parameters: {{joints: [a, b, c], interface_name: velocity}}
"""


def _goal(*points: tuple[float, float, float, float], velocity: bool = False) -> TrajectoryGoal:
    """Points as time in seconds and three positions."""
    velocities = (0.0, 0.0, 0.0) if velocity else ()
    return TrajectoryGoal(
        _JOINTS,
        tuple(TrajectoryPoint((x, y, z), velocities, time_from_start_ns=round(t * S)) for t, x, y, z in points),
        path_tolerance=tuple(JointTolerance(name, -1.0) for name in _JOINTS) if velocity else (),
    )


Action = Callable[[ControllerManager], object]


@dataclass(frozen=True)
class Story:
    """What happens at which times."""

    actions: tuple[tuple[int, Action], ...]
    hardware: str = '<param name="calculate_dynamics">true</param>'
    extra: str = ""


_MOVE = _goal((0.4, 0.3, 0.2, -0.1), (0.9, 0.1, 0.4, 0.2))
STORIES: dict[str, Story] = {
    "motion": Story(((0, lambda m: m.send_goal("arm", _MOVE)), (1200 * MS, lambda m: m.send_goal("arm", _MOVE, True)))),
    "cubic, too fast": Story(((0, lambda m: m.send_goal("arm", _goal((0.3, 1.5, -1.0, 1.0), velocity=True))),)),
    "gripper": Story(
        (
            (0, lambda m: m.send_goal("hand", GripperGoal((0.04,)))),
            (40 * MS, lambda m: m.disturbances.disturb("f", JointFault(upper=0.025))),
            (900 * MS, lambda m: m.disturbances.restore("f", JointFault(upper=0.025))),
            (1000 * MS, lambda m: m.send_goal("hand", GripperGoal((0.0,)))),
        )
    ),
    "stuck": Story(
        (
            (0, lambda m: m.send_goal("arm", _MOVE)),
            (103 * MS, lambda m: m.disturbances.disturb("b", JointFault(stuck=True))),
            (1500 * MS, lambda m: m.send_goal("arm", _MOVE)),
        )
    ),
    "lagging by nature, with noise": Story(
        (
            (
                0,
                lambda m: m.disturbances.disturb(
                    "a", JointFault(time_constant_s=0.02, noise=Noise.of_joint("a", 1e-4, 0))
                ),
            ),
            (5 * MS, lambda m: m.send_goal("arm", _MOVE)),
            (400 * MS, lambda m: m.disturbances.disturb("a", JointFault(max_velocity=0.1))),
            (450 * MS, lambda m: m.disturbances.restore("a", JointFault(max_velocity=0.1))),
        )
    ),
    "slow and lagging": Story(
        (
            (0, lambda m: m.disturbances.disturb("a", JointFault(max_velocity=0.5))),
            (0, lambda m: m.disturbances.disturb("b", JointFault(time_constant_s=0.05))),
            (0, lambda m: m.disturbances.disturb("c", JointFault(offset=0.003))),
            (5 * MS, lambda m: m.send_goal("arm", _MOVE)),
        )
    ),
    "speed scaling": Story(
        (
            (0, lambda m: m.send_goal("arm", _MOVE)),
            (201 * MS, lambda m: m.write_state("scaling/factor", 0.37)),
            (400 * MS, lambda m: m.write_state("scaling/factor", 0.0)),
            (700 * MS, lambda m: m.write_state("scaling/factor", 1.0)),
        )
    ),
    "missed cycles": Story(
        (
            (0, lambda m: m.send_goal("arm", _MOVE)),
            (300 * MS, lambda m: m.disturbances.skip_cycles(7)),
        )
    ),
    "velocity commands": Story(
        (
            (10 * MS, lambda m: m.switch_controllers(["speed"], ["arm"], Strictness.STRICT)),
            (50 * MS, lambda m: m.publish_commands("speed", [0.3, -0.2, 0.1])),
            (800 * MS, lambda m: m.publish_commands("speed", [0.0, 0.5, 0.0])),
        )
    ),
    "cancel and protective stop": Story(
        (
            (0, lambda m: m.send_goal("arm", _MOVE)),
            (333 * MS, lambda m: m.cancel_goal(1)),
            (500 * MS, lambda m: m.send_goal("arm", _MOVE)),
            (650 * MS, lambda m: m.disturbances.protective_stop("arm")),
            (1400 * MS, lambda m: m.disturbances.release("arm")),
        )
    ),
    "read error": Story(
        ((0, lambda m: m.send_goal("arm", _MOVE)), (420 * MS, lambda m: m.disturbances.fail_read("arm")))
    ),
    "following offset, slower controller": Story(
        ((0, lambda m: m.send_goal("arm", _MOVE)),),
        '<param name="position_state_following_offset">0.005</param>',
        "update_rate: 125",
    ),
}


def _forbid_blocks(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(CycleRunner, "_blocks_allowed", lambda self: False)


Result = tuple[list[ControlEvent], JointStateBlock, JointStateBlock, Recording, tuple[str, ...]]


def _play(story: Story, next_step_ns: Callable[[int], int]) -> Result:
    manager = ControllerManager(_urdf(story.hardware), _parameters(story.extra))
    assert manager.spawn(["joints", "slow_joints", "arm", "hand"]).ok
    assert manager.spawn(["speed"], inactive=True).ok
    manager.subscribe_joint_states("joints")
    manager.subscribe_joint_states("slow_joints")
    manager.record("arm", 1000.0)
    manager.take_events()
    events: list[ControlEvent] = []
    start_ns = 101 * MS
    stops = [(start_ns + at_ns, action) for at_ns, action in story.actions]
    for until_ns, action in [*stops, (start_ns + 2500 * MS, None)]:
        while manager.now_ns < until_ns:
            manager.advance(min(until_ns, next_step_ns(manager.now_ns)))
            events.extend(manager.take_events())
        if action is not None:
            action(manager)
    (joints,), (slow,) = manager.take_joint_states("joints"), manager.take_joint_states("slow_joints")
    return events, joints, slow, manager.recording("arm"), tuple(str(line) for line in manager.log.lines())


def _assert_same(first: Result, second: Result) -> None:
    assert first[0] == second[0]
    for index in (1, 2):
        one, other = first[index], second[index]
        assert isinstance(one, JointStateBlock)
        assert isinstance(other, JointStateBlock)
        for field in ("stamps_ns", "positions", "velocities", "efforts"):
            np.testing.assert_array_equal(getattr(one, field), getattr(other, field))
    for field in ("stamps_ns", "desired", "desired_velocity", "actual", "command"):
        np.testing.assert_array_equal(getattr(first[3], field), getattr(second[3], field))
    assert first[4] == second[4]


@pytest.mark.parametrize("name", STORIES)
def test_blocks_equal_single_cycles_bit_by_bit(name: str) -> None:
    story = STORIES[name]
    with pytest.MonkeyPatch.context() as patch:
        _forbid_blocks(patch)
        singly = _play(story, lambda now_ns: now_ns + 4 * MS)
    _assert_same(singly, _play(story, lambda now_ns: now_ns + 4 * MS))
    at_once = _play(story, lambda now_ns: now_ns + 100 * S)
    _assert_same(singly, at_once)
    chance = random.Random(name)
    in_pieces = _play(story, lambda now_ns: now_ns + chance.choice((1, 3 * MS, 17 * MS, 150 * MS, 700 * MS)))
    _assert_same(singly, in_pieces)


def test_stories_end_as_their_names_say() -> None:
    ends = {
        name: [getattr(event, "error_code", None) for event in _play(story, lambda now_ns: now_ns + S)[0]]
        for name, story in STORIES.items()
    }
    assert 0 in ends["motion"]
    assert -4 in ends["stuck"]
    assert 0 in ends["speed scaling"]


def test_cycles_in_which_nothing_is_decided_are_computed_in_blocks() -> None:
    singly: list[int] = []
    run_single = CycleRunner._run_single

    def counted(runner: CycleRunner) -> int:
        singly.append(runner.next_ns)
        return run_single(runner)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(CycleRunner, "_run_single", counted)
        _play(STORIES["motion"], lambda now_ns: now_ns + 100 * S)
    # 2.6 s at 250 Hz are 650 cycles, of which a few begin, decide or end something.
    assert 0 < len(singly) < 65


@pytest.mark.parametrize("start_ns", [0, 5 * S, 5 * S + 1])
def test_first_cycle_is_at_the_start(start_ns: int) -> None:
    manager = ControllerManager(_urdf(""), _parameters(""), start_ns=start_ns)
    assert manager.spawn(["joints"]).ok
    manager.subscribe_joint_states("joints")
    manager.advance(start_ns + 40 * MS)
    (block,) = manager.take_joint_states("joints")
    assert isinstance(block, JointStateBlock)
    assert [int(stamp) - start_ns for stamp in block.stamps_ns[:3]] == [0, 4 * MS, 8 * MS]
