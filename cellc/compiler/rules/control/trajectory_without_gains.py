"""A trajectory controller commands velocity or effort alone, without gains.

It turns the position error into its command by a PID for each joint. All gains are zero until they are written: the arm
does not move or drifts under its feedforward, and sinks where it commands effort.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [velocity]}  # expect at command_interfaces
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [position]}
```

Fix: add `gains.<joint>.p` for every joint under `parameters:`, or command the position.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): gains, a PID for velocity or effort alone
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import TRAJECTORIES


@rule(Severity.ERROR, assumes=("unprovided-command-interface",))
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers without position commands that have a joint without a proportional gain."""
    for controller in graph.cell.controllers:
        target = controller.targets[-1]  # the real one where it is there
        kinds = {interface.rpartition("/")[2] for interface in controller.claims(target)}
        if controller.behaviour not in TRAJECTORIES or len(kinds) != 1 or not kinds <= {"velocity", "effort"}:
            continue
        without = [joint for joint in controller.joints if not controller.told(target).get(f"gains.{joint}.p")]
        if without:
            more = f" and {len(without) - 1} more" if len(without) > 1 else ""
            message = f"`{controller.name}` commands {kinds.pop()} alone and must have gains, `gains.{without[0]}.p`"
            yield found(graph, (*controller.path, "command_interfaces"), f"{message}{more} is zero")
