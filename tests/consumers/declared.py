"""What controllers say of the parameters that they are given, by what they declare."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from tests.oracles.parameters import declarations

_FILES = {
    "joint_trajectory_controller/JointTrajectoryController": "joint_trajectory_controller__joint_trajectory_controller",
    "ur_controllers/ScaledJointTrajectoryController": "joint_trajectory_controller__joint_trajectory_controller",
    "joint_state_broadcaster/JointStateBroadcaster": "joint_state_broadcaster__joint_state_broadcaster",
    "parallel_gripper_action_controller/GripperActionController": (
        "parallel_gripper_controller__gripper_action_controller"
    ),
    "position_controllers/GripperActionController": "gripper_controllers__gripper_action_controller",
    "forward_command_controller/ForwardCommandController": "forward_command_controller__forward_command_controller",
    "gpio_controllers/GpioCommandController": "gpio_controllers__gpio_command_controller",
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": (
        "force_torque_sensor_broadcaster__force_torque_sensor_broadcaster"
    ),
    "ur_controllers/GPIOController": "gpio_controller",
    "controller_manager": "controller_manager__controller_manager",
}
# Declared in code, not in a parameter file: scaled_joint_trajectory_controller.cpp of Universal_Robots_ROS2_Driver.
_IN_CODE = {
    "ur_controllers/ScaledJointTrajectoryController": {
        "speed_scaling_interface_name": {"type": "string", "default_value": "speed_scaling/speed_scaling_factor"}
    }
}
_TEXT: Mapping[str, Any] = {"type": "string", "default_value": ""}
_NAME: Mapping[str, Any] = {"type": "string", "default_value": "", "validation": {"not_empty<>": None}}
# State alone, with few parameters: Universal_Robots_ROS2_Driver 3.8.0 ur_controllers/src/*_parameters.yaml,
# ros2_controllers 4.36.0 pose_broadcaster_parameters.yaml, franka_ros2 2.5.0
# franka_robot_state_broadcaster_parameters.yaml, picknik_controllers c605b68 picknik_reset_fault_controller.cpp, which
# declares none.
_BROADCASTERS: Mapping[str, Mapping[str, Any]] = {
    "ur_controllers/SpeedScalingStateBroadcaster": {
        "tf_prefix": _TEXT,
        "state_publish_rate": {"type": "double", "default_value": 100.0},
    },
    "ur_controllers/URConfigurationController": {"tf_prefix": _TEXT},
    "pose_broadcaster/PoseBroadcaster": {
        "frame_id": _NAME,
        "pose_name": _NAME,
        "tf.enable": {"type": "bool", "default_value": True},
        "tf.child_frame_id": _TEXT,
    },
    "franka_robot_state_broadcaster/FrankaRobotStateBroadcaster": {
        "robot_type": _TEXT,
        "arm_prefix": _TEXT,
        "convenience_publish_rate": {"type": "int", "default_value": 1000},
    },
    "picknik_reset_fault_controller/PicknikResetFaultController": {},
}
# Of older declarations the default is empty, and the code that reads it refuses that.
_TRAJECTORY = ("joints", "command_interfaces", "state_interfaces")
_NEEDED_IN_CODE = {
    "joint_trajectory_controller/JointTrajectoryController": _TRAJECTORY,
    "ur_controllers/ScaledJointTrajectoryController": _TRAJECTORY,
    "position_controllers/GripperActionController": ("joint",),
    "forward_command_controller/ForwardCommandController": ("joints", "interface_name"),
}
# Without a default in the file, and set in code: the recorded managers come up without it.
_SET_IN_CODE = {"controller_manager": ("overruns.print_warnings",)}
# ros2_control.md 5.1, valid sets; joint_trajectory_controller/validate_jtc_parameters.hpp.
_COMMANDS = (
    {"position"},
    {"position", "velocity"},
    {"position", "velocity", "acceleration"},
    {"velocity"},
    {"effort"},
    {"position", "effort"},
)
_STATES = ({"position"}, {"position", "velocity"}, {"position", "velocity", "acceleration"})
_PYTHON = {
    "bool": (bool, None),
    "int": (int, None),
    "double": (float, None),
    "string": (str, None),
    "string_array": (list, str),
    "double_array": (list, float),
    "int_array": (list, int),
}


@dataclass(frozen=True, slots=True)
class Parameter:
    """One declaration: its type, whether it has to be given, and its validators with their arguments."""

    type: str
    required: bool
    validators: Mapping[str, Any]


@lru_cache(maxsize=64)
def declared(distro: str, plugin: str) -> dict[str, Parameter]:
    """Return the declarations of a controller by name, with ``__map_…`` parts where a key of any name fits."""
    if plugin in _BROADCASTERS:
        return _parameters(_BROADCASTERS[plugin])
    found = _parameters({**declarations(_FILES[plugin], distro), **_IN_CODE.get(plugin, {})})
    if (distro, plugin) == ("humble", "controller_manager"):  # declared in code there, most of it with a default
        found = {name: Parameter(one.type, False, {}) for name, one in found.items()}
        return {**found, "update_rate": Parameter("int", True, {"gt": 0})}
    return found


def _parameters(tree: Mapping[str, Mapping[str, Any]]) -> dict[str, Parameter]:
    found = {}
    for name, value in tree.items():
        validators = {name.removesuffix("<>"): said for name, said in (value.get("validation") or {}).items()}
        found[name] = Parameter(value["type"], _must_be_given(value, validators), validators)
    return found


def _must_be_given(value: Mapping[str, Any], validators: Mapping[str, Any]) -> bool:
    """Without a default, or with one that its own validator refuses (``joints: []``), it has to be given."""
    if "default_value" not in value:
        return True
    default = value["default_value"]
    return default in ([], "") and any(name in validators for name in ("size_gt", "not_empty"))


def match(distro: str, plugin: str, name: str) -> Parameter | None:
    """Return the declaration of a parameter; a ``__map_`` part stands for any one key."""
    parts = name.split(".")
    for known, parameter in declared(distro, plugin).items():
        pattern = known.split(".")
        fits = (one.startswith("__map_") or one == other for one, other in zip(pattern, parts, strict=False))
        if len(pattern) == len(parts) and all(fits):
            return parameter
    return None


def complaints(distro: str, plugin: str, values: Mapping[str, Any]) -> list[str]:
    """Return what the controller would say of its parameters, flat names with their values."""
    said: list[str] = []
    for name, value in values.items():
        parameter = match(distro, plugin, name)
        if parameter is None:
            said.append(f"{name} is not declared")
        elif not _has_type(value, parameter.type):
            said.append(f"{name} is of type {parameter.type}, {value!r} is not allowed")
        else:
            said += [f"{name} = {value!r}: {fault}" for fault in _faults(value, parameter)]
    needed = {name for name, one in declared(distro, plugin).items() if one.required and "__map_" not in name}
    needed |= set(_NEEDED_IN_CODE.get(plugin, ()))
    needed -= set(_SET_IN_CODE.get(plugin, ()))
    return said + [f"{name} is not given" for name in sorted(needed) if not values.get(name)]


def _has_type(value: object, name: str) -> bool:
    kind, inner = _PYTHON[name.split("_fixed")[0]]
    if type(value) is not kind:
        return False
    return inner is None or (isinstance(value, list) and all(type(item) is inner for item in value))


def _faults(value: Any, parameter: Parameter) -> Iterator[str]:
    for name, said in parameter.validators.items():
        if not _accepted(name, value, said):
            yield f"{name} {said}"


def _accepted(name: str, value: Any, said: Any) -> bool:
    bound = said[0] if isinstance(said, list) and said else said
    checks: dict[str, Callable[[], bool]] = {
        "unique": lambda: bool(len(set(value)) == len(value)),
        "size_gt": lambda: bool(len(value) > bound),
        "not_empty": lambda: bool(len(value) > 0),
        "subset_of": lambda: bool(set(value) <= set(bound)),
        "one_of": lambda: bool(value in bound),
        "gt": lambda: bool(value > bound),
        "gt_eq": lambda: bool(value >= bound),
        "bounds": lambda: bool(math.isfinite(value) and said[0] <= value <= said[1]),
        "joint_trajectory_controller::command_interface_type_combinations": lambda: bool(set(value) in _COMMANDS),
        "joint_trajectory_controller::state_interface_type_combinations": lambda: bool(set(value) in _STATES),
    }
    return checks[name]()


@lru_cache(maxsize=8)
def known_plugins(distro: str) -> set[str]:
    """Return the controller types of a distribution whose declarations are known here."""
    return {plugin for plugin, file in _FILES.items() if declarations(file, distro)} | set(_BROADCASTERS)
