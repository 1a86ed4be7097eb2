"""Plugin types of controllers and the behaviours that they stand for.

The types of ros2_controllers are known here; those of vendors are told by the caller as `plugin_behaviours`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.mock.control.controllers.base import Context, Controller
from cellc.mock.control.controllers.broadcasters import (
    DeclaredController,
    ForceTorqueBroadcaster,
    JointStateBroadcaster,
    PassiveBroadcaster,
)
from cellc.mock.control.controllers.forward_command import ForwardCommandController, GpioCommandController
from cellc.mock.control.controllers.gripper import EFFORT, PARALLEL, POSITION, GripperController
from cellc.mock.control.controllers.joint_trajectory import JointTrajectoryController
from cellc.mock.control.controllers.pid import PidController
from cellc.vocabulary import Behaviour, Distro

HARDWARE_BEHAVIOURS: Mapping[str, str] = {"mock_components/GenericSystem": "generic_system"}

_FACTORIES: Mapping[Behaviour, Callable[[Context], Controller]] = {
    Behaviour.JOINT_TRAJECTORY: lambda context: JointTrajectoryController(context, scaled=False),
    Behaviour.SCALED_JOINT_TRAJECTORY: lambda context: JointTrajectoryController(context, scaled=True),
    Behaviour.PARALLEL_GRIPPER: lambda context: GripperController(context, PARALLEL),
    Behaviour.POSITION_GRIPPER: lambda context: GripperController(context, POSITION),
    Behaviour.EFFORT_GRIPPER: lambda context: GripperController(context, EFFORT),
    Behaviour.FORWARD_COMMAND: lambda context: ForwardCommandController(context, ""),
    Behaviour.MULTI_INTERFACE_FORWARD_COMMAND: lambda context: ForwardCommandController(context, "multi"),
    Behaviour.FORWARD_POSITION: lambda context: ForwardCommandController(context, "position"),
    Behaviour.FORWARD_VELOCITY: lambda context: ForwardCommandController(context, "velocity"),
    Behaviour.FORWARD_EFFORT: lambda context: ForwardCommandController(context, "effort"),
    Behaviour.JOINT_STATE_BROADCASTER: JointStateBroadcaster,
    Behaviour.FORCE_TORQUE_SENSOR_BROADCASTER: ForceTorqueBroadcaster,
    Behaviour.GPIO_COMMAND: GpioCommandController,
    Behaviour.PID: PidController,
    Behaviour.PASSIVE_BROADCASTER: PassiveBroadcaster,
    Behaviour.BROADCASTER: DeclaredController,
    Behaviour.SERVICE: DeclaredController,
}

_ALL = tuple(Distro)
_BEFORE_LYRICAL = (Distro.HUMBLE, Distro.JAZZY, Distro.KILTED)
_SINCE_JAZZY = (Distro.JAZZY, Distro.KILTED, Distro.LYRICAL)
# Behaviour and distributions of each type (facts/ros2_control.md §4).
_TYPES: Mapping[str, tuple[Behaviour, tuple[Distro, ...]]] = {
    "joint_trajectory_controller/JointTrajectoryController": (Behaviour.JOINT_TRAJECTORY, _ALL),
    "joint_state_broadcaster/JointStateBroadcaster": (Behaviour.JOINT_STATE_BROADCASTER, _ALL),
    "forward_command_controller/ForwardCommandController": (Behaviour.FORWARD_COMMAND, _ALL),
    "forward_command_controller/MultiInterfaceForwardCommandController": (
        Behaviour.MULTI_INTERFACE_FORWARD_COMMAND,
        _ALL,
    ),
    "position_controllers/JointGroupPositionController": (Behaviour.FORWARD_POSITION, _BEFORE_LYRICAL),
    "velocity_controllers/JointGroupVelocityController": (Behaviour.FORWARD_VELOCITY, _BEFORE_LYRICAL),
    "effort_controllers/JointGroupEffortController": (Behaviour.FORWARD_EFFORT, _BEFORE_LYRICAL),
    "position_controllers/GripperActionController": (Behaviour.POSITION_GRIPPER, (Distro.HUMBLE, Distro.JAZZY)),
    "effort_controllers/GripperActionController": (Behaviour.EFFORT_GRIPPER, (Distro.HUMBLE, Distro.JAZZY)),
    "parallel_gripper_action_controller/GripperActionController": (Behaviour.PARALLEL_GRIPPER, _SINCE_JAZZY),
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": (Behaviour.FORCE_TORQUE_SENSOR_BROADCASTER, _ALL),
    "imu_sensor_broadcaster/IMUSensorBroadcaster": (Behaviour.PASSIVE_BROADCASTER, _ALL),
    "pose_broadcaster/PoseBroadcaster": (Behaviour.PASSIVE_BROADCASTER, _SINCE_JAZZY),
    "range_sensor_broadcaster/RangeSensorBroadcaster": (Behaviour.PASSIVE_BROADCASTER, _ALL),
    "gpio_controllers/GpioCommandController": (Behaviour.GPIO_COMMAND, _ALL),
    "pid_controller/PidController": (Behaviour.PID, _ALL),
}


def controller_factory(
    plugin_type: str, distro: Distro, behaviours: Mapping[str, Behaviour]
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
        return _FACTORIES[behaviours[plugin_type]]
    behaviour, distros = _TYPES.get(plugin_type, (None, ()))
    return None if behaviour is None or distro not in distros else _FACTORIES[behaviour]
