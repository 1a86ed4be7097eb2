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

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.interface import Interface, InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_ROUNDING = 1.001


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield topics of cameras and broadcasters with a rate above that of their source."""
    sources = _sources(graph)
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC or interface.derived or not interface.rate_hz:
            continue
        for source, rate_hz in _rates(sources, interface):
            if interface.rate_hz > rate_hz * _ROUNDING:
                message = f"`{interface.name}` must be at most as fast as `{source}` publishes it, {rate_hz:g} Hz,"
                yield found(graph, (*interface.path, "rate"), f"{message} got {interface.rate_hz:g} Hz")
                break


def _sources(graph: CellGraph) -> dict[str, list[tuple[str, float]]]:
    """Return the topics, and the rate in Hz, of each device and controller; a controller publishes on any."""
    found: dict[str, list[tuple[str, float]]] = {}
    for device in graph.cell.devices:
        streams = () if device.camera is None else device.camera.streams
        found.setdefault(device.name, []).extend((stream.topic, stream.rate_hz) for stream in streams)
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            found.setdefault(controller.name, []).append(("", controller.update_rate_hz or manager.update_rate_hz))
    return found


def _rates(sources: Mapping[str, list[tuple[str, float]]], interface: Interface) -> Iterator[tuple[str, float]]:
    """Yield the sources of a topic whose rate is known, Hz."""
    for name in dict.fromkeys(source.node for source in interface.sources):
        yield from ((name, rate_hz) for topic, rate_hz in sources.get(name, ()) if topic in ("", interface.name))
