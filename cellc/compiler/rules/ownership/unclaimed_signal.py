"""A device is wired to an output that no controller sets, or to an input that none reads.

ros2_control hands an interface out to controllers alone. An output that none claims keeps the value of its power-up; an
input that none reads reaches no node, and who waits for it waits for ever.

Example that is reported:

```yaml
devices:
  io: {model: ./demo_io, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: io 1.0.0,
       driver: demo_io_driver 1.0.0}
  lamp: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
         switching: {outputs: {light: io/io/out_0}}}  # expect at light
```

Example that is accepted:

```yaml
# a cell of wired outputs
devices:
  lamp: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
         switching: {outputs: {light: io/io/out_0}}}
```

Fix: add a controller that takes it, of the kind that the catalog has for its device, or a `gpio_command`.

Source:

- https://control.ros.org/jazzy/doc/ros2_controllers/gpio_controllers/doc/userdoc.html
  (Jazzy): commands and states of gpios
- docs/principles.md#digital-signals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield outputs that no controller claims on the real target, and inputs that none reads."""
    devices = graph.cell.devices
    # `missing-real-plugin` reports devices without a real plugin.
    unnamed = {
        device.name for device in devices if device.hardware is not None and "real" not in device.hardware.targets
    }
    there = [
        controller
        for controller in graph.cell.controllers
        if "real" in controller.targets or controller.device in unnamed
    ]
    claimed = {interface for controller in there for interface in controller.claims("real")}
    read = {interface for controller in there for interface in controller.state_interfaces}
    for device in devices:
        if device.switched is None:
            continue
        path = (*device.path, "switching")
        for name, interface in device.switched.outputs.items():
            if interface not in claimed:
                yield found(graph, (*path, "outputs", name), f"no controller claims `{interface}`")
        for name, interface in device.switched.inputs.items():
            if interface not in read:
                yield found(graph, (*path, "inputs", name), f"no controller reads `{interface}`")
