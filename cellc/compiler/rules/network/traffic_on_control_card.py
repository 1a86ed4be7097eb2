"""The card of the robot carries other traffic.

An image or a bag upload fills the queue of the card for milliseconds. A robot that expects a packet every 2 ms stops.

Example that is reported:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.10/24, carries: [control, camera]}}}  # expect at carries
```

Example that is accepted:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.10/24, carries: [control]}}}
```

Fix: put cameras, bags and the internet on another card.

Source: docs/principles.md#the-control-link
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield cards that carry control and something else."""
    for nic in graph.network.nics:
        others = [kind for kind in nic.carries if kind != "control"]
        if "control" in nic.carries and others:
            message = f"`{nic.full_name}` carries control together with {', '.join(others)}"
            yield found(graph, (*nic.path, "carries"), message)
