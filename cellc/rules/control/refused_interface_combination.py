"""A controller refuses this combination of command interfaces.

The controller checks the combination when it is configured, and stays unconfigured.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [velocity, position]}
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [position, velocity]}
```

Fix: use a combination of the controller, in its order.

Source: kind of controller in the catalogue, with its source.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.graph.controller_kinds import kind_of
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield controllers with a combination that their kind does not list."""
    for controller in graph.cell.controllers:
        kind = kind_of(graph.cell, controller)
        if kind is None or not kind.command_combinations or not controller.joints:
            continue
        prefix = f"{controller.joints[0]}/"
        names = tuple(c.removeprefix(prefix) for c in controller.command_interfaces if c.startswith(prefix))
        if names not in kind.command_combinations:
            allowed = "; ".join(", ".join(combination) for combination in kind.command_combinations)
            message = f"`{controller.name}` cannot command {' + '.join(names)}"
            yield found(graph, (*controller.path, "command_interfaces"), message, f"use one of: {allowed}")


RULE = define(
    "refused-interface-combination", Severity.ERROR, check, __doc__, assumes=("unprovided-command-interface",)
)
