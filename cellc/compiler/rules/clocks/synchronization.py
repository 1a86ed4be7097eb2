"""Rules on clocks that are compared, and how far they may be apart."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.site import Host
from cellc.compiler.graph.network import running_hosts
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN


@rule(Severity.ERROR)
def clock_offset_beyond_age(graph: CellGraph) -> Findings:
    """Yield sensors whose clock offset reaches the age limit of one of their topics."""
    for device in graph.cell.devices:
        stamp = device.sensing.stamp
        if stamp is None or stamp.clock.max_offset_s is None:
            continue
        limits = [
            interface
            for interface in graph.cell.interfaces
            if interface.max_age_s is not None and any(end.node == device.name for end in interface.sources)
        ]
        shortest = min(limits, key=lambda interface: interface.max_age_s or 0.0, default=None)
        if shortest is not None and stamp.clock.max_offset_s >= (shortest.max_age_s or 0.0):
            path = (*device.path, "stamp", "max_offset")
            offset = graph.cell.text(*path)
            age = f"{(shortest.max_age_s or 0.0) * 1e3:g} ms, the `max_age` of `{shortest.name}`"
            message = f"the clock offset of `{device.name}` must be below {age}, got {offset}"
            related = (Related("the age is limited here", graph.cell.locate(*shortest.path, "max_age")),)
            yield found(graph, path, message, related=related)


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
def host_offset_beyond_age(graph: CellGraph) -> Findings:
    """Yield, for each host, the tightest age limit that its clock alone or with the other one breaks."""
    reported: set[str] = set()
    for crossing in sorted(_crossings(graph), key=lambda one: one.max_age_s):
        if crossing.offset_s < crossing.max_age_s or crossing.worse.name in reported:
            continue
        reported.add(crossing.worse.name)
        age = f"{crossing.max_age_s * 1e3:g} ms, the `max_age` of `{crossing.interface.name}`"
        message = f"the clocks of `{crossing.worse.name}` and `{crossing.better.name}` must differ by less than {age},"
        message += f" got {crossing.offset_s * 1e3:g} ms"
        related: tuple[Related, ...] = (
            Related("the age is limited here", graph.cell.locate(*crossing.interface.path, "max_age")),
        )
        related += enters(graph, "the other clock", (*crossing.better.path, "clock", "max_offset"))
        yield found(graph, (*crossing.worse.path, "clock", "max_offset"), message, related=related)


def _crossings(graph: CellGraph) -> Iterator[_Crossing]:
    hosts = graph.cell.hosts
    running = running_hosts(graph.cell)
    most_s = sum(sorted((host.clock.max_offset_s or 0.0 for host in hosts.values()), reverse=True)[:2])
    for interface in graph.cell.interfaces:
        ends = ((source, sink) for source in interface.sources for sink in interface.sinks)
        for source, sink in ends if interface.max_age_s is not None and interface.max_age_s <= most_s else ():
            pair = [hosts.get(running.get(end.full_name, "")) for end in (source, sink)]
            first, other = pair
            if first is None or other is None or first.name == other.name:
                continue
            worse, better = sorted((first, other), key=lambda host: -(host.clock.max_offset_s or 0.0))
            yield _Crossing(worse, better, interface, interface.max_age_s or 0.0)


@rule(Severity.BLOCKER)
def unsynchronized_hosts(graph: CellGraph) -> Findings:
    """Yield hosts of a cell with several that are not synchronized within a bound."""
    hosts = graph.cell.hosts
    if len(hosts) < 2:
        return
    for name, host in hosts.items():
        if host.clock.synchronized_by is None or host.clock.max_offset_s is None:
            field = "synchronized_by" if host.clock.synchronized_by is None else "max_offset"
            message = f"the clock of host `{name}` does not state `{field}`"
            path = ("hosts", name, "clock", field)
            yield found(graph, path, message)
        elif _BY_NOTHING.fullmatch(host.clock.synchronized_by):
            message = f"the clock of host `{name}` must be kept by a program, got `{host.clock.synchronized_by}`"
            yield found(graph, ("hosts", name, "clock", "synchronized_by"), message)


_BY_NOTHING = re.compile(r"(?i)no|none|nothing|not?\b.*|off|rtc|.*\b(hand|manual|manually|hwclock)\b.*|date\b.*")


@rule(Severity.BLOCKER)
def unsynchronized_sensor_clock(graph: CellGraph) -> Findings:
    """Yield stamps of a clock of their own without synchronization or without a bound."""
    host_domains = {host.clock.domain for host in graph.cell.hosts.values()} or {"ros"}
    for device in graph.cell.devices:
        stamp = device.sensing.stamp
        if stamp is None or stamp.source != "hardware" or stamp.clock.domain in (UNKNOWN, *host_domains):
            continue
        if stamp.clock.synchronized_by is None or stamp.clock.max_offset_s is None:
            field = "synchronized_by" if stamp.clock.synchronized_by is None else "max_offset"
            message = f"clock `{stamp.clock.domain}` of `{device.name}` does not state `{field}`"
            path = (*device.path, "stamp", field)
            yield found(graph, path, message)
