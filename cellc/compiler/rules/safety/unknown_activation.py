"""The effect of starting a device is not stated.

A gripper or a stage may find its reference, close or open as its hardware component is activated, or as its driver
starts. Where `device.yaml` states no effect of that moment the answer is not "nothing": the component starts
unconfigured, and a person activates it behind a gate of its own; a driver that starts cannot be held back like that.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./silent_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
```

Fix: ask the supplier, and state `effects: {activate: {motion, does, source}}` of the hardware in `device.yaml`, or
`effect:` of its driver.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices without a stated effect of their activation, or of the start of their driver."""
    for device in graph.cell.devices:
        for moment in device.unknown_effects:
            message = f"it is not stated what {moment} of `{device.name}` moves"
            yield found(graph, (*device.path, "model"), message)
