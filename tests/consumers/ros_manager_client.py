"""Asks a controller manager what `ros2 control` asks it, with rclpy, and prints the answers as JSON.

`list_controllers`, `list_hardware_components`, `list_hardware_interfaces` and `switch_controllers --deactivate NAME` of
https://control.ros.org/kilted/doc/ros2_control/ros2controlcli/doc/userdoc.html each call one service and wait 10 s.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import rclpy
from controller_manager_msgs.srv import (
    ListControllers,
    ListHardwareComponents,
    ListHardwareInterfaces,
    SwitchController,
)

_MANAGER = "/controller_manager"
_WITHIN_S = 60.0


def call(node: Any, kind: Any, name: str, request: Any) -> Any:
    """Call a service of the manager."""
    client = node.create_client(kind, f"{_MANAGER}/{name}")
    assert client.wait_for_service(timeout_sec=_WITHIN_S), name
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future, timeout_sec=_WITHIN_S)
    assert future.done(), name
    return future.result()


def states(node: Any) -> dict[str, str]:
    """Return the states of the controllers."""
    listed = call(node, ListControllers, "list_controllers", ListControllers.Request())
    return {each.name: each.state for each in listed.controller}


def main(controller: str) -> None:
    """Ask, and deactivate a controller."""
    rclpy.init()
    node = rclpy.create_node("a_client")
    components = call(node, ListHardwareComponents, "list_hardware_components", ListHardwareComponents.Request())
    interfaces = call(node, ListHardwareInterfaces, "list_hardware_interfaces", ListHardwareInterfaces.Request())
    before = states(node)
    off = SwitchController.Request(deactivate_controllers=[controller], strictness=SwitchController.Request.STRICT)
    switched = call(node, SwitchController, "switch_controller", off)
    told = {
        "before": before,
        "components": {each.name: each.state.label for each in components.component},
        "claimed": [each.name for each in interfaces.command_interfaces if each.is_claimed],
        "switched": switched.ok,
        "after": states(node),
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main(*sys.argv[1:])
