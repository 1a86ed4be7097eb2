"""Collision thresholds do not fit their robot.

The upper threshold stops the robot, the lower one reports a contact: the other way round, or one figure short, the
request is refused when people set it, and whatever the robot had before stays in force.

Example that is reported:

```yaml
devices:
  arm: {collision: {torque: {lower: 25 25 22 20 19 17 N m, upper: 20 35 32 30 29 27 N m},  # expect at torque
                    force: {lower: 30 30 30 N, upper: 40 40 40 N}, moment: {lower: 25 25 25 N m, upper: 35 35 35 N m}}}
```

Example that is accepted:

```yaml
devices:
  arm: {collision: {torque: {lower: 25 25 22 20 19 17 N m, upper: 35 35 32 30 29 27 N m},
                    force: {lower: 30 30 30 N, upper: 40 40 40 N}, moment: {lower: 25 25 25 N m, upper: 35 35 35 N m}}}
```

Fix: give each joint a lower and an upper torque, the lower one first, and none to a robot that takes none.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield thresholds for no device, of another number of joints, and upper ones below the lower."""
    for device in graph.cell.devices:
        if device.collision is None:
            continue
        path = (*device.path, "collision")
        if not device.robot.thresholds:
            yield found(graph, path, f"the driver of `{device.name}` sets no collision thresholds")
            continue
        joints = len(device.actuated_joints)
        for name in ("torque", "force", "moment"):
            given = getattr(device.collision, name)
            if name == "torque" and not len(given.lower) == len(given.upper) == joints:
                counts = f"{len(given.lower)} and {len(given.upper)}"
                message = f"torque thresholds of `{device.name}` must be {joints} lower and upper ones, got {counts}"
                yield found(graph, (*path, name), message)
            elif any(low > high for low, high in zip(given.lower, given.upper, strict=True)):
                message = f"each lower {name} threshold of `{device.name}` must be at most the upper one"
                yield found(graph, (*path, name), message)
