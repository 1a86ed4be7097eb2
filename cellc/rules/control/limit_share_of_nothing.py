"""A cell leaves a device no speed.

A share of zero or less leaves no trajectory that ends. Whoever wants to hold an arm deactivates its controller.

Example that is reported:

```yaml
devices: {arm: {limits: {velocity: 0 %}}}
```

Example that is accepted:

```yaml
devices: {arm: {limits: {velocity: 10 %}}}
```

Fix: write a share above zero.

Source: time parameterisation divides by the limit.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield shares of zero and below."""
    for device in graph.cell.devices:
        limits = device.spec.limits
        shares = () if limits is None else (("velocity", limits.velocity), ("acceleration", limits.acceleration))
        for name, share in shares:
            if share is not None and share.si <= 0.0:
                message = f"`{device.name}` is left {share.text} of its {name} limit"
                yield found(graph, (*device.path, "limits", name), message, "write a share above zero")


RULE = define("limit-share-of-nothing", Severity.ERROR, check, __doc__)
