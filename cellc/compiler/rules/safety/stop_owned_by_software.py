"""Software is made responsible for the safety of people.

The physical stop and the vendor's safety configuration belong to a person or a team. A node, a controller or a computer
of the cell cannot be responsible for them, nor can a QoS event, a domain id or a lifecycle state.

Example that is reported:

```yaml
owners: {responsibilities: {physical_stop: task}}  # expect at physical_stop
```

Example that is accepted:

```yaml
owners: {responsibilities: {physical_stop: safety}}
```

Fix: name the role that signs for it.

Source:

- docs/principles.md#stop
- docs/principles.md#owners-and-approvals
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule

_SOFTWARE = re.compile(
    r"(?i)\b(qos|deadline|liveliness|domain(_id)?|namespace|lifecycle|watchdog|ros2?|software|node)\b"
)


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield owners of the safety that are a part of the cell or a word for software."""
    cell = graph.cell
    parts = {*cell.hosts, *(node.name for node in cell.nodes), *(c.name for c in cell.controllers)}
    for path, owner in _safety_owners(graph):
        if owner in parts or _SOFTWARE.search(owner):
            message = f"`{path[-1]}` must be owned by people, got the software `{owner}`"
            yield found(graph, path, message)


def _safety_owners(graph: CellGraph) -> Iterator[tuple[YamlPath, str]]:
    owners, recovery = graph.cell.owners, graph.cell.safety.recovery
    yield ("owners", "responsibilities", "vendor_safety"), owners.responsibilities.vendor_safety
    yield ("owners", "responsibilities", "physical_stop"), owners.responsibilities.physical_stop
    yield ("owners", "approvals", "safety"), owners.approvals.safety
    yield ("safety", "recovery", "owner"), recovery.owner
    yield ("safety", "recovery", "observer"), recovery.observer
