"""Hosts exchange stamps without a bound on their clocks.

A stamp from another computer is only as good as the offset between the two clocks.

Example that is reported:

```yaml
# a cell of two computers
hosts:
  vision_pc: {clock: {domain: ros, synchronised_by: null, max_offset: null}}  # expect at clock
```

Example that is accepted:

```yaml
# a cell of two computers
hosts:
  vision_pc: {clock: {domain: ros, synchronised_by: chrony, max_offset: 1 ms}}
```

Fix: synchronize the hosts by PTP or chrony, and write `synchronised_by` and the monitored `max_offset`.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield hosts of a cell with several that are not synchronized within a bound."""
    hosts = graph.cell.hosts
    if len(hosts) < 2:
        return
    for name, host in hosts.items():
        if host.clock.synchronised_by is None or host.clock.max_offset_s is None:
            field = "synchronised_by" if host.clock.synchronised_by is None else "max_offset"
            message = f"the clock of host `{name}` does not state `{field}`"
            path = ("hosts", name, "clock", field)
            yield found(graph, path, message)
