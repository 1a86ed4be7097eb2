"""A controller is to run faster than its manager.

The manager calls its controllers. It cannot call one more often than it runs itself.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {update_rate: 1000 Hz}
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {update_rate: 250 Hz}
```

Fix: lower the rate of the controller, or raise that of the manager.

Source: controller_manager, parameter update_rate of a controller.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield controllers with a rate above that of their manager."""
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.update_rate_hz is not None and controller.update_rate_hz > manager.update_rate_hz:
                message = (
                    f"`{controller.name}` is to run at {controller.update_rate_hz:g} Hz, "
                    f"its manager runs at {manager.update_rate_hz:g} Hz"
                )
                path = (*controller.path, "update_rate")
                yield found(graph, path, message, f"write at most {manager.update_rate_hz:g} Hz")


RULE = define("controller-faster-than-manager", Severity.ERROR, check, __doc__)
