"""A controller refuses this combination of command interfaces.

The controller checks the combination when it is configured, and stays unconfigured.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [velocity, position]}  # expect at command_interfaces
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [position, velocity]}
```

Fix: use a combination of the controller, in its order.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("unprovided-command-interface",))
def check(graph: CellGraph) -> Findings:
    """Yield controllers with a combination that their kind does not list."""
    for controller in graph.cell.controllers:
        kind = controller.declared
        if kind is None or not kind.command_combinations or not controller.joints:
            continue
        prefix = f"{controller.joints[0]}/"
        for claims in dict.fromkeys(controller.claims(target) for target in controller.targets):
            names = tuple(c.removeprefix(prefix) for c in claims if c.startswith(prefix))
            if names not in kind.command_combinations:
                allowed = "; ".join(", ".join(combination) for combination in kind.command_combinations)
                message = f"`{controller.name}` refuses the command interfaces {' + '.join(names)}"
                yield found(graph, (*controller.path, "command_interfaces"), message, f"use one of: {allowed}")
