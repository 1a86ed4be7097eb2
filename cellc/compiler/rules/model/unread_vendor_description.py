"""The package of the vendor is available, but its description cannot be read.

The shapes of the catalog serve then: boxes and cylinders, which are larger than the robot in some places and smaller in
others. Nothing else of the cell rests on the vendor's file.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./unread_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./vendored_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: correct what the message names, or put the release of the package beside the spec that the device is pinned to.

Source: docs/principles.md#robot-descriptions
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield devices whose vendor's description was refused."""
    for device in graph.cell.devices:
        vendor = device.vendor_description
        if vendor is not None and vendor.refused:
            message = f"the description of `{device.name}` in `{vendor.folder}` cannot be read: {vendor.refused}"
            yield found(graph, (*device.path, "model"), message)
