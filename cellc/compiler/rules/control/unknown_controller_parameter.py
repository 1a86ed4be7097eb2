"""A controller has no such parameter.

Unknown parameters are ignored silently. A misspelled tolerance is then a tolerance of zero, which means none.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {parameters: {action_monitor_rat: 50.0}}  # expect at action_monitor_rat
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {parameters: {action_monitor_rate: 50.0}}
```

Fix: use a parameter that the controller declares in this distribution.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.catalog.controller_kind import is_named
from cellc.compiler.graph.claims import written_parameters
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parameters of the spec that the kind of the controller does not declare for the distribution."""
    for written in written_parameters(graph.cell):
        kind = written.controller.declared
        if kind is None:
            continue
        here = {*kind.parameters_in(graph.cell.distro), *written.controller.plugin_parameters}
        if not any(is_named(declared, written.name) for declared in here):
            message = f"`{written.controller.kind}` has no parameter `{written.name}` in {graph.cell.distro}"
            yield found(graph, written.path, message, did_you_mean(written.name, here, "parameters"))
