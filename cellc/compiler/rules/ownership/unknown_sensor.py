"""A broadcaster reads a sensor, or stamps a frame, that no device has.

The controller manager refuses to activate a broadcaster whose sensor it does not know: usually the prefix of the device
is missing. A frame without a publisher shows later, when the reader cannot transform the first sample.

Example that is reported:

```yaml
control:
  controllers:
    force: {type: force_torque_sensor_broadcaster, device: arm,
            parameters: {sensor_name: tcp_fts_sensor, frame_id: arm_tool0}}  # expect at sensor_name
```

Example that is accepted:

```yaml
frames: {probe: {parent: arm/tool0, xyz: 0 0 10 mm, designed: true}}
```

Fix: write the name with the prefix of its device.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/force_torque_sensor_broadcaster/doc/userdoc.html
(Jazzy): sensor_name as in the ros2_control tag of the description
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield controllers with a `sensor_name` that no hardware exports, or a `frame_id` that is no frame."""
    hardware = [device.hardware for device in graph.cell.devices if device.hardware is not None]
    sensors = [sensor.name for component in hardware for sensor in component.sensors]
    known = {
        "sensor_name": (sensors, "no hardware exports such a sensor", "sensors"),
        "frame_id": (list(graph.frames.names()), "there is no such frame", "frames"),
    }
    for controller in graph.cell.controllers:
        for name, (names, why, kind) in known.items():
            value = controller.parameters.get(name) if name in controller.written_parameters else None
            if isinstance(value, str) and value and value not in names:
                path = (*controller.path, "parameters", name)
                message = f"`{controller.name}` names `{value}` as its `{name}`, but {why}"
                yield found(graph, path, message, did_you_mean(value, names, kind))
