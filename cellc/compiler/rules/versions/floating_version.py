"""A version is not pinned.

A branch, a range or "latest" means another thing tomorrow. What was tested is then not what runs.

Example that is reported:

```yaml
versions: {moveit: main}  # expect at moveit
```

Example that is accepted:

```yaml
versions: {moveit: 2.12.4}
```

Fix: write the exact version or digest.

Source: docs/principles.md#pinned-versions
"""

from __future__ import annotations

import re

from cellc.compiler.graph.versions import Pin, cell_pins, device_pins
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_FLOATING = re.compile(r"(?i)\b(latest|main|master|devel|develop|head|nightly|stable|any|tip)\b|[<>~^*]|\.x\b")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parts of the tuple that name a branch, a range or the latest."""
    rollback = graph.cell.versions.rollback
    pins = [*cell_pins(graph.cell), *device_pins(graph.cell)]
    pins.append(Pin(graph.cell.name, "rollback image", rollback.image, ("versions", "rollback", "image")))
    for pin in pins:
        match = _FLOATING.search(pin.text)
        if match is not None:
            message = f"`{pin.part}` of `{pin.holder}` is `{pin.text}`, which is not one exact version"
            yield found(graph, pin.path, message)
