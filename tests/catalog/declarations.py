"""What upstream declares of each kind of controller."""

from __future__ import annotations

import re

from cellc.contract.vocabulary import Distro
from tests.oracles.parameters import Declaration, declarations

# Upstream files behind each kind; on humble the gripper comes from another package.
DECLARATIONS = {
    "joint_trajectory": "joint_trajectory_controller__joint_trajectory_controller",
    "joint_state_broadcaster": "joint_state_broadcaster__joint_state_broadcaster",
    "forward_command": "forward_command_controller__forward_command_controller",
    "force_torque_sensor_broadcaster": ("force_torque_sensor_broadcaster__force_torque_sensor_broadcaster"),
    "gpio_command": "gpio_controllers__gpio_command_controller",
    "multi_interface_forward_command": ("forward_command_controller__multi_interface_forward_command_controller"),
    "parallel_gripper": "parallel_gripper_controller__gripper_action_controller",
    "pid": "pid_controller__pid_controller",
}


def upstream_parameters(kind: str, distro: Distro) -> dict[str, Declaration]:
    file = DECLARATIONS[kind]
    if kind == "parallel_gripper" and distro == "humble":
        file = "gripper_controllers__gripper_action_controller"
    return {_named(name): declared for name, declared in declarations(file, distro).items()}


def _named(name: str) -> str:
    """Return a name with ``<joint>`` in the place of any joint, as the catalog writes it."""
    return re.sub(r"__map_(\w+)", lambda match: f"<{'joint' if match[1] == 'joints' else match[1]}>", name)
