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

from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.graph.claims import written_parameters
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_TYPES: dict[str, type] = {"bool": bool, "int": int, "double": float, "string": str}
_ARRAY = "_array"


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parameters of the spec whose value has another type than the declared one."""
    for written in written_parameters(graph.cell):
        kind, value = written.controller.declared, written.value
        facts = None if kind is None else kind.parameter(written.name, graph.cell.distro)
        expected = "none" if facts is None else facts.type
        item_type = _TYPES.get(expected.removesuffix(_ARRAY))
        is_list = isinstance(value, tuple)
        if item_type is None or (
            is_list == expected.endswith(_ARRAY) and all(type(item) is item_type for _, item in written.items())
        ):
            continue
        message = f"`{written.name}` of `{written.controller.name}` must be of type {expected}, got `{_shown(value)}`"
        yield found(graph, written.path, message, f"write {_corrected(value, expected)}")


def _corrected(value: ParameterValue, expected: str) -> str:
    items = value if isinstance(value, tuple) else (value,)
    if expected.startswith("double") and all(type(item) is int for item in items):
        doubles = tuple(float(item) for item in items)
        return f"`{_shown(doubles if expected.endswith(_ARRAY) else doubles[0])}`"
    return f"a value of type {expected}"


def _shown(value: ParameterValue) -> str:
    return f"[{', '.join(map(str, value))}]" if isinstance(value, tuple) else str(value)
