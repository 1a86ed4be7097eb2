"""The parameter file of the controller manager against what its readers declare."""

from __future__ import annotations

from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import pytest

from tests.cells import DISTROS, spec_text
from tests.emit.cells import CELLS, artifacts_of, emitted
from tests.foreign_yaml import safe_load
from tests.oracles.parameters import declarations

_TRAJECTORY = "joint_trajectory_controller__joint_trajectory_controller"
_DECLARED_IN = {
    "joint_trajectory_controller/JointTrajectoryController": _TRAJECTORY,
    "ur_controllers/ScaledJointTrajectoryController": _TRAJECTORY,
    "joint_state_broadcaster/JointStateBroadcaster": "joint_state_broadcaster__joint_state_broadcaster",
    "parallel_gripper_action_controller/GripperActionController": (
        "parallel_gripper_controller__gripper_action_controller"
    ),
    "position_controllers/GripperActionController": "gripper_controllers__gripper_action_controller",
    "ur_controllers/GPIOController": "gpio_controller",
    "ur_controllers/SpeedScalingStateBroadcaster": "speed_scaling_state_broadcaster",
    "ur_controllers/URConfigurationController": "ur_configuration_controller",
    "pose_broadcaster/PoseBroadcaster": "pose_broadcaster__pose_broadcaster",
}
# Universal_Robots_ROS2_Driver, scaled_joint_trajectory_controller.cpp: declared in code, not in a parameter file.
_OWN = {
    "ur_controllers/ScaledJointTrajectoryController": {"speed_scaling_interface_name": "string"},
    # franka_ros2 2.5.0 and 3.4.0, franka_robot_state_broadcaster_parameters.yaml:10.
    "franka_robot_state_broadcaster/FrankaRobotStateBroadcaster": {
        "robot_type": "string",
        "arm_prefix": "string",
        "convenience_publish_rate": "int",
    },
}
_TYPES = {"bool": bool, "int": int, "double": float, "string": str, "string_array": list, "double_array": list}


def _controllers(text: str) -> dict[str, Any]:
    loaded = safe_load(text)
    assert isinstance(loaded, dict)
    return loaded


def _flat(tree: dict[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


def _declared(distro: str, plugin: str, joints: list[str]) -> dict[str, str]:
    """Return the type of each parameter that the real controller declares, maps over joints filled in."""
    if plugin not in _DECLARED_IN:
        return _OWN[plugin]
    found = {name: said["type"] for name, said in declarations(_DECLARED_IN[plugin], distro).items()}
    per_joint = {name.replace("__map_joints", joint): value for name, value in found.items() for joint in joints}
    return found | per_joint | _OWN.get(plugin, {})


@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize("cell", CELLS)
def test_every_parameter_is_declared_with_its_type(cell: str, distro: str) -> None:
    artifacts = artifacts_of(cell, distro)
    files = [path for path in artifacts if fnmatch(path, "config/controllers*.yaml")]
    assert files
    for sections in (_controllers(artifacts[file]) for file in files):
        manager = sections.pop("controller_manager")["ros__parameters"]
        sections.pop("mujoco_ros2_control_node", None)  # of the plugin: tests/consumers/test_simulator.py
        assert sections
        for name, section in sections.items():
            parameters = section["ros__parameters"]
            declared = _declared(distro, manager[name]["type"], parameters.get("joints", []))
            for parameter, value in _flat(parameters):
                assert parameter in declared, f"{name}: {parameter} on {distro}"
                assert type(value) is _TYPES[declared[parameter]], f"{name}: {parameter} = {value!r}"


def test_manager_learns_rate_and_plugins() -> None:
    manager = _controllers(artifacts_of("ur5e_pick")["config/controllers.yaml"])["controller_manager"]
    assert manager == {
        "ros__parameters": {
            "update_rate": 500,
            # UR 3.8.0 ur_controllers.yaml: limits are taken from the lagging position.
            "enforce_command_limits": False,
            # Its activation moves the fingers: robotiq_driver hardware_interface.cpp, on_activate.
            "hardware_components_initial_state": {"unconfigured": ["gripper_hardware"]},
            "joint_states": {"type": "joint_state_broadcaster/JointStateBroadcaster"},
            "arm_trajectory": {"type": "ur_controllers/ScaledJointTrajectoryController"},
            "gripper_action": {"type": "parallel_gripper_action_controller/GripperActionController"},
            "arm_io": {"type": "ur_controllers/GPIOController"},
            "arm_speed": {"type": "ur_controllers/SpeedScalingStateBroadcaster"},
            "arm_tcp": {"type": "pose_broadcaster/PoseBroadcaster"},
            "arm_software": {"type": "ur_controllers/URConfigurationController"},
        }
    }


def test_update_rate_is_an_integer() -> None:
    # Observed: `update_rate: 100.0` makes the manager abort.
    manager = _controllers(artifacts_of("ur5e_pick")["config/controllers.yaml"])["controller_manager"]
    assert type(manager["ros__parameters"]["update_rate"]) is int


def test_tolerances_are_doubles_for_every_joint() -> None:
    # Written as `goal_time: 1` the real controller is not loaded: observed, real_controller_manager.md.
    sections = _controllers(artifacts_of("ur5e_pick")["config/controllers.yaml"])
    constraints = sections["arm_trajectory"]["ros__parameters"]["constraints"]
    assert constraints["goal_time"] == 1.0
    assert isinstance(constraints["goal_time"], float)
    joints = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
    assert {name: constraints[f"arm_{name}_joint"] for name in joints} == {
        name: {"trajectory": 0.2, "goal": 0.01} for name in joints
    }


def test_namespaced_manager_gets_keys_with_its_namespace(tmp_path: Path) -> None:
    # Observed: with namespace /cell, plain top-level keys do not match and nothing loads.
    text = spec_text("minimal").replace("control:\n", "control:\n  namespace: /cell\n")
    sections = _controllers(emitted(tmp_path, text)["config/controllers.yaml"])
    named = ["arm_io", "arm_trajectory", "controller_manager", "gripper_action"]
    assert sorted(sections) == [f"/cell/{name}" for name in named]


def test_no_section_is_empty() -> None:
    # Observed: a node key without ros__parameters below it makes the manager abort.
    for section in _controllers(artifacts_of("minimal")["config/controllers.yaml"]).values():
        assert section["ros__parameters"]
