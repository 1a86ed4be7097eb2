"""The clocks of two hosts may lie further apart than an age limit between them.

The sample is stamped on one computer and judged on the other. With such an offset a stale sample passes for fresh, or
every sample is refused.

Example that is reported:

```yaml
# a cell of two computers
hosts:
  vision_pc: {clock: {max_offset: 500 ms}}  # expect at max_offset
```

Example that is accepted:

```yaml
# a cell of two computers
hosts:
  vision_pc: {clock: {max_offset: 5 ms}}
```

Fix: synchronize the hosts more tightly: the offset must be a small part of the age.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.site import Host
from cellc.compiler.graph.network import running_hosts
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@dataclass(frozen=True, slots=True)
class _Crossing:
    """A limit of age that is judged on another host than the one that stamps; the worse clock is first."""

    worse: Host
    better: Host
    interface: Interface
    max_age_s: float

    @property
    def offset_s(self) -> float:
        return sum(host.clock.max_offset_s or 0.0 for host in (self.worse, self.better))


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield, for each host, the tightest age limit that its clock alone or with the other one breaks."""
    reported: set[str] = set()
    for crossing in sorted(_crossings(graph), key=lambda one: one.max_age_s):
        if crossing.offset_s < crossing.max_age_s or crossing.worse.name in reported:
            continue
        reported.add(crossing.worse.name)
        age = f"{crossing.max_age_s * 1e3:g} ms, the `max_age` of `{crossing.interface.name}`"
        message = f"the clocks of `{crossing.worse.name}` and `{crossing.better.name}` must be nearer than {age},"
        message += f" got {crossing.offset_s * 1e3:g} ms"
        related = (Related("the age is limited here", graph.cell.locate(*crossing.interface.path, "max_age")),)
        yield found(graph, (*crossing.worse.path, "clock", "max_offset"), message, related=related)


def _crossings(graph: CellGraph) -> Iterator[_Crossing]:
    hosts = graph.cell.hosts
    running = running_hosts(graph.cell)
    for interface in graph.cell.interfaces:
        ends = ((source, sink) for source in interface.sources for sink in interface.sinks)
        for source, sink in ends if interface.max_age_s is not None else ():
            pair = [hosts.get(running.get(end.full_name, "")) for end in (source, sink)]
            one, other = pair
            if one is None or other is None or one.name == other.name:
                continue
            worse, better = sorted((one, other), key=lambda host: -(host.clock.max_offset_s or 0.0))
            yield _Crossing(worse, better, interface, interface.max_age_s or 0.0)
