"""What the discovery of all declared endpoints finds: the pairs that will never be connected."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.contract import Contract, ContractEndpoint
from cellc.mock.bus.qos import incompatibilities


def unmatched_pairs(contract: Contract) -> tuple[str, ...]:
    """Say which declared endpoints do not connect and on which policy, in the order of interface names.

    A service or an action is asked in both directions: requests flow from client to server, answers back.
    """
    return tuple(_unmatched(contract))


def connected(contract: Contract, interface: str, source: str, sink: str) -> bool:
    """Tell whether a declared pair of endpoints is compatible; a pair that is not declared does not exist."""
    declared = contract.interfaces[interface]
    pairs = ((a, b) for a in declared.sources for b in declared.sinks if (a.node, b.node) == (source, sink))
    return any(not incompatibilities(a.qos, b.qos) for a, b in pairs)


def _unmatched(contract: Contract) -> Iterator[str]:
    for name, interface in sorted(contract.interfaces.items()):
        for source in interface.sources:
            for sink in interface.sinks:
                yield from _mismatch(name, source, sink)
                if interface.kind != "topic":
                    yield from _mismatch(name, sink, source)


def _mismatch(name: str, offering: ContractEndpoint, requesting: ContractEndpoint) -> Iterator[str]:
    for problem in incompatibilities(offering.qos, requesting.qos):
        yield f"`{name}` from `{offering.node}` to `{requesting.node}` is not connected: {problem}"
