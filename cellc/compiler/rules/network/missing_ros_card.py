"""A host of several has no card for ROS.

Its nodes find the others over a card that was meant for something else, or not at all: the middleware is bound to the
cards that carry `ros`, and takes what it finds where none does.

Example that is reported:

```yaml
# a cell of two computers
hosts:
  vision_pc: {nics: {cell: {carries: [bag]}}}  # expect at nics
```

Example that is accepted:

```yaml
# a cell of two computers
hosts:
  vision_pc: {nics: {cell: {carries: [ros, bag]}}}
```

Fix: add `ros` to what one of its cards carries.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield hosts that run nodes and have cards, none of which carries ROS, where another host runs nodes too."""
    running = {node.host for node in graph.cell.nodes} | {manager.host for manager in graph.cell.managers}
    hosts = [host for host in graph.cell.hosts.values() if host.name in running]
    with_card = [host for host in hosts if any("ros" in nic.carries for nic in host.nics.values())]
    if not with_card:
        return
    for host in hosts:
        if host.nics and host not in with_card:
            others = ", ".join(f"`{other.name}`" for other in with_card)
            message = f"`{host.name}` runs nodes and must have a card that carries `ros`, as {others} has"
            related = tuple(Related("nodes of the cell run here too", other.span) for other in with_card)
            yield found(graph, (*host.path, "nics"), message, related=related)
