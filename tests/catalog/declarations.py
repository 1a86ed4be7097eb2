"""What upstream declares of each kind of controller, read from its own files."""

from __future__ import annotations

import re
from typing import Any

from cellc.vocabulary import Distro
from tests.foreign_yaml import safe_load
from tests.oracles import UPSTREAM

PARAMETERS = UPSTREAM / "parameters"
# Upstream files behind each kind; on humble the gripper comes from another package.
DECLARATIONS = {
    "joint_trajectory": "joint_trajectory_controller__joint_trajectory_controller_parameters",
    "joint_state_broadcaster": "joint_state_broadcaster__joint_state_broadcaster_parameters",
    "forward_command": "forward_command_controller__forward_command_controller_parameters",
    "force_torque_sensor_broadcaster": ("force_torque_sensor_broadcaster__force_torque_sensor_broadcaster_parameters"),
    "gpio_command": "gpio_controllers__gpio_command_controller_parameters",
    "multi_interface_forward_command": (
        "forward_command_controller__multi_interface_forward_command_controller_parameters"
    ),
    "parallel_gripper": "parallel_gripper_controller__gripper_action_controller_parameters",
    "pid": "pid_controller__pid_controller",
}


def upstream_parameters(kind: str, distro: Distro) -> dict[str, dict[str, Any]]:
    """Return the declaration of each parameter of a kind, by its name with dots."""
    file = DECLARATIONS[kind]
    if kind == "parallel_gripper" and distro == "humble":
        file = "gripper_controllers__gripper_action_controller_parameters"
    document = safe_load((PARAMETERS / distro / f"{file}.yaml").read_text(encoding="utf-8"))
    return _flat(next(iter(document.values())), ())


def _flat(node: dict[str, Any], path: tuple[str, ...]) -> dict[str, dict[str, Any]]:
    if isinstance(node.get("type"), str):
        return {".".join(path): node}
    declared = {}
    for key, value in node.items():
        token = re.sub(r"^__map_(\w+)$", lambda match: f"<{'joint' if match[1] == 'joints' else match[1]}>", key)
        declared.update(_flat(value, (*path, token)))
    return declared
