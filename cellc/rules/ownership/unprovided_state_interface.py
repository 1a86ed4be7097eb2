"""A controller reads a state interface that the hardware does not have.

The controller manager refuses to activate it, and goals are rejected.

Example that is reported:

```yaml
control:
  controllers:
    gripper_trajectory: {type: joint_trajectory, device: gripper, joints: [gripper/mirror_joint], active: false,
                         client: task, goal_time: 1 s, path_tolerance: 0.2 rad, goal_tolerance: 0.1 rad}
  switches:
    to_gripper_trajectory: {activate: [gripper_trajectory], deactivate: [gripper_action]}
```

Example that is accepted:

```yaml
control:
  controllers:
    gripper_trajectory: {type: joint_trajectory, device: gripper, active: false, client: task, goal_time: 1 s,
                         path_tolerance: 0.2 rad, goal_tolerance: 0.1 rad}
  switches:
    to_gripper_trajectory: {activate: [gripper_trajectory], deactivate: [gripper_action]}
```

Fix: choose joints that report what the controller needs.

Source: controller_manager: a required interface does not exist, ok is false.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield controllers that read what no joint, sensor or gpio of the cell reports, one finding a controller."""
    provided = {
        f"{joint.name}/{name}"
        for device in graph.cell.devices
        for joint in device.joints
        for name in joint.state_interfaces
    }
    for device in graph.cell.devices:
        groups = () if device.hardware is None else (*device.hardware.sensors, *device.hardware.gpios)
        provided |= {f"{group.name}/{name}" for group in groups for name in group.state_interfaces}
    for controller in graph.cell.controllers:
        missing = [state for state in controller.state_interfaces if state not in provided]
        if missing:
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            message = f"`{controller.name}` reads `{missing[0]}`{more}, which no hardware reports"
            yield found(graph, controller.path, message, "choose joints that report what the controller needs")


RULE = define("unprovided-state-interface", Severity.ERROR, check, __doc__)
