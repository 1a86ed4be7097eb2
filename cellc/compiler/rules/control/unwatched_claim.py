"""A robot keeps set points while its program is stopped, and nothing tells the cell that it is.

The set points of some robots pass through a program on their own controller. A trajectory controller that keeps its
claim over a stop of that program holds the joints where they were; somebody jogs the arm, starts the program, and the
arm jumps back. A reported program state lets the bring-up wait with its claim, and let go of it when the program
stops.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
control:
  controllers:
    side_trajectory: {type: joint_trajectory, device: side_arm, client: move_group,  # expect at side_trajectory
                      goal_time: 1 s, path_tolerance: 0.2 rad, goal_tolerance: 0.01 rad}
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
control:
  controllers:
    side_trajectory: {type: joint_trajectory, device: side_arm, client: move_group,
                      goal_time: 1 s, path_tolerance: 0.2 rad, goal_tolerance: 0.01 rad}
    side_status: {type: program_status, device: side_arm}
```

Fix: add the controller of the device that publishes whether its program runs.

Source: https://github.com/UniversalRobots/Universal_Robots_ROS2_Driver/issues/1084 (2026-08-01)
"""

from __future__ import annotations

from operator import itemgetter

from cellc.compiler.cell.control import Controller
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER, assumes=("shared-prefix",))
def check(graph: CellGraph) -> Findings:
    """Yield controllers whose claims a real robot keeps over a stop of its program, where no topic reports the stop."""
    for manager in graph.cell.managers:
        claiming: dict[str, dict[int, Controller]] = {}
        for number, controller in enumerate(manager.controllers):
            for interface in controller.command_interfaces if "real" in controller.targets else ():
                claiming.setdefault(interface.rpartition("/")[0], {})[number] = controller
        telling = {
            (controller.kind, controller.device)
            for controller in manager.controllers
            if controller.active and "real" in controller.targets
        }
        for name in manager.devices:
            device = graph.cell.device(name)
            hardware = device.hardware
            if hardware is None or "real" not in hardware.targets or not hardware.kept_by_a_claim:
                continue
            kinds = [item.controller_kind for item in hardware.heard_before_a_claim]
            if any((kind, name) in telling for kind in kinds):
                continue
            owners = {number: one for joint in device.joints for number, one in claiming.get(joint.name, {}).items()}
            advice = (
                f"add a controller of `type: {kinds[0]}` with `device: {name}`"
                if kinds
                else f"say under `told` of the `device.yaml` of `{name}` which topic reports whether its program runs"
            )
            for _, one in sorted(owners.items(), key=itemgetter(0)):
                message = f"`{name}` keeps the set points of `{one.name}` over a stop of its program, unheard"
                yield found(graph, one.path, message, advice)
