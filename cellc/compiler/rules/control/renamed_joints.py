"""Joints have a prefix, but the driver makes their names in its code.

The hardware plugin of some vendors reads no name from the description: it exports the interfaces that its code names.
With a prefix of the cell before them, the description and the controllers have other names: the mock runs, and on the
robot each controller waits for an interface that no hardware exports.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./coded_arm, mount: {parent: world, xyz: 0 2 0 m}, prefix: side_,  # expect at prefix
             revision: A, firmware: coded 1.0.0}
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./coded_arm, mount: {parent: world, xyz: 0 2 0 m}, prefix: "",
             revision: A, firmware: coded 1.0.0}
```

Fix: write `prefix: ""` for the device, as `cellc init` does.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices with a prefix whose real plugin knows no other names than its own."""
    for device in graph.cell.devices:
        hardware = device.hardware
        if hardware is not None and hardware.fixed_joint_names and device.prefix:
            joint = device.actuated_joints[0].local_name
            message = (
                f"the driver of `{device.name}` calls its joints `{joint}` and so on, got the prefix `{device.prefix}`"
            )
            yield found(graph, (*device.path, "prefix"), message)
