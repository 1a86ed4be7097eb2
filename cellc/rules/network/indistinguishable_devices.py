"""Two devices of one model on one host cannot be told apart.

Neither has an address, a port or a serial number, so that each driver opens the first unit that it finds. Which one
that is depends on the order in which the units came up.

Example that is reported:

```yaml
# expect at devices.camera
devices:
  second: {model: ./demo_camera, mount: {parent: world, xyz: 1 0 2 m, calibration: second_eye},  # expect at second
           revision: C, firmware: sensor 5.16.0, driver: demo_camera_driver 4.58.3,
           description: demo_camera_description 4.58.3, connection: {host: control_pc, nic: bulk},
           stamp: {source: hardware, clock: second, exposure: 8 ms, synchronised_by: global_time, max_offset: 2 ms}}
calibrations:
  second_eye: {revision: 1, measured: 2026-07-01, method: charuco, samples: 40, residual: 0.8 mm, owner: perception}
```

Example that is accepted:

```yaml
devices:
  camera: {serial: D4-0712}
  second: {model: ./demo_camera, mount: {parent: world, xyz: 1 0 2 m, calibration: second_eye}, revision: C,
           serial: D4-0756,
           firmware: sensor 5.16.0, driver: demo_camera_driver 4.58.3, description: demo_camera_description 4.58.3,
           connection: {host: control_pc, nic: bulk},
           stamp: {source: hardware, clock: second, exposure: 8 ms, synchronised_by: global_time, max_offset: 2 ms}}
calibrations:
  second_eye: {revision: 1, measured: 2026-07-01, method: charuco, samples: 40, residual: 0.8 mm, owner: perception}
```

Fix: add `serial:`, which the driver is then told.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.cell.device import Device
from cellc.cell.site import UNKNOWN
from cellc.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices without address, port and serial number that share their model and host with another."""
    alike: dict[tuple[str, str], list[Device]] = {}
    for device in graph.cell.devices:
        link = device.connection
        if link is not None and link.address is None and link.port is None:
            alike.setdefault((device.model, link.host), []).append(device)
    for (model, host), devices in alike.items():
        for device in devices if len(devices) > 1 else ():
            if device.versions.serial != UNKNOWN:
                continue
            others = [other for other in devices if other is not device]
            message = f"`{device.name}` must state its `serial`, as `{others[0].name}` on `{host}` is a `{model}` too"
            related = tuple(Related("of the same model", other.span) for other in others)
            yield found(graph, (*device.path, "serial"), message, related=related)
