"""A controller drives more joints than its kind can, or none.

It is loaded and fails when it is configured: a trajectory controller refuses an empty list of joints, a gripper
controller takes one name. Everything that waits for its claims waits forever.

Example that is reported:

```yaml
control:
  controllers:
    gripper_action: {device: camera}  # expect at device
```

Example that is accepted:

```yaml
control:
  controllers:
    gripper_action: {device: gripper}
```

Fix: name the device whose joints it drives, or the joints themselves.

Source:

- https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
  (Jazzy): joints must not be empty
- docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield controllers without a joint where their kind names joints, or with several where it names one."""
    for controller in graph.cell.controllers:
        kind = controller.declared
        number = len(controller.joints)
        if kind is None or kind.joints_parameter is None or number == 1 or (number and not kind.single_joint):
            continue
        expected = "one joint" if kind.single_joint else "at least one joint"
        got = f"none: no joint of `{controller.device}` is driven" if number == 0 else str(number)
        message = f"expected {expected} for `{controller.name}` of kind `{controller.kind}`, got {got}"
        help_text = "name the device whose joints it drives" if number == 0 else "name the one joint under `joints`"
        yield found(graph, (*controller.path, "device"), message, help_text)
