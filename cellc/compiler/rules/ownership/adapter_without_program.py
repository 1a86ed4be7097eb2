"""Nothing starts the adapter that drives a device by the library of its vendor.

Where a device has a direct SDK, no driver of ROS is launched for it: what publishes its state and takes its goals is a
program of the cell's own. Named, it is started on the real target behind the same gates as everything else, in an
enclave of its own. Unnamed, the launch waits for states and actions without a server, and where access is enforced
whatever a person starts by hand is denied all of them.

Example that is reported:

```yaml
devices:
  camera: {architecture: direct_sdk}  # expect at architecture
```

Example that is accepted:

```yaml
devices:
  camera: {architecture: direct_sdk, adapter: {run: cell_drivers/camera}}
```

Fix: name the program of the adapter: `adapter: {run: package/executable}`.

Source: docs/principles.md#direct-sdk
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield direct-SDK devices that stand at an interface without a node that is started for them."""
    started = {node.full_name for node in graph.cell.nodes}
    ends = [end for interface in graph.cell.interfaces for end in (*interface.sources, *interface.sinks)]
    missing = {end.node for end in ends if end.full_name not in started}
    for device in graph.cell.devices:
        if device.architecture == "direct_sdk" and device.name in missing:
            message = f"nothing starts the adapter of `{device.name}` on the real target"
            yield found(graph, (*device.path, "architecture"), message)
