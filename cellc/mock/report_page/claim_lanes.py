"""Who claimed which command interfaces over the time of a run, and what changed its state."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.mock.evidence.trace.claims import Claim, StateChange
from cellc.mock.evidence.trace.run_trace import TraceResult
from cellc.mock.report_page.element import tag
from cellc.mock.report_page.figures import at, count
from cellc.mock.report_page.lanes import Bar, axis, lane
from cellc.mock.report_page.panel import TimeAxis

_Spans = tuple[tuple[str, int, int, bool], ...]


def claims(trace: TraceResult, time: TimeAxis) -> Iterator[Element]:
    """Yield a lane for interfaces that were claimed alike, and the changes of controllers and hardware."""
    lanes = [_lane(interfaces, spans, time) for spans, interfaces in _alike(trace.claims).items()]
    lanes = lanes or [tag("p", "nobody claimed a command interface", class_="hint")]
    yield tag("div", tag("h3", "Claims of command interfaces"), *lanes, axis(time), class_="lanes")
    if trace.changes:
        rows = [_change(change) for change in trace.changes]
        head = tag("tr", *(tag("th", name) for name in ("at", "what", "became", "because")))
        table = tag("div", tag("table", tag("thead", head), tag("tbody", *rows)), class_="wide")
        title = f"{count(len(trace.changes), 'change')} of controllers and hardware"
        yield tag("details", tag("summary", title), table)


def _alike(all_claims: tuple[Claim, ...]) -> dict[_Spans, list[str]]:
    """Return the interfaces by what became of them."""
    by_interface: dict[str, list[tuple[str, int, int, bool]]] = {}
    for claim in all_claims:
        span = (claim.controller, claim.from_ns, claim.until_ns, claim.by_contract)
        by_interface.setdefault(claim.interface, []).append(span)
    alike: dict[_Spans, list[str]] = {}
    for interface, spans in by_interface.items():
        alike.setdefault(tuple(spans), []).append(interface)
    return alike


def _lane(interfaces: list[str], spans: _Spans, time: TimeAxis) -> Element:
    bars = [
        Bar(from_ns / 1e9, until_ns / 1e9, "claimed" if right else "ended", f"{owner}, {at(from_ns)} to {at(until_ns)}")
        for owner, from_ns, until_ns, right in spans
    ]
    owners = ", ".join(dict.fromkeys(owner for owner, *_ in spans))
    wrong = [] if all(right for *_, right in spans) else [tag("span", " not by contract", class_="bad")]
    named = interfaces[0] if len(interfaces) == 1 else count(len(interfaces), "interface")
    title = tag("span", named, title=", ".join(interfaces))
    return lane([tag("b", owners), " ", title, *wrong], bars, time)


def _change(change: StateChange) -> Element:
    cells = (f"{change.kind} {change.subject}", change.state, change.reason or "it was asked to")
    return tag("tr", tag("td", at(change.stamp_ns), class_="number"), *(tag("td", cell) for cell in cells))
