"""A topic is said to come from a device that publishes it under another name.

The name of a node and its namespace both stand in a driver's topics: one doubled or left out gives a topic that exists
for its readers alone. They wait, and the list of topics shows the name.

Example that is reported:

```yaml
interfaces:
  /camera/color/image_raw: {topic: sensor_msgs/msg/Image, from: camera,  # expect at /camera/color/image_raw
                            to: {perception: {reliability: best_effort, depth: 1}}, wants: newest,
                            frame: camera/color_optical, rate: 30 Hz, max_age: 100 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /camera/camera/color/image_raw: {topic: sensor_msgs/msg/Image, from: camera,
                                   to: {perception: {reliability: best_effort, depth: 1}}, wants: newest,
                                   frame: camera/color_optical, rate: 30 Hz, max_age: 100 ms, on_stale: reject_goal}
```

Fix: write the name under which the driver publishes; `cellc show` lists its topics.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics of the spec from a device whose driver has their type, but not their name."""
    devices = {device.name: device for device in graph.cell.devices}
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC or interface.derived:
            continue
        for source in interface.sources:
            topics = devices[source.node].topics if source.node in devices else {}
            alike = [name for name, type_ in topics.items() if type_ == interface.type]
            if alike and interface.name not in topics:
                message = f"`{source.node}` does not publish `{interface.name}`"
                advice = did_you_mean(interface.name, alike, f"topics of `{source.node}` with `{interface.type}`")
                yield found(graph, interface.path, message, advice)
