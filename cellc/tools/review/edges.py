"""Which ends of which interfaces connect: who publishes to whom, by the table of DDS."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.entities import ContractInterface
from cellc.contract.qos import Incompatibility, incompatibilities


@dataclass(frozen=True, slots=True)
class EdgeChange:
    """An edge that connects on one side of a diff and not on the other, or is new and does not."""

    subject: str
    before: str | None
    after: str
    connects: bool


def edge_changes(before: Contract, after: Contract) -> Iterator[EdgeChange]:
    """Yield edges of interfaces after the change whose samples arrive where they did not before, or the reverse."""
    was = dict(_edges(before))
    for edge, said in _edges(after):
        known = was.get(edge)
        if (known or _CONNECTED) != said and _CONNECTED in (known or _CONNECTED, said):
            yield EdgeChange(edge, known, said, said == _CONNECTED)


def offers_less(before: Contract, after: Contract) -> Iterator[tuple[str, Incompatibility]]:
    """Yield topics whose publishers offer less than they did, and what one misses that requests what was offered."""
    missing = dict[tuple[str, Incompatibility], None]()
    for name, interface in after.interfaces.items():
        known = before.interfaces.get(name)
        offered = {} if known is None else {source.node: source.qos for source in known.sources}
        for source in interface.sources:
            missed = incompatibilities(source.qos, offered[source.node]) if source.node in offered else ()
            missing |= dict.fromkeys((name, each) for each in missed)
    yield from missing


_CONNECTED = "connected"


def _edges(contract: Contract) -> Iterator[tuple[str, str]]:
    for name, interface in contract.interfaces.items():
        yield from _of_interface(name, interface)


def _of_interface(name: str, interface: ContractInterface) -> Iterator[tuple[str, str]]:
    for source in interface.sources:
        for sink in interface.sinks:
            mismatches = incompatibilities(source.qos, sink.qos)
            yield f"{name}: {source.node} to {sink.node}", "; ".join(map(str, mismatches)) or _CONNECTED
