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

from collections.abc import Mapping

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
    topics = graph.once(_topics)
    return topics[node].get(name) if node in topics else graph.once(_actions).get((node, name))


def _topics(graph: CellGraph) -> Mapping[str, Mapping[str, str]]:
    return {device.name: device.topics for device in graph.cell.devices}


def _actions(graph: CellGraph) -> Mapping[tuple[str, str | None], str | None]:
    return {
        (controller.label, controller.action): controller.action_type for controller in reversed(graph.cell.controllers)
    }
