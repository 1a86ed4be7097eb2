"""A controller parameter is outside its range.

The controller refuses the value when it is configured, and stays unconfigured.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {parameters: {action_monitor_rate: 0.0}}  # expect at action_monitor_rate
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {parameters: {action_monitor_rate: 50.0}}
```

Fix: use a value inside the range.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.catalog.controller_kind import ParameterFacts
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.graph.claims import written_parameters
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield numbers below or above what the declaration allows, items of lists too, and texts that it does not list."""
    for written in written_parameters(graph.cell):
        kind = written.controller.declared
        facts = None if kind is None else kind.parameter(written.name, graph.cell.distro)
        if facts is None:
            continue
        subject = f"`{written.name}` of `{written.controller.name}`"
        if facts.not_empty and written.value in ("", ()):
            yield found(graph, written.path, f"{subject} must not be empty")
        seen: list[ParameterValue] = []
        for path, item in written.items():
            reason = _refusal(facts, item) or ("must not repeat an item" if facts.unique and item in seen else "")
            seen.append(item)
            if reason:
                yield found(graph, path, f"{subject} {reason}, got `{item}`")


def _refusal(facts: ParameterFacts, value: ParameterValue) -> str:
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        if facts.minimum is not None and value < facts.minimum:
            return f"must be at least {facts.minimum:g}"
        if facts.exclusive_minimum is not None and value <= facts.exclusive_minimum:
            return f"must be more than {facts.exclusive_minimum:g}"
        if facts.maximum is not None and value > facts.maximum:
            return f"must be at most {facts.maximum:g}"
    choices = facts.one_of or facts.subset_of
    if isinstance(value, str) and choices and value not in choices:
        return "must be one of " + ", ".join(choices)
    return ""
