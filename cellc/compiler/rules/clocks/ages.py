"""Rules on how old a sample may be, and on what happens when it is older."""

from __future__ import annotations

import math

from cellc.compiler.graph.data_flow import AgeShare, age_chains, age_share, is_state_on_change
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.vocabulary import InterfaceKind


@rule(Severity.ERROR, assumes=("max-age-too-short",))
def age_budget_exceeded(graph: CellGraph) -> Findings:
    """Yield topics whose age limit is below the sum of the shares of their chain."""
    chains = age_chains(graph.cell)
    for interface in graph.cell.interfaces:
        shares = chains.get(interface.name, ())
        needed = sum(share.total_s for share in shares)
        if interface.max_age_s is None or len(shares) < 2 or interface.max_age_s >= needed:
            continue
        way = " + ".join(str(share) for share in shares)
        age = interface.max_age_s * 1e3
        message = f"`max_age` of `{interface.name}` must be at least {needed * 1e3:.4g} ms ({way}), got {age:g} ms"
        related = tuple(
            Related("part of the chain", graph.cell.locate(*share.path))
            for share in shares
            if share.path != interface.path
        )
        related += enters(graph, "a fresh sample is a period old", (*interface.path, "rate"))
        related += _exposures(graph, shares)
        advice = f"allow at least {math.ceil(needed * 1e3)} ms, or raise a rate of the chain"
        yield found(graph, (*interface.path, "max_age"), message, advice, related)


@rule(Severity.ERROR)
def continues_on_stale(graph: CellGraph) -> Findings:
    """Yield topics on which a stale sample changes nothing."""
    for interface in graph.cell.interfaces:
        if interface.on_stale == "continue":
            message = f"`{interface.name}` is used even when it is stale"
            path = (*interface.path, "on_stale")
            yield found(graph, path, message)


@rule(Severity.ERROR)
def continues_on_timeout(graph: CellGraph) -> Findings:
    """Yield services and actions whose timeout changes nothing."""
    for interface in graph.cell.interfaces:
        if interface.on_timeout == "continue":
            message = f"the client of `{interface.name}` continues when no answer comes"
            yield found(graph, (*interface.path, "on_timeout"), message)


@rule(Severity.ERROR)
def max_age_too_short(graph: CellGraph) -> Findings:
    """Yield topics whose age limit is below their budget."""
    for interface in graph.cell.interfaces:
        if interface.max_age_s is None or not interface.rate_hz:
            continue
        share = age_share(graph.cell, interface)
        if interface.max_age_s < share.total_s:
            parts = (
                f"period {share.period_s * 1e3:.4g}, transport {share.transport_s * 1e3:g}, "
                f"exposure {share.exposure_s * 1e3:g} ms"
            )
            bound, age = share.total_s * 1e3, interface.max_age_s * 1e3
            message = f"`max_age` of `{interface.name}` must be at least {bound:.4g} ms ({parts}), got {age:g} ms"
            path = (*interface.path, "max_age")
            keys = [key for key in ("transport", "rate") if graph.cell.states(*interface.path, key)]
            related = tuple(Related("a part of it", graph.cell.locate(*interface.path, key)) for key in keys)
            yield found(graph, path, message, f"allow at least {math.ceil(bound)} ms, or raise the rate", related)


@rule(Severity.ERROR)
def missing_max_age(graph: CellGraph) -> Findings:
    """Yield topics without an age limit from which a way leads to a controller."""
    unlimited = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.TOPIC and not interface.derived and interface.max_age_s is None
    ]
    feeding = graph.data.feeding_motion() if unlimited else frozenset()
    for interface in unlimited:
        if interface.name in feeding and not is_state_on_change(interface):
            way = graph.data.way_to_motion(interface)
            message = f"`{interface.name}` feeds motion ({way}) and has no `max_age`"
            yield found(graph, interface.path, message)


@rule(Severity.ERROR)
def unstated_stale_behavior(graph: CellGraph) -> Findings:
    """Yield topics with an age limit and nothing that follows from it."""
    for interface in graph.cell.interfaces:
        if not interface.derived and interface.max_age_s is not None and interface.on_stale is None:
            message = f"`{interface.name}` has a `max_age` of {interface.max_age_s:g} s but no `on_stale`"
            yield found(graph, interface.path, message)


def _exposures(graph: CellGraph, shares: tuple[AgeShare, ...]) -> tuple[Related, ...]:
    """Return the exposures that the shares of a chain count."""
    topics = {share.topic for share in shares if share.exposure_s}
    sources = {end.node for topic in graph.cell.interfaces if topic.name in topics for end in topic.sources}
    cameras = (device for device in graph.cell.devices if device.name in sources)
    return enters(graph, "an exposure", *((*device.path, "stamp", "exposure") for device in cameras))
