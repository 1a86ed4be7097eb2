"""Whether the cells of a plant agree on what crosses between them, each by its own spec.

The bridge (domain_bridge 0.5.0) is started with the plant. It subscribes in the graph of the source and publishes in
that of the receiver, with one profile: reliability, durability, history and depth as its file says, which are those of
the publisher; deadline, lifespan and liveliness as the publisher offers them. So the spec of each cell names the bridge
as a node, and the checks of the cell hold for it. What is left to compare is that both specs say the same.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.plant.findings import finding
from cellc.compiler.plant.plant import Crossing, Part, Plant, bridge_node
from cellc.contract.diagnostics import Diagnostic, Related
from cellc.contract.transforms import apart
from cellc.contract.vocabulary import InterfaceKind

_FRAME_M, _FRAME_RAD = 1e-3, 1e-3
"""Frames of one name closer than this are one frame: specs write poses in whole millimeters and tenths of a degree."""
_SAME = ("type", "rate_hz", "frame", "unit", "time_source")


def check_crossings(plant: Plant) -> Iterator[Diagnostic]:
    """Yield where a cell lacks what crosses, and where the two ends say something different."""
    for crossing in plant.crossings:
        source, receiver = crossing.source, crossing.receiver
        if not crossing.name.startswith(f"/{source.key}/"):
            message = f"`{crossing.name}` comes from `{source.key}`, and must begin with `/{source.key}/`"
            yield _lacking(crossing, message, f"write `/{source.key}{crossing.name}`")
            continue
        sent = _interface(crossing, source)
        heard = _interface(crossing, receiver)
        for found in (sent, heard):
            if isinstance(found, Diagnostic):
                yield found
        if isinstance(sent, Interface):
            yield from _ends(crossing, source, sent)
        if isinstance(heard, Interface):
            yield from _ends(crossing, receiver, heard)
        if isinstance(sent, Interface) and isinstance(heard, Interface):
            yield from _differences(crossing, sent, heard)


def _interface(crossing: Crossing, part: Part) -> Interface | Diagnostic:
    name = part.own_name(crossing.name)
    found = part.interface(name)
    if found is None or found.kind is not InterfaceKind.TOPIC:
        message = f"`{part.key}` declares no topic `{name}`"
        return _lacking(crossing, message, f"declare it under `interfaces:` of `{part.file}`", part)
    return found


def _ends(crossing: Crossing, part: Part, interface: Interface) -> Iterator[Diagnostic]:
    """Yield which of its own node and the bridge the spec of a cell does not have at its end."""
    sends = part is crossing.source
    node = crossing.source_node if sends else crossing.receiver_node
    bridge = bridge_node(crossing.source, crossing.receiver, part)
    own, other = (interface.sources, interface.sinks) if sends else (interface.sinks, interface.sources)
    verbs = ("publishes", "hears") if sends else ("hears", "publishes")
    at = (Related("declared here", interface.span),)
    if not any(end.node == node for end in own):
        message = f"`{node}` of `{part.key}` {verbs[0]} no `{interface.name}`"
        yield _lacking(crossing, message, "name the node at the end of the topic", related=at)
    if not any(end.full_name == f"/{bridge}" for end in other):
        advice = f"write `{bridge}: {{run: domain_bridge/domain_bridge}}` under its `nodes:`, and name it in the topic"
        message = f"in `{part.key}` the bridge `{bridge}` {verbs[1]} no `{interface.name}`"
        yield _lacking(crossing, message, advice, related=at)
    elif not _is_bridge(part, bridge):
        message = f"`{bridge}` of `{part.key}` is no bridge"
        yield _lacking(crossing, message, "let it run `domain_bridge/domain_bridge`", related=at)


def _is_bridge(part: Part, name: str) -> bool:
    return any(node.full_name == f"/{name}" and node.is_bridge for node in part.cell.nodes)


def _differences(crossing: Crossing, sent: Interface, heard: Interface) -> Iterator[Diagnostic]:
    source, receiver = crossing.source, crossing.receiver
    there = (Related(f"as `{source.key}` sends it", sent.span), Related(f"as `{receiver.key}` hears it", heard.span))
    if crossing.type != sent.type:
        message = f"`{crossing.name}` must be `{crossing.type}`, `{source.key}` sends `{sent.type}`"
        yield finding("crossing-differs", message, crossing.span, crossing.path, _AGREE, there)
    for name in _SAME:
        before, after = getattr(sent, name), getattr(heard, name)
        if before != after:
            message = f"{_words(name)} of `{crossing.name}` is {_said(before)} in `{source.key}`, "
            message += f"{_said(after)} in `{receiver.key}`"
            yield finding("crossing-differs", message, crossing.span, crossing.path, _AGREE, there)
    bridge = f"/{bridge_node(source, receiver, receiver)}"
    offered = next((end for end in sent.sources if end.node == crossing.source_node), None)
    bridged = next((end for end in heard.sources if end.full_name == bridge), None)
    if offered is not None and bridged is not None and offered.qos != bridged.qos:
        policies = ", ".join(_policies(offered, bridged))
        message = f"the bridge offers `{crossing.name}` as `{crossing.source_node}` does: {policies}"
        related = (Related("offered here", offered.span), Related("stated otherwise here", bridged.span))
        advice = f"state the profile of the publisher at the bridge in `{receiver.file}`"
        yield finding("crossing-differs", message, crossing.span, crossing.path, advice, related)
    if sent.frame is not None and sent.frame == heard.frame:
        yield from _frame(crossing, sent.frame)


_AGREE = "let the owners of both cells agree, and write the same in both specs"


def _words(name: str) -> str:
    return {"rate_hz": "rate", "time_source": "time source"}.get(name, name)


def _said(value: object) -> str:
    return "not stated" if value is None else f"`{value:g} Hz`" if isinstance(value, float) else f"`{value}`"


def _policies(offered: Endpoint, bridged: Endpoint) -> Iterator[str]:
    for name in ("reliability", "durability", "history", "depth", "deadline_s", "lifespan_s", "liveliness"):
        before, after = getattr(offered.qos, name), getattr(bridged.qos, name)
        if before != after:
            yield f"{name.removesuffix('_s')} {before}, not {after}"


def _frame(crossing: Crossing, frame: str) -> Iterator[Diagnostic]:
    """Yield that the frame of a payload is at another place in the two cells: its name is all that crosses."""
    source, receiver = crossing.source, crossing.receiver
    places = [part.at_rest(frame) for part in (source, receiver)]
    if places[0] is None or places[1] is None:
        moving = source if places[0] is None else receiver
        message = f"`{crossing.name}` is in frame `{frame}`, which is not at rest in `{moving.key}`"
        yield finding("crossing-frame-apart", message, crossing.span, crossing.path, _AT_REST)
        return
    way_m, turn_rad = apart(source.pose @ places[0], receiver.pose @ places[1])
    if way_m > _FRAME_M or turn_rad > _FRAME_RAD:
        message = f"frame `{frame}` of `{crossing.name}` is at two places in the plant: those of `{source.key}` and "
        message += f"`{receiver.key}` are {way_m * 1000:.1f} mm and {turn_rad:.4f} rad apart"
        related = tuple(
            Related(f"in `{part.key}`", entry.span)
            for part in (source, receiver)
            if (entry := part.graph.frames.get(frame)) is not None
        )
        advice = "correct the mount of a cell, or the frame in one of them"
        yield finding("crossing-frame-apart", message, crossing.span, crossing.path, advice, related)


_AT_REST = "send it in a frame that both cells have at one place, such as one of a fixture between them"


def _lacking(
    crossing: Crossing, message: str, advice: str, part: Part | None = None, related: tuple[Related, ...] = ()
) -> Diagnostic:
    there = (Related(f"cell `{part.key}`", part.cell.locate("interfaces")),) if part is not None else ()
    return finding("crossing-not-declared", message, crossing.span, crossing.path, advice, (*there, *related))
