"""An event of the software is taken as evidence of a safe state.

An active lifecycle node, a QoS event, a domain id or a successful launch says that processes run. None says that a
protective stop is cleared or that the cell is empty.

Example that is reported:

```yaml
safety: {stop: {evidence: [lifecycle active]}}  # expect at evidence.0
```

Example that is accepted:

```yaml
safety: {stop: {evidence: [injected-stop result]}}
```

Fix: name the result of a test at the machine.

Source: docs/principles.md#stop
"""

from __future__ import annotations

import re

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_SOFTWARE = re.compile(
    r"(?i)\b(lifecycle|qos|deadline|liveliness|lease|domain|namespace|launch(ed)?|node active|topic|heartbeat|log)\b"
)


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield pieces of evidence that name something of the software."""
    for index, text in enumerate(graph.cell.safety.stop.evidence):
        match = _SOFTWARE.search(text)
        if match is not None:
            path = ("safety", "stop", "evidence", index)
            message = f"`{text}` says nothing about a safe state"
            yield found(graph, path, message)
