"""The stop is declared independent of a host that does not exist.

A misspelled host leaves the real one unmentioned.

Example that is reported:

```yaml
safety: {stop: {independent_of: [control_pc, controll_pc]}}  # expect at independent_of.1
```

Example that is accepted:

```yaml
safety: {stop: {independent_of: [control_pc]}}
```

Fix: name hosts of the cell.

Source: docs/principles.md#stop
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield names that are no host."""
    hosts = graph.cell.hosts
    for index, name in enumerate(graph.cell.safety.stop.independent_of):
        if name not in hosts:
            path = ("safety", "stop", "independent_of", index)
            yield found(graph, path, f"there is no host `{name}`", did_you_mean(name, hosts, "hosts"))
