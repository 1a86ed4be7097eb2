"""A mock or simulated target reaches real hardware.

What is started to be safe would move the arm.

Example that is reported:

```yaml
targets: {mock: {hardware: real}}
```

Example that is accepted:

```yaml
targets: {mock: {hardware: mock}}
```

Fix: use the hardware of the target's name.

Source: chapter 4, section 5, gate L6: routing to the real interface is a stop condition; section 12, prompt B.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield targets other than real with real hardware."""
    for name, target in graph.cell.spec.targets.items():
        if name != "real" and target.hardware == "real":
            path = ("targets", name, "hardware")
            yield found(graph, path, f"target `{name}` uses real hardware", f"write `hardware: {name}`")


RULE = define("real-hardware-in-mock", Severity.ERROR, check, __doc__)
