"""A controller parameter has another type than declared.

ROS distinguishes 1 from 1.0. A parameter of the wrong type ends the controller when it is configured.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {parameters: {action_monitor_rate: 50}}  # expect at action_monitor_rate
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {parameters: {action_monitor_rate: 50.0}}
```

Fix: write a decimal point for a double, and none for an integer.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.graph.claims import written_parameters
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule

_TYPES: dict[str, tuple[type, ...]] = {"bool": (bool,), "int": (int,), "double": (float,), "string": (str,)}


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield scalar parameters of the spec whose value has another type."""
    for written in written_parameters(graph.cell):
        kind = written.controller.declared
        facts = None if kind is None else kind.parameters.get(written.name)
        expected = None if facts is None else facts.type
        value = written.value
        if expected in _TYPES and type(value) not in _TYPES[expected]:
            message = f"`{written.name}` of `{written.controller.name}` must be of type {expected}, got `{value}`"
            advice = (
                f"write `{float(value)}`"
                if expected == "double" and isinstance(value, int)
                else f"write a value of type {expected}"
            )
            yield found(graph, written.path, message, advice)
