"""An enclave has a longer name than a certificate takes.

SROS2 writes the path of an enclave into the common name of its certificate, and X.509 allows 64 characters there. The
cell builds and starts without security; on the day that access is to be enforced, no keys are made for this process,
and with `Enforce` it does not start.

Example that is reported:

```yaml
nodes:
  inspector: {run: cell_tasks/inspector, host: control_pc, owner: integration, lifecycle: true,  # expect at inspector
              namespace: /line_four/station_twelve/inspection_of_parts/second_shift}
```

Example that is accepted:

```yaml
nodes:
  inspector: {run: cell_tasks/inspector, host: control_pc, owner: integration, lifecycle: true,
              namespace: /station_twelve}
```

Fix: shorten the name of the cell, of the namespace or of the node.

Source: https://www.rfc-editor.org/rfc/rfc5280#appendix-A.1 (RFC 5280, ub-common-name): 64 characters
"""

from __future__ import annotations

from cellc.compiler.graph.enclaves import enclaves
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LONGEST = 64
"""Characters of a common name: RFC 5280, ub-common-name."""


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield enclaves that no certificate can name; a middleware without SROS2 has no enclaves."""
    if graph.cell.versions.rmw.startswith("rmw_zenoh"):
        return
    for name, path in enclaves(graph.cell):
        if len(name) > _LONGEST:
            message = f"enclave `{name}` must have at most {_LONGEST} characters, got {len(name)}"
            yield found(graph, path, message)
