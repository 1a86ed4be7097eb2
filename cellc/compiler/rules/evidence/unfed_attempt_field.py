"""The attempt record has a field that the real device would tell, and no controller of the cell publishes it.

How far the robot slowed a motion down, which safety state it was in and which fault it reported cannot be found out
afterwards. The driver publishes each by a controller of its own, which is there only where the cell spawns it; the
mock fills the field either way.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0, connection: {host: control_pc, nic: robot, address: 192.168.56.102}}
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             connection: {host: control_pc, nic: robot, address: 192.168.56.102}}
control:
  controllers:
    side_status: {type: program_status, device: side_arm}
```

Fix: add the controller of the device that publishes it.

Source: docs/principles.md#records-of-attempts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield devices with a connection whose part of the record has no publisher, once for each controller kind."""
    cell = graph.cell
    for device in cell.devices:
        wanted = [source for source in device.record if source.attempt_field in cell.recording.attempt_fields]
        missing: dict[str, list[str]] = {}
        for source in wanted if device.connection is not None else ():
            if source.controller_kind is not None and cell.reporting(device, source) is None:
                missing.setdefault(source.controller_kind, []).append(f"`{source.attempt_field}`")
        for kind, fields in missing.items():
            message = (
                f"{' and '.join(fields)} of the attempt record must come from `{device.name}`, which has no publisher"
            )
            advice = f"add a controller of `type: {kind}` with `device: {device.name}`"
            yield found(graph, (*device.path, "model"), message, advice)
