"""The goals of a planner go to a controller that another node is said to command.

MoveIt executes what it plans through the action of the controller. Where the spec names another client, access rules
and ownership are those of a node that never moves the arm.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {client: perception}  # expect at client
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {client: move_group}
```

Fix: name the node that serves the motion action.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.vocabulary import TRAJECTORIES

_EXECUTING = frozenset({"moveit_msgs/action/MoveGroup", "moveit_msgs/action/ExecuteTrajectory"})


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers whose client has no goals of its own, beside a node that executes motion."""
    actions = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.ACTION and not interface.derived
    ]
    executing = {
        end.node: interface for interface in actions if interface.type in _EXECUTING for end in interface.sources
    }
    declared = {(interface.name, end.node) for interface in actions for end in interface.sinks}
    for controller in graph.cell.controllers:
        client = controller.client
        if controller.behaviour not in TRAJECTORIES or client is None or not executing or client in executing:
            continue
        commands = graph.data.path_to_motion(client)[1:2] != (controller.label,)
        asks = any(
            sink == client for name, sink in declared if name in {interface.name for interface in executing.values()}
        )
        if (controller.action or "", client) not in declared and not asks and not commands:
            server, action = next(iter(executing.items()))
            message = (
                f"the client of `{controller.name}` must be `{server}`, which executes `{action.name}`, got `{client}`"
            )
            related = (Related("motion is executed here", action.span),)
            yield found(graph, (*controller.path, "client"), message, related=related)
