"""A topic is declared in another frame than its samples are stamped with.

The reader takes the numbers as the spec says: a force that is measured at the tool and read at the base points
somewhere else as soon as the wrist turns.

Example that is reported:

```yaml
interfaces:
  /force/wrench: {topic: geometry_msgs/msg/WrenchStamped, from: force, to: {task: {depth: 1}},
                  frame: arm/base_link,  # expect at frame
                  wants: newest, rate: 500 Hz, max_age: 20 ms, on_stale: stop_and_hold}
control:
  controllers:
    force: {type: force_torque_sensor_broadcaster, device: arm,
            parameters: {interface_names.force.z: arm_joint_6/effort, frame_id: arm_tool0}}
```

Example that is accepted:

```yaml
interfaces:
  /force/wrench: {topic: geometry_msgs/msg/WrenchStamped, from: force, to: {task: {depth: 1}},
                  frame: arm/tool0,
                  wants: newest, rate: 500 Hz, max_age: 20 ms, on_stale: stop_and_hold}
control:
  controllers:
    force: {type: force_torque_sensor_broadcaster, device: arm,
            parameters: {interface_names.force.z: arm_joint_6/effort, frame_id: arm_tool0}}
```

Fix: write the frame of the stamp, and transform where another one is needed.

Source: docs/principles.md#command-contracts
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.interface import Interface
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule

_Stamp = tuple[str, str, YamlPath]


@rule(Severity.ERROR, assumes=("camera-data-in-body-frame",))
def check(graph: CellGraph) -> Findings:
    """Yield interfaces of the spec whose frame is not that of a stream or a broadcaster that publishes them."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.frame is None:
            continue
        for stamped, who, path in _stamps(graph, interface):
            if stamped != interface.frame:
                message = (
                    f"`{interface.name}` is declared in `{interface.frame}`, but `{who}` stamps it with `{stamped}`"
                )
                related = (Related("stamped here", graph.cell.locate(*path)),)
                yield found(graph, (*interface.path, "frame"), message, related=related)
                break


def _stamps(graph: CellGraph, interface: Interface) -> Iterator[_Stamp]:
    """Yield the frame of each publisher that has one, with the name of the publisher and where it says so."""
    for source in interface.sources:
        yield from graph.once(_of_cameras).get((source.node, interface.name), ())
        yield from graph.once(_of_controllers).get(source.node, ())


def _of_cameras(graph: CellGraph) -> Mapping[tuple[str, str], list[_Stamp]]:
    """Return what each device with a camera stamps, by its name and the topic."""
    stamps: dict[tuple[str, str], list[_Stamp]] = {}
    for device in graph.cell.devices:
        for stream in device.camera.streams if device.camera is not None else ():
            for topic in dict.fromkeys((stream.topic, stream.info_topic)):
                stamps.setdefault((device.name, topic), []).append((stream.frame, device.name, device.path))
    return stamps


def _of_controllers(graph: CellGraph) -> Mapping[str, list[_Stamp]]:
    stamps: dict[str, list[_Stamp]] = {}
    for controller in graph.cell.controllers:
        frame = controller.parameters.get("frame_id")
        if isinstance(frame, str) and frame:
            path = (*controller.path, "parameters", "frame_id")
            stamps.setdefault(controller.label, []).append((frame, controller.name, path))
    return stamps
