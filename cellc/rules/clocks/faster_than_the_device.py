"""A topic is promised faster than the device publishes it.

The rate of a stream is set at the device, that of a broadcaster by its controller manager. No node meets a promise
above it: ages and deadlines that were worked out from it reject samples that are as fresh as they can be.

Example that is reported:

```yaml
interfaces:
  /camera/camera/color/image_raw: {rate: 60 Hz}  # expect at rate
```

Example that is accepted:

```yaml
interfaces:
  /camera/camera/color/image_raw: {rate: 30 Hz}
```

Fix: write the rate at which it is published; `cellc show` has that of a stream.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.interface import Interface, InterfaceKind
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule

_ROUNDING = 1.001


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield topics of cameras and broadcasters with a rate above that of their source."""
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC or interface.derived or not interface.rate_hz:
            continue
        for source, rate_hz in _rates(graph, interface):
            if interface.rate_hz > rate_hz * _ROUNDING:
                message = f"`{interface.name}` must be at most as fast as `{source}` publishes it, {rate_hz:g} Hz,"
                yield found(graph, (*interface.path, "rate"), f"{message} got {interface.rate_hz:g} Hz")
                break


def _rates(graph: CellGraph, interface: Interface) -> Iterator[tuple[str, float]]:
    """Yield the sources of a topic whose rate is known, Hz."""
    names = {source.node for source in interface.sources}
    for device in graph.cell.devices:
        streams = () if device.camera is None or device.name not in names else device.camera.streams
        yield from ((device.name, one.rate_hz) for one in streams if one.topic == interface.name)
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.name in names:
                yield controller.name, controller.update_rate_hz or manager.update_rate_hz
