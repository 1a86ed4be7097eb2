"""Rules on inputs and outputs, and on who sets them."""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, did_you_mean, found, rule, rules


def _used_twice(graph: CellGraph, which: str) -> Findings:
    """Yield the second use of an input or output, by another device or by the same: wiring is a map."""
    first: dict[str, YamlPath] = {}
    for device in graph.cell.devices:
        wires = {} if device.switched is None else getattr(device.switched, which)
        for name, interface in wires.items():
            path = (*device.path, "switching", which, name)
            owner = first.setdefault(interface, path)
            if owner != path:
                kind = which.removesuffix("s")
                message = f"`{device.name}` must have an {kind} of its own, got `{interface}` of `{owner[1]}`"
                yield found(graph, path, message, related=(Related("first used here", graph.cell.locate(*owner)),))


SHARED = rules(Severity.ERROR, _used_twice, {"shared-input": "inputs", "shared-output": "outputs"})


@rule(Severity.ERROR)
def unclaimed_signal(graph: CellGraph) -> Findings:
    """Yield outputs that no controller claims on the real target, and inputs that none reads."""
    devices = graph.cell.devices
    # `missing-real-plugin` reports devices without a real plugin.
    unnamed = {
        device.name
        for device in devices
        if device.control.hardware is not None and "real" not in device.control.hardware.targets
    }
    there = [
        controller
        for controller in graph.cell.controllers
        if "real" in controller.targets or controller.device in unnamed
    ]
    claimed = {interface for controller in there for interface in controller.claims("real")}
    read = {interface for controller in there for interface in controller.state_interfaces}
    for device in devices:
        if device.switched is None:
            continue
        path = (*device.path, "switching")
        for name, interface in device.switched.outputs.items():
            if interface not in claimed:
                yield found(graph, (*path, "outputs", name), f"no controller claims `{interface}`")
        for name, interface in device.switched.inputs.items():
            if interface not in read:
                yield found(graph, (*path, "inputs", name), f"no controller reads `{interface}`")


@rule(Severity.ERROR)
def unknown_sensor(graph: CellGraph) -> Findings:
    """Yield controllers with a `sensor_name` that no hardware exports, or a `frame_id` that is no frame."""
    hardware = [device.control.hardware for device in graph.cell.devices if device.control.hardware is not None]
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


@rule(Severity.ERROR)
def unwired_output(graph: CellGraph) -> Findings:
    """Yield each device with the outputs that it needs and that nothing drives."""
    for device in graph.cell.devices:
        switched = device.switched
        absent = [] if switched is None else [name for name in switched.signals if name not in switched.outputs]
        if absent:
            names = " and ".join(f"`{name}`" for name in absent)
            yield found(graph, (*device.path, "switching", "outputs"), f"nothing drives {names} of `{device.name}`")
