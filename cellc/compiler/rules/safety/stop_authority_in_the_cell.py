"""The authority to stop is given to a computer or a node of the cell.

A computer that plans and controls is what must be stopped. It hangs, reboots and updates itself.

Example that is reported:

```yaml
safety: {stop: {authority: control_pc}}  # expect at authority
```

Example that is accepted:

```yaml
safety: {stop: {authority: safety_plc}}
```

Fix: name the safety controller or relay.

Source: docs/principles.md#stop
"""

from __future__ import annotations

import re

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_SOFTWARE = re.compile(
    r"(?i)\b(ros|ros2|node|workstation|laptop|moveit|move_group|controller_manager|script|software)\b"
)


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield an authority that is a host, node or controller of the cell, or a word for software."""
    authority = graph.cell.safety.stop.authority
    parts = {*graph.cell.hosts, *(n.name for n in graph.cell.nodes), *(c.name for c in graph.cell.controllers)}
    if authority in parts or _SOFTWARE.search(authority):
        message = f"`{authority}` has the authority to stop, but is itself what must be stopped"
        yield found(graph, ("safety", "stop", "authority"), message)
