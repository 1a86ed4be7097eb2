"""What a service tells the robot of its load does not fit the payload that it is part of.

The payload is everything mounted on the robot; the load is its part beside the tool. If it is set twice, or too high,
the arm pushes up against gravity that is not there as soon as it is controlled by torque, and detects
false collisions.

Example that is reported:

```yaml
devices:
  arm: {payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm,
                  load: {mass: 1.2 kg, center_of_mass: 0 0 90 mm,  # expect at load
                         inertia: 0.001 0.001 0.001 0 0 0 kg m^2}}}
```

Example that is accepted:

```yaml
devices:
  arm: {payload: {mass: 2.0 kg, center_of_mass: 0 0 58 mm,
                  load: {mass: 0.2 kg, center_of_mass: 0 0 90 mm, inertia: 0.001 0.001 0.001 0 0 0 kg m^2}}}
```

Fix: state as `load` only what is carried beside the tool, and a payload that holds both.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_ROUNDING_KG = 0.05  # masses of descriptions are rounded


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield loads that no service tells, and those that leave less of the payload than the tool weighs."""
    for device in graph.cell.devices:
        payload = device.payload
        if payload is None or payload.load is None:
            continue
        path = (*device.path, "payload", "load")
        if not device.robot.load_service:
            yield found(graph, path, f"no service tells `{device.name}` a load beside its tool")
            continue
        tools = (graph.cell.device(name) for name in device.carries)
        links = (link for tool in tools for link in tool.description.links)
        tool_kg = sum(link.inertial.mass for link in links if link.inertial is not None)
        if payload.load.mass_kg + tool_kg > payload.mass_kg + _ROUNDING_KG:
            stated = f"{payload.load.mass_kg:g} kg beside a tool of {tool_kg:.3g} kg"
            message = f"the load of `{device.name}` must fit its payload of {payload.mass_kg:g} kg, got {stated}"
            yield found(graph, path, message)
