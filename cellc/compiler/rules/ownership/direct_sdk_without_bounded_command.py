"""A device that moves by a direct SDK has no bounded command.

Without a controller of ros2_control nothing limits the commands but the application. The adapter must take them over
one action that can be canceled and ends in time; calls of the library from anywhere have no bound and no owner.

Example that is reported:

```yaml
devices:
  gripper: {architecture: direct_sdk, adapter: {run: cell_drivers/fingers}}  # expect at architecture
interfaces:
  /gripper/state: {topic: sensor_msgs/msg/JointState, from: gripper, to: {task: {depth: 1}}, wants: newest,
                   rate: 20 Hz, max_age: 100 ms, on_stale: reject_goal}
control: {controllers: {gripper_action: null}}
rehearsals: {pick_and_place: {steps: [{move: home}, {detect: object}, {move: pick}]}}
```

Example that is accepted:

```yaml
devices:
  gripper: {architecture: direct_sdk, adapter: {run: cell_drivers/fingers}}
interfaces:
  /gripper/state: {topic: sensor_msgs/msg/JointState, from: gripper, to: {task: {depth: 1}}, wants: newest,
                   rate: 20 Hz, max_age: 100 ms, on_stale: reject_goal}
  /gripper/grasp: {action: control_msgs/action/ParallelGripperCommand, server: gripper, client: task, frame: world,
                   timeout: 5 s, on_timeout: cancel_and_hold, cancel_within: 200 ms}
control: {controllers: {gripper_action: null}}
rehearsals: {pick_and_place: {steps: [{move: home}, {detect: object}, {move: pick}]}}
```

Fix: declare the action that the adapter serves, `server:` the device, with a timeout.

Source: docs/principles.md#direct-sdk
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield direct-SDK devices with joints that neither a controller nor an action of the device bounds."""
    driven = {joint for controller in graph.cell.controllers for joint in controller.joints}
    bounded = {
        source.node
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.ACTION and interface.timeout_s
        for source in interface.sources
    }
    for device in graph.cell.devices:
        moves = any(joint.name not in driven for joint in device.actuated_joints)
        if device.architecture == "direct_sdk" and moves and device.name not in bounded:
            message = f"`{device.name}` is driven by a direct SDK, but no action bounds its commands"
            path = (*device.path, "architecture")
            yield found(graph, path, message, f"declare an action with `server: {device.name}` and a timeout")
