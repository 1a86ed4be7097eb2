"""Plugin types of controllers and the behaviors that they stand for.

The types of ros2_controllers are known here; those of vendors are reported by the caller as `plugin_behaviors`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.contract.vocabulary import Behavior, Distro
from cellc.mock.control.controllers.base import Context, Controller
from cellc.mock.control.controllers.broadcasters import (
    DeclaredController,
    ForceTorqueBroadcaster,
    JointStateBroadcaster,
)
from cellc.mock.control.controllers.forward_command import (
    ForwardCommandController,
    GpioCommandController,
    MultiInterfaceForwardCommandController,
)
from cellc.mock.control.controllers.gripper import PARALLEL, POSITION, GripperController
from cellc.mock.control.controllers.joint_trajectory import JointTrajectoryController
from cellc.mock.control.controllers.pid import PidController

HARDWARE_BEHAVIORS: Mapping[str, str] = {"mock_components/GenericSystem": "generic_system"}

_FACTORIES: Mapping[Behavior, Callable[[Context], Controller]] = {
    Behavior.JOINT_TRAJECTORY: lambda context: JointTrajectoryController(context, scaled=False),
    Behavior.SCALED_JOINT_TRAJECTORY: lambda context: JointTrajectoryController(context, scaled=True),
    Behavior.PARALLEL_GRIPPER: lambda context: GripperController(context, PARALLEL),
    Behavior.POSITION_GRIPPER: lambda context: GripperController(context, POSITION),
    Behavior.FORWARD_COMMAND: ForwardCommandController,
    Behavior.MULTI_INTERFACE_FORWARD_COMMAND: MultiInterfaceForwardCommandController,
    Behavior.JOINT_STATE_BROADCASTER: JointStateBroadcaster,
    Behavior.FORCE_TORQUE_SENSOR_BROADCASTER: ForceTorqueBroadcaster,
    Behavior.GPIO_COMMAND: GpioCommandController,
    Behavior.PID: PidController,
    Behavior.BROADCASTER: DeclaredController,
    Behavior.SERVICE: DeclaredController,
    Behavior.OWN_MOTION: DeclaredController,
}

_ALL = tuple(Distro)
_SINCE_JAZZY = (Distro.JAZZY, Distro.KILTED, Distro.LYRICAL)
# Behavior and distributions of each type.
_TYPES: Mapping[str, tuple[Behavior, tuple[Distro, ...]]] = {
    "joint_trajectory_controller/JointTrajectoryController": (Behavior.JOINT_TRAJECTORY, _ALL),
    "joint_state_broadcaster/JointStateBroadcaster": (Behavior.JOINT_STATE_BROADCASTER, _ALL),
    "forward_command_controller/ForwardCommandController": (Behavior.FORWARD_COMMAND, _ALL),
    "forward_command_controller/MultiInterfaceForwardCommandController": (
        Behavior.MULTI_INTERFACE_FORWARD_COMMAND,
        _ALL,
    ),
    "position_controllers/GripperActionController": (Behavior.POSITION_GRIPPER, (Distro.HUMBLE, Distro.JAZZY)),
    "parallel_gripper_action_controller/GripperActionController": (Behavior.PARALLEL_GRIPPER, _SINCE_JAZZY),
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": (Behavior.FORCE_TORQUE_SENSOR_BROADCASTER, _ALL),
    "gpio_controllers/GpioCommandController": (Behavior.GPIO_COMMAND, _ALL),
    "pid_controller/PidController": (Behavior.PID, _ALL),
}


def controller_factory(
    plugin_type: str, distro: Distro, behaviors: Mapping[str, Behavior]
) -> Callable[[Context], Controller] | None:
    """Find how to make a controller of a plugin type.

    Args:
        plugin_type: the type as the parameter file tells it.
        distro: ROS distribution.
        behaviors: behaviors of further types.

    Returns:
        The factory, None where no package offers the type.
    """
    if plugin_type in behaviors:
        return _FACTORIES[behaviors[plugin_type]]
    behavior, distros = _TYPES.get(plugin_type, (None, ()))
    return None if behavior is None or distro not in distros else _FACTORIES[behavior]
