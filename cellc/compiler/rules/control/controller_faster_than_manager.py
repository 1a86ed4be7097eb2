"""A controller is faster than its manager.

The manager calls its controllers. It cannot call one more often than it runs itself.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {update_rate: 1000 Hz}  # expect at update_rate
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {update_rate: 250 Hz}
```

Fix: lower the rate of the controller, or raise that of the manager.

Source: https://control.ros.org/jazzy/doc/ros2_control/controller_manager/doc/userdoc.html
(Jazzy): update_rate of a controller
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield controllers with a rate above that of their manager."""
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.update_rate_hz is not None and controller.update_rate_hz > manager.update_rate_hz:
                message = (
                    f"`update_rate` of `{controller.name}` must be at most {manager.update_rate_hz:g} Hz, "
                    f"the rate of its manager, got {controller.update_rate_hz:g} Hz"
                )
                path = (*controller.path, "update_rate")
                yield found(graph, path, message, f"write at most {manager.update_rate_hz:g} Hz")
