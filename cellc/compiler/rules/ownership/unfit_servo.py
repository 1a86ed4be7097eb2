"""MoveIt Servo does not fit the controller, the group or the node that the cell gives it.

Servo streams to a topic, and the last writer there moves the arm: the controller must have Servo as its one client.
Values come without names, so that joints in another order move each other's way; and another program than Servo reads
none of its parameters.

Example that is reported:

```yaml
nodes:
  servo: {run: moveit_servo/servo_node, host: control_pc, owner: integration}
motion:
  servo: {node: servo, controller: arm_trajectory,  # expect at controller
          linear: 0.05 m/s, rotational: 0.2 rad/s, joint: 0.2 rad/s}
```

Example that is accepted:

```yaml
nodes:
  servo: {run: moveit_servo/servo_node, host: control_pc, owner: integration}
control:
  controllers:
    arm_jog: {type: forward_command, device: arm, active: false, client: servo}
  switches: {to_jog: {activate: [arm_jog], deactivate: [arm_trajectory]}}
motion:
  servo: {node: servo, controller: arm_jog, linear: 0.05 m/s, rotational: 0.2 rad/s, joint: 0.2 rad/s}
```

Fix: give Servo a controller of its own, of the group's joints, whose `client` is its node, and a switch to it.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.motion import Servo
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import TRAJECTORIES, Behaviour, Distro

_PACKAGE = "moveit_servo"
_EXECUTABLES = {Distro.HUMBLE: "servo_node_main"}
"""What runs it where that is not ``servo_node``: moveit2 2.5.9, moveit_ros/moveit_servo/CMakeLists.txt."""


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield what keeps Servo from commanding its controller alone, with its parameters."""
    cell, servo = graph.cell, graph.cell.servo
    if servo is None:
        return
    path = ("motion", "servo")
    (node,) = (node for node in cell.nodes if node.path == ("nodes", servo.node))
    wanted = f"{_PACKAGE}/{_EXECUTABLES.get(cell.distro, 'servo_node')}"
    if f"{node.package}/{node.executable}" != wanted:
        message = f"`{servo.node}` must run `{wanted}` on {cell.distro}, got `{node.package}/{node.executable}`"
        yield found(graph, (*path, "node"), message)
    if not any((node.package, node.executable) == ("moveit_ros_move_group", "move_group") for node in cell.nodes):
        yield found(graph, (*path, "node"), f"`{servo.node}` needs a node that runs move_group, whose scene it follows")
    (controller,) = (controller for controller in cell.controllers if controller.full_name == servo.controller)
    if refused := next(_refused(cell, servo, controller), ""):
        yield found(graph, (*path, "controller"), refused)


def _refused(cell: Cell, servo: Servo, controller: Controller) -> Iterator[str]:
    """Yield why a controller must not be commanded by Servo."""
    streamed = controller.behaviour is Behaviour.FORWARD_COMMAND
    if not streamed and controller.behaviour not in TRAJECTORIES:
        yield f"`{controller.name}` must take positions or velocities of joints by a topic, got {controller.kind}"
    if streamed and servo.positions == servo.velocities:
        yield f"`{controller.name}` must command position or velocity, and one of them alone"
    if controller.client != servo.node:
        client = controller.client or "no node"
        yield f"`{servo.node}` must be the client of `{controller.name}`, which is commanded by {client}"
    (group,) = (group for group in cell.groups if group.name == servo.group)
    if controller.joints != group.joints:
        yield f"`{controller.name}` must have the joints of `{group.name}` in their order"
