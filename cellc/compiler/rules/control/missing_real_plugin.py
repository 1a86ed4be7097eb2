"""A device has joints to command, and nothing that moves them on the real target.

On the mock a stand-in moves every joint. On the real target the controller manager knows only the interfaces of the
plugins in the description; where a device has neither a plugin nor a driver of its own, its joints are not there, and
a controller that names one of them is not configured, the rest of its joints with it.

Example that is reported:

```yaml
devices:
  shuttle: {model: ./plain_axis, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at shuttle
            firmware: plain 1.0.0}
control:
  controllers:
    shuttle_trajectory: {type: joint_trajectory, device: shuttle, client: move_group, goal_time: 1 s,
                         path_tolerance: 0.2 rad 20 mm, goal_tolerance: 0.01 rad 1 mm}
```

Example that is accepted:

```yaml
devices:
  shuttle: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
control:
  controllers:
    shuttle_trajectory: {type: joint_trajectory, device: shuttle, client: move_group, goal_time: 1 s,
                         path_tolerance: 0.2 rad 20 mm, goal_tolerance: 0.01 rad 1 mm}
```

Fix: name the plugin of its drive under `control.hardware.real` of the `device.yaml`, in a folder of the cell's own.

Source: https://control.ros.org/jazzy/doc/getting_started/getting_started.html#hardware-description-in-urdf (2026-08-07)
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices with joints that a controller names, and neither a plugin nor a driver on the real target."""
    named = {
        joint for manager in graph.cell.managers for controller in manager.controllers for joint in controller.joints
    }
    for device in graph.cell.devices:
        hardware = device.hardware
        if hardware is None or "real" in hardware.targets or device.driver is not None:
            continue
        joints = [joint.name for joint in device.joints if joint.name in named]
        if joints:
            message = (
                f"nothing moves `{joints[0]}` of `{device.name}` on the real target: its model has no plugin there"
            )
            yield found(graph, device.path, message)
