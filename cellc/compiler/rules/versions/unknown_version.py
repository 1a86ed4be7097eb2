"""A part of the version tuple is UNKNOWN.

An unrecorded combination cannot be tested, repeated or rolled back. UNKNOWN is an honest answer and keeps
the real cell closed until somebody looks.

Example that is reported:

```yaml
versions: {kernel: UNKNOWN}  # expect at kernel
```

Example that is accepted:

```yaml
versions: {kernel: 6.8.1-1015-realtime}
```

Fix: read the version on the machine, the teach pendant or the nameplate, and write it down.

Source: docs/principles.md#pinned-versions
"""

from __future__ import annotations

from cellc.compiler.graph.versions import Pin, cell_pins, device_pins
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield each part written as UNKNOWN, and the unwritten parts of each holder in one finding."""
    unwritten: dict[str, list[Pin]] = {}
    for pin in (*cell_pins(graph.cell), *device_pins(graph.cell)):
        if pin.known:
            continue
        if graph.cell.states(*pin.path):
            yield found(graph, pin.path, f"`{pin.part}` of `{pin.holder}` is UNKNOWN")
        else:
            unwritten.setdefault(pin.holder, []).append(pin)
    for holder, pins in unwritten.items():
        names = ", ".join(f"`{pin.part}`" for pin in pins)
        yield found(graph, pins[0].path[:-1], f"`{holder}` does not state its {names}")
