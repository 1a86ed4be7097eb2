"""A host without real-time scheduling runs a driver that needs it.

An ordinary kernel lets other work delay the loop by many milliseconds. The vendor asks for a preemptible one.

Example that is reported:

```yaml
hosts: {control_pc: {scheduling: generic}}  # expect at scheduling
```

Example that is accepted:

```yaml
hosts: {control_pc: {scheduling: preempt_rt}}
```

Fix: install a PREEMPT_RT or low-latency kernel, and measure the missed cycles.

Source:

- docs/principles.md#the-control-link
- docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield hosts that run drivers for which real time is asked, with a generic or unknown kernel."""
    reported: set[str] = set()
    for device in graph.cell.devices:
        needs, link = device.network, device.connection
        if needs is None or link is None or needs.realtime == "not_needed" or link.host in reported:
            continue
        host = graph.cell.hosts.get(link.host)
        if host is not None and host.scheduling in ("generic", UNKNOWN):
            reported.add(link.host)
            message = f"`{link.host}` must have real-time scheduling for `{device.name}`, got `{host.scheduling}`"
            path = ("hosts", link.host, "scheduling")
            yield found(graph, path, message)
