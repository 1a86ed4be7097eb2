"""One name is used with two types.

Endpoints of different types never meet. The name shows in every list, and no sample arrives.

Example that is reported:

```yaml
interfaces:
  /camera/camera/color/camera_info: {topic: sensor_msgs/msg/Image, from: {camera: {depth: 1}},  # expect at topic
                                     to: {perception: {depth: 1}}, frame: camera/color_optical, wants: newest,
                                     rate: 30 Hz, max_age: 100 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /camera/camera/color/camera_info: {topic: sensor_msgs/msg/CameraInfo, from: {camera: {depth: 1}},
                                     to: {perception: {depth: 1}}, frame: camera/color_optical, wants: newest,
                                     rate: 30 Hz, max_age: 100 ms, on_stale: reject_goal}
```

Fix: use the type that the device or the controller publishes.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield interfaces of the spec whose device or controller has another type for the name."""
    for interface in graph.cell.interfaces:
        for source in interface.sources:
            real = _type_of(graph, source.node, interface.name)
            if real is not None and real != interface.type:
                message = f"`{interface.name}` is declared as `{interface.type}`, but `{source.node}` has `{real}`"
                yield found(graph, (*interface.path, interface.kind.value), message, f"write `{real}`")


def _type_of(graph: CellGraph, node: str, name: str) -> str | None:
    device = next((device for device in graph.cell.devices if device.name == node), None)
    if device is not None:
        return device.topics.get(name)
    return next((c.action_type for c in graph.cell.controllers if c.label == node and c.action == name), None)
