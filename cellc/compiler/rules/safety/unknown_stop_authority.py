"""It is not stated what stops the machine.

Before anything is enabled, everybody knows what stops it and by which path. UNKNOWN keeps the real cell closed.

Example that is reported:

```yaml
safety: {stop: {authority: UNKNOWN}}  # expect at authority
```

Example that is accepted:

```yaml
safety: {stop: {authority: safety_plc}}
```

Fix: name the safety controller or relay, and the path to the drives.

Source:

- docs/principles.md#stop
- https://www.iso.org/standard/73934.html (ISO 10218-2:2025): robot cells
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield an unknown stop authority or path."""
    stop = graph.cell.safety.stop
    if not any(controller.command_interfaces for controller in graph.cell.controllers):
        return
    missing = [name for name, text in (("authority", stop.authority), ("path", stop.path)) if text == UNKNOWN]
    if missing:
        names = " and ".join(f"`{name}`" for name in missing)
        message = f"the stop {names} {'are' if len(missing) > 1 else 'is'} UNKNOWN"
        yield found(graph, ("safety", "stop", missing[0]), message)
