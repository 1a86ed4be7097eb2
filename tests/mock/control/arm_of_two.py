"""A small cell of our own for tests that need no recorded answer: two arm joints and a finger at 500 Hz."""

from __future__ import annotations

from cellc.mock.control import ControlEvent, ControllerManager

S = 1_000_000_000
MS = 1_000_000

_LIMIT = '<limit lower="{lower}" upper="{upper}" velocity="{velocity}" effort="9"/>'


def _joint(name: str, kind: str, limit: str) -> str:
    link = f'<link name="{name}_link"/>'
    return f'{link}<joint name="{name}" type="{kind}"><parent link="base"/><child link="{name}_link"/>{limit}</joint>'


def _part(name: str) -> str:
    states = '<state_interface name="position"/><state_interface name="velocity"/>'
    return f'<joint name="{name}"><command_interface name="position"/>{states}</joint>'


def urdf(dynamics: bool = True) -> str:
    """The robot description."""
    arm = "".join(_joint(name, "revolute", _LIMIT.format(lower=-3, upper=3, velocity=2)) for name in ("a", "b"))
    finger = _joint("f", "prismatic", _LIMIT.format(lower=0, upper=0.04, velocity=0.2))
    parameter = f'<param name="calculate_dynamics">{str(dynamics).lower()}</param>'
    hardware = f"<hardware><plugin>mock_components/GenericSystem</plugin>{parameter}</hardware>"
    return (
        f'<robot name="r"><link name="base"/>{arm}{finger}'
        f'<ros2_control name="arm_hw" type="system">{hardware}{_part("a")}{_part("b")}'
        '<sensor name="wrist"><state_interface name="force.z"/></sensor></ros2_control>'
        f'<ros2_control name="hand_hw" type="system">{hardware}{_part("f")}</ros2_control></robot>'
    )


def parameters(gripper: str = "parallel_gripper_action_controller/GripperActionController", extra: str = "") -> str:
    """The parameter file."""
    return f"""
controller_manager:
  ros__parameters:
    update_rate: 500
    joints: {{type: joint_state_broadcaster/JointStateBroadcaster}}
    arm: {{type: joint_trajectory_controller/JointTrajectoryController{extra}}}
    hand: {{type: {gripper}}}
    forward: {{type: forward_command_controller/ForwardCommandController}}
    wrench: {{type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster}}
arm:
  ros__parameters:
    joints: [a, b]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
    constraints: {{goal_time: 0.5, a: {{trajectory: 0.2, goal: 0.01}}, b: {{trajectory: 0.2, goal: 0.01}}}}
hand:
  ros__parameters: {{joint: f, goal_tolerance: 0.001, allow_stalling: true, stall_timeout: 0.3}}
forward:
  ros__parameters: {{joints: [a, b], interface_name: position}}
wrench:
  ros__parameters: {{frame_id: wrist_link, interface_names: {{force: {{z: wrist/force.z}}}}}}
"""


def started(manager: ControllerManager) -> ControllerManager:
    """Bring the usual controllers up and let half a second pass."""
    assert manager.spawn(["joints", "arm", "hand"]).ok
    run(manager, S // 2)
    return manager


def run(manager: ControllerManager, duration_ns: int) -> list[ControlEvent]:
    """Let time pass and collect what happens."""
    until_ns = manager.now_ns + duration_ns
    events: list[ControlEvent] = list(manager.take_events())
    while manager.advance(until_ns) < until_ns:
        events.extend(manager.take_events())
    return [*events, *manager.take_events()]
