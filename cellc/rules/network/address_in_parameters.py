"""A node holds the address of a real device in its parameters.

The parameters are the same forevery target. On the mock the node then talks to the real machine, past everything that
was meant to keep it out.

Example that is reported:

```yaml
nodes:
  task: {parameters: {robot_ip: 192.168.56.101}}  # expect at robot_ip
```

Example that is accepted:

```yaml
nodes:
  task: {parameters: {robot: arm}}
```

Fix: leave the address to `connection:` of the device, which only the real target reads.

Source: docs/principles.md#mock-and-real
"""

from __future__ import annotations

import re

from cellc.cell.interface import NodeSource
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule

_ADDRESS = re.compile(r"(?<![\d.])\d{1,3}(?:\.\d{1,3}){3}(?![\d.])")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parameters of nodes of the spec that hold the address of a connected device."""
    owners = {str(link.address): link.device for link in graph.network.devices if link.address is not None}
    for node in graph.cell.nodes:
        if node.source is not NodeSource.SPEC:
            continue
        for name, value in node.parameters.items():
            texts = value if isinstance(value, tuple) else (value,)
            held = [a for text in texts if isinstance(text, str) for a in _ADDRESS.findall(text) if a in owners]
            if held:
                message = f"parameter `{name}` of `{node.name}` holds {held[0]}, the address of `{owners[held[0]]}`"
                path = (*node.path, "parameters", name)
                yield found(graph, path, message)
