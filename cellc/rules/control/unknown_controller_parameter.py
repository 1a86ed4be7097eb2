"""A controller has no such parameter.

Unknown parameters are ignored without a word. A misspelt tolerance is then a tolerance of zero, which means none.

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

import re

from cellc.graph.claims import written_parameters
from cellc.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parameters of the spec that the kind of the controller does not declare for the distribution."""
    for written in written_parameters(graph.cell):
        kind = written.controller.declared
        if kind is None:
            continue
        here = {name for name, facts in kind.parameters.items() if not facts.only or graph.cell.distro in facts.only}
        here |= written.controller.plugin_parameters
        if not any(_matches(declared, written.name) for declared in here):
            message = f"`{written.controller.kind}` has no parameter `{written.name}` in {graph.cell.distro}"
            yield found(graph, written.path, message, did_you_mean(written.name, here, "parameters"))


def _matches(declared: str, name: str) -> bool:
    # `<joint>` stands for any name, which may itself hold dots.
    parts = (re.escape(part) for part in re.split(r"<[a-z_]+>", declared))
    return re.fullmatch(".+".join(parts), name) is not None
