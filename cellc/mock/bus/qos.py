"""Whether two endpoints match by their QoS, under the rules of the pinned middleware.

DDS compares by the table of ``contract.qos``; with Zenoh any two endpoints of a topic match.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cellc.contract.contract import Contract
from cellc.contract.entities import ContractEndpoint, Qos
from cellc.contract.frozen import dataclass
from cellc.contract.qos import Incompatibility, incompatibilities

ZENOH_PREFIX = "rmw_zenoh"


@dataclass(frozen=True, slots=True)
class Middleware:
    """Rules of one middleware.

    Attributes:
        compare: returns every policy that keeps an offering and a requesting endpoint apart.
        reports_events: it reports missed deadlines and lost liveliness.
    """

    compare: Callable[[Qos, Qos], tuple[Incompatibility, ...]]
    reports_events: bool


def _any_two_match(offered: Qos, requested: Qos) -> tuple[Incompatibility, ...]:
    return ()


DDS = Middleware(incompatibilities, reports_events=True)
ZENOH = Middleware(_any_two_match, reports_events=False)
"""Endpoints on one key always match; rmw_zenoh_cpp has no events for deadlines and leases."""


def middleware_of(contract: Contract) -> Middleware:
    """Return the rules of the middleware that a cell pins; those of DDS where it pins none."""
    return ZENOH if contract.version_tuple.get("rmw", "").startswith(ZENOH_PREFIX) else DDS


def unmatched_pairs(contract: Contract) -> tuple[str, ...]:
    """Say which declared endpoints do not connect and on which policy, in the order of interface names.

    A service or an action is asked in both directions: requests flow from client to server, answers back.
    """
    return tuple(_unmatched(contract))


def hears(contract: Contract, topic: str, source: str, sink: str) -> bool:
    """Tell whether what ``source`` publishes reaches ``sink``; a pair that the contract does not describe connects."""
    declared = contract.interfaces.get(topic)
    if declared is None:
        return True
    compare = middleware_of(contract).compare
    pairs = [(a, b) for a in declared.sources for b in declared.sinks if (a.node, b.node) == (source, sink)]
    return not pairs or any(not compare(a.qos, b.qos) for a, b in pairs)


def task_node(contract: Contract) -> str:
    """Return the node that the mock's task represents: the client of the action that plans and executes.

    Where there is no such action it is the client of a controller or an adapter.
    """
    own_actions = served_actions(contract).values()
    for name, interface in sorted(contract.interfaces.items()):
        if interface.kind == "action" and name not in own_actions and interface.sinks:
            return interface.sinks[0].node
    controllers = [entry for manager in contract.managers.values() for entry in manager.controllers.values()]
    clients = [*(entry.client for entry in controllers), *(entry.client for entry in contract.adapters.values())]
    return next((client for client in clients if client is not None), "task")


def served_actions(contract: Contract) -> dict[str, str | None]:
    """Return the action of every controller, and of every device behind an adapter."""
    controllers = {name: entry for manager in contract.managers.values() for name, entry in manager.controllers.items()}
    served: dict[str, str | None] = {name: entry.action for name, entry in controllers.items()}
    return served | {name: entry.action for name, entry in contract.adapters.items()}


def _unmatched(contract: Contract) -> Iterator[str]:
    rules = middleware_of(contract)
    for name, interface in sorted(contract.interfaces.items()):
        for source in interface.sources:
            for sink in interface.sinks:
                yield from _mismatch(rules, name, source, sink)
                if interface.kind != "topic":
                    yield from _mismatch(rules, name, sink, source)


def _mismatch(rules: Middleware, name: str, offering: ContractEndpoint, requesting: ContractEndpoint) -> Iterator[str]:
    for problem in rules.compare(offering.qos, requesting.qos):
        yield f"`{name}` from `{offering.node}` to `{requesting.node}` is not connected: {problem}"
