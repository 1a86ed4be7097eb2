"""Hosts that exchange stamps follow different clocks.

Each clock may be kept well within its own domain. Between two domains nothing bounds the offset: every age and every
transform that crosses them is off by an unknown time.

Example that is reported:

```yaml
# a cell of two computers
hosts:
  vision_pc: {clock: {domain: vision, synchronised_by: ptp4l}}  # expect at domain
```

Example that is accepted:

```yaml
# a cell of two computers
hosts:
  vision_pc: {clock: {domain: ros, synchronised_by: chrony}}
```

Fix: let all hosts follow one grandmaster or server, and write one domain.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield hosts that run nodes in another clock domain than the controller manager, or than the first host."""
    running = {node.host for node in graph.cell.nodes}
    hosts = [host for host in graph.cell.hosts.values() if host.name in running]
    managing = {manager.host for manager in graph.cell.managers}
    hosts.sort(key=lambda host: host.name not in managing)
    for host in hosts[1:]:
        if host.clock.domain != hosts[0].clock.domain:
            message = f"the clock of `{host.name}` must be in the domain `{hosts[0].clock.domain}` of"
            message += f" `{hosts[0].name}`, got `{host.clock.domain}`"
            related = (Related("the other clock", graph.cell.locate(*hosts[0].path, "clock")),)
            yield found(graph, (*host.path, "clock", "domain"), message, related=related)
