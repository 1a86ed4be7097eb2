"""Plugin types of controllers and the behaviors that they stand for.

The types of ros2_controllers are known here; those of vendors are reported by the caller as `plugin_behaviours`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.contract.vocabulary import Behaviour, Distro
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

HARDWARE_BEHAVIOURS: Mapping[str, str] = {"mock_components/GenericSystem": "generic_system"}

_FACTORIES: Mapping[Behaviour, Callable[[Context], Controller]] = {
    Behaviour.JOINT_TRAJECTORY: lambda context: JointTrajectoryController(context, scaled=False),
    Behaviour.SCALED_JOINT_TRAJECTORY: lambda context: JointTrajectoryController(context, scaled=True),
    Behaviour.PARALLEL_GRIPPER: lambda context: GripperController(context, PARALLEL),
    Behaviour.POSITION_GRIPPER: lambda context: GripperController(context, POSITION),
    Behaviour.FORWARD_COMMAND: ForwardCommandController,
    Behaviour.MULTI_INTERFACE_FORWARD_COMMAND: MultiInterfaceForwardCommandController,
    Behaviour.JOINT_STATE_BROADCASTER: JointStateBroadcaster,
    Behaviour.FORCE_TORQUE_SENSOR_BROADCASTER: ForceTorqueBroadcaster,
    Behaviour.GPIO_COMMAND: GpioCommandController,
    Behaviour.PID: PidController,
    Behaviour.BROADCASTER: DeclaredController,
    Behaviour.SERVICE: DeclaredController,
    Behaviour.OWN_MOTION: DeclaredController,
}

_ALL = tuple(Distro)
_SINCE_JAZZY = (Distro.JAZZY, Distro.KILTED, Distro.LYRICAL)
# Behavior and distributions of each type.
_TYPES: Mapping[str, tuple[Behaviour, tuple[Distro, ...]]] = {
    "joint_trajectory_controller/JointTrajectoryController": (Behaviour.JOINT_TRAJECTORY, _ALL),
    "joint_state_broadcaster/JointStateBroadcaster": (Behaviour.JOINT_STATE_BROADCASTER, _ALL),
    "forward_command_controller/ForwardCommandController": (Behaviour.FORWARD_COMMAND, _ALL),
    "forward_command_controller/MultiInterfaceForwardCommandController": (
        Behaviour.MULTI_INTERFACE_FORWARD_COMMAND,
        _ALL,
    ),
    "position_controllers/GripperActionController": (Behaviour.POSITION_GRIPPER, (Distro.HUMBLE, Distro.JAZZY)),
    "parallel_gripper_action_controller/GripperActionController": (Behaviour.PARALLEL_GRIPPER, _SINCE_JAZZY),
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": (Behaviour.FORCE_TORQUE_SENSOR_BROADCASTER, _ALL),
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
        behaviours: behaviors of further types.

    Returns:
        The factory, None where no package offers the type.
    """
    if plugin_type in behaviours:
        return _FACTORIES[behaviours[plugin_type]]
    behaviour, distros = _TYPES.get(plugin_type, (None, ()))
    return None if behaviour is None or distro not in distros else _FACTORIES[behaviour]
