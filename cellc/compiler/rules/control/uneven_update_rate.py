"""The rate of a controller does not divide the rate of its manager.

The manager counts cycles. A rate that does not divide its own makes the controller run at another rate than written,
or unevenly.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {update_rate: 300 Hz}  # expect at update_rate
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {update_rate: 250 Hz}
```

Fix: use the rate of the manager divided by a whole number.

Source: https://control.ros.org/jazzy/doc/ros2_control/controller_manager/doc/userdoc.html
(Jazzy): update_rate of a controller
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield controllers whose rate does not divide that of their manager."""
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            rate = controller.update_rate_hz
            if not rate or rate > manager.update_rate_hz:
                continue
            cycles = manager.update_rate_hz / rate
            if abs(cycles - round(cycles)) > 1e-6:
                even = manager.update_rate_hz / math.ceil(cycles)
                message = (
                    f"`update_rate` of `{controller.name}` must divide {manager.update_rate_hz:g} Hz, got {rate:g} Hz"
                )
                yield found(graph, (*controller.path, "update_rate"), message, f"write {even:g} Hz")
