"""Hosts that exchange stamps follow different clocks.

Each clock may be kept well within its own domain. Between two domains nothing bounds the offset: every age and every
transform that crosses them is off by an unknown time.

Example that is reported:

```yaml
hosts:
  control_pc: {nics: {cell: {address: 10.20.0.10/24, carries: [ros]}}}
  vision_pc: {scheduling: generic,
              clock: {domain: vision, synchronised_by: ptp4l, max_offset: 1 ms},  # expect at domain
              nics: {cell: {address: 10.20.0.11/24, carries: [ros]}}}
network: {discovery: multicast}
nodes: {perception: {host: vision_pc}}
safety: {stop: {independent_of: [control_pc, vision_pc]}}
```

Example that is accepted:

```yaml
hosts:
  control_pc: {nics: {cell: {address: 10.20.0.10/24, carries: [ros]}}}
  vision_pc: {scheduling: generic, clock: {domain: ros, synchronised_by: chrony, max_offset: 1 ms},
              nics: {cell: {address: 10.20.0.11/24, carries: [ros]}}}
network: {discovery: multicast}
nodes: {perception: {host: vision_pc}}
safety: {stop: {independent_of: [control_pc, vision_pc]}}
```

Fix: let all hosts follow one grandmaster or server, and write one domain.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Related, Severity, found, rule


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
