"""A device with a direct SDK has no adapter contract.

Without ROS the responsibilities for stamps, units and bounds move into the application. A small adapter with stamped
state keeps them in one place; vendor structs spread over the code keep them nowhere.

Example that is reported:

```yaml
devices:
  gripper: {architecture: direct_sdk}  # expect at architecture
```

Example that is accepted:

```yaml
devices:
  gripper: {architecture: hybrid}
```

Fix: declare the topic on which the adapter publishes stamped state: `from` the device, with rate, unit and `max_age`.

Source: docs/principles.md#direct-sdk
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield direct-SDK devices without a topic of stamped, rated, age-limited state."""
    for device in graph.cell.devices:
        if device.architecture != "direct_sdk":
            continue
        contract = any(
            source.node == device.name and interface.rate_hz and interface.max_age_s
            for interface in graph.cell.interfaces
            for source in interface.sources
        )
        if not contract:
            message = f"`{device.name}` is driven by a direct SDK, but no interface carries its stamped state"
            path = (*device.path, "architecture")
            yield found(graph, path, message)
