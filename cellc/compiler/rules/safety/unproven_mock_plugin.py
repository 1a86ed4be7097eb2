"""The mock of a device is a plugin that may reach hardware.

The mock is the default target, and has no gate. A vendor's plugin that `device.yaml` names for it opens
the connection of its driver when the mock is launched, and the arm moves unexpectedly. `ros2_control`
loads whatever plugin it is given. `mock_components/GenericSystem` is known to touch no hardware; of another plugin
somebody says so in the spec, by name and with a date.

Example that is reported:

```yaml
mock_plugins:
  bare_arm_simulation/Hardware: {touches_no_hardware: true, by: UNKNOWN, date: 2026-07-01}
devices:
  side_arm: {model: ./own_mock_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
mock_plugins:
  bare_arm_simulation/Hardware: {touches_no_hardware: true, by: controls, date: 2026-07-01}
devices:
  side_arm: {model: ./own_mock_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: name `mock_components/GenericSystem` in `device.yaml`, or state under `mock_plugins` who says that the plugin
touches no hardware, and when.

Source: docs/principles.md#mock-and-real
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices whose mock plugin neither the catalog nor a signed statement knows to touch no hardware."""
    known = graph.cell.harmless_plugins
    for device in graph.cell.devices:
        plugin = "" if device.hardware is None else device.hardware.plugins["mock"]
        if device.hardware is not None and plugin not in known:
            message = f"the mock of `{device.name}` is `{plugin}`, without a statement that it touches no hardware"
            yield found(graph, ("devices", device.name, "model"), message)
