"""A controller lacks a parameter that it demands.

The parameter has no default: the controller throws when it is initialized, and the controller manager unloads it. What
follows from the spec is written by cellc; what only the author can know is not.

Example that is reported:

```yaml
control:
  controllers:
    lamp: {type: gpio_command, device: arm, client: task}  # expect at lamp
```

Example that is accepted:

```yaml
control:
  controllers:
    lamp: {type: gpio_command, device: arm, client: task, parameters: {gpios: [lamp]}}
```

Fix: write the parameter under `parameters:` of the controller.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield controllers without a parameter that is required in the distribution and has no default."""
    for controller in graph.cell.controllers:
        kind = controller.declared
        declared = {} if kind is None else kind.parameters_in(graph.cell.distro)
        for name, facts in declared.items():
            if kind is None or name == kind.joints_parameter:
                continue  # where there is no joint to write, another rule says so
            # One for each name of a list, as in `gains.<joint>.p`, has a default in every kind.
            if facts.required and facts.default is None and "<" not in name and name not in controller.parameters:
                message = f"`{controller.kind}` demands `{name}`, and `{controller.name}` does not state it"
                yield found(graph, controller.path, message, f"write `parameters: {{{name}: ...}}`")
