"""Plugin types of controllers and the behaviours that they stand for.

The types of ros2_controllers are known here; those of vendors are told by the caller as `plugin_behaviours`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.mock.control.controllers.base import Context, Controller
from cellc.mock.control.controllers.broadcasters import DeclaredController, ForceTorqueBroadcaster, PassiveBroadcaster
from cellc.mock.control.controllers.forward_command import ForwardCommandController
from cellc.mock.control.controllers.gpio import GpioCommandController
from cellc.mock.control.controllers.gripper import EFFORT, PARALLEL, POSITION, GripperController
from cellc.mock.control.controllers.joint_state_broadcaster import JointStateBroadcaster
from cellc.mock.control.controllers.joint_trajectory import JointTrajectoryController
from cellc.mock.control.controllers.pid import PidController

HARDWARE_BEHAVIOURS: Mapping[str, str] = {"mock_components/GenericSystem": "generic_system"}

_FACTORIES: Mapping[str, Callable[[Context], Controller]] = {
    "joint_trajectory": lambda context: JointTrajectoryController(context, scaled=False),
    "scaled_joint_trajectory": lambda context: JointTrajectoryController(context, scaled=True),
    "parallel_gripper": lambda context: GripperController(context, PARALLEL),
    "position_gripper": lambda context: GripperController(context, POSITION),
    "effort_gripper": lambda context: GripperController(context, EFFORT),
    "forward_command": lambda context: ForwardCommandController(context, ""),
    "multi_interface_forward_command": lambda context: ForwardCommandController(context, "multi"),
    "forward_position": lambda context: ForwardCommandController(context, "position"),
    "forward_velocity": lambda context: ForwardCommandController(context, "velocity"),
    "forward_effort": lambda context: ForwardCommandController(context, "effort"),
    "joint_state_broadcaster": JointStateBroadcaster,
    "force_torque_broadcaster": ForceTorqueBroadcaster,
    "gpio_command": GpioCommandController,
    "pid": PidController,
    "passive_broadcaster": PassiveBroadcaster,
    "broadcaster": DeclaredController,
    "service": DeclaredController,
}

_ALL = ("humble", "jazzy", "kilted", "lyrical")
_BEFORE_LYRICAL = ("humble", "jazzy", "kilted")
_SINCE_JAZZY = ("jazzy", "kilted", "lyrical")
# Behaviour and distributions of each type (facts/ros2_control.md §4).
_TYPES: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "joint_trajectory_controller/JointTrajectoryController": ("joint_trajectory", _ALL),
    "joint_state_broadcaster/JointStateBroadcaster": ("joint_state_broadcaster", _ALL),
    "forward_command_controller/ForwardCommandController": ("forward_command", _ALL),
    "forward_command_controller/MultiInterfaceForwardCommandController": ("multi_interface_forward_command", _ALL),
    "position_controllers/JointGroupPositionController": ("forward_position", _BEFORE_LYRICAL),
    "velocity_controllers/JointGroupVelocityController": ("forward_velocity", _BEFORE_LYRICAL),
    "effort_controllers/JointGroupEffortController": ("forward_effort", _BEFORE_LYRICAL),
    "position_controllers/GripperActionController": ("position_gripper", ("humble", "jazzy")),
    "effort_controllers/GripperActionController": ("effort_gripper", ("humble", "jazzy")),
    "parallel_gripper_action_controller/GripperActionController": ("parallel_gripper", _SINCE_JAZZY),
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": ("force_torque_broadcaster", _ALL),
    "imu_sensor_broadcaster/IMUSensorBroadcaster": ("passive_broadcaster", _ALL),
    "pose_broadcaster/PoseBroadcaster": ("passive_broadcaster", _SINCE_JAZZY),
    "range_sensor_broadcaster/RangeSensorBroadcaster": ("passive_broadcaster", _ALL),
    "gpio_controllers/GpioCommandController": ("gpio_command", _ALL),
    "pid_controller/PidController": ("pid", _ALL),
}


def controller_factory(
    plugin_type: str, distro: str, behaviours: Mapping[str, str]
) -> Callable[[Context], Controller] | None:
    """Find how to make a controller of a plugin type.

    Args:
        plugin_type: the type as the parameter file tells it.
        distro: ROS distribution.
        behaviours: behaviours of further types.

    Returns:
        The factory, None where no package offers the type.
    """
    if plugin_type in behaviours:
        return _FACTORIES.get(behaviours[plugin_type])
    behaviour, distros = _TYPES.get(plugin_type, ("", ()))
    return _FACTORIES[behaviour] if distro in distros else None
