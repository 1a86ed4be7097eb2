"""Rules on the tree of frames: one root, one parent and one publisher for each."""

from __future__ import annotations

from cellc.compiler.cell.frame import WORLD, FrameKind
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.compiler.link.names import JOINT_STATES
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def frame_cycle(graph: CellGraph) -> Findings:
    """Yield each circle once, at the frame of it that is written first."""
    for cycle in graph.frames.cycles():
        first = next(name for name in graph.frames.names() if name in cycle)
        frame = graph.frames.authorities(first)[0]
        start = cycle.index(first)
        names = (*cycle[start:], *cycle[:start], first)
        message = "frames form a cycle: " + " → ".join(f"`{name}`" for name in names)
        yield found(graph, (*frame.path, "parent"), message)


@rule(Severity.ERROR)
def published_static_frame(graph: CellGraph) -> Findings:
    """Yield static frames with a publisher or a rate."""
    for frame in graph.cell.frames:
        field = next((key for key in ("published_by", "rate") if graph.cell.states(*frame.path, key)), None)
        if frame.kind is FrameKind.FIXED and field is not None:
            message = f"frame `{frame.name}` is static but states `{field}`"
            yield found(graph, (*frame.path, field), message, f"write `dynamic: true`, or remove `{field}`")


@rule(Severity.ERROR, assumes=("shared-prefix",))
def two_authorities(graph: CellGraph) -> Findings:
    """Yield every edge after the first for one child frame."""
    for name in graph.frames.names():
        first, *others = graph.frames.authorities(name)
        for frame in others:
            if frame.kind is FrameKind.LINK and frame.device == first.device:
                continue  # inside one description this is a link with two parents
            message = f"frame `{name}` is published by `{first.authority}` and again by `{frame.authority}`"
            related = (Related(f"`{name}` is attached to `{first.parent or WORLD}` here", first.span),)
            yield Finding(message, frame.span, frame.path, related=related)


@rule(Severity.ERROR)
def unheard_joint_states(graph: CellGraph) -> Findings:
    """Yield state topics of adapters that robot_state_publisher does not read."""
    topics = {interface.name: interface for interface in graph.cell.interfaces}
    for adapted in graph.cell.adapters:
        topic = topics[adapted.state_topic]
        readers = {sink.node for sink in topic.sinks}
        if topic.name != JOINT_STATES or ROBOT_STATE_PUBLISHER not in readers:
            message = f"robot_state_publisher must receive the joints of `{adapted.device}` on `{JOINT_STATES}`"
            yield found(graph, (*topic.path, "from"), f"{message}, got `{topic.name}`")


@rule(Severity.ERROR)
def unpublished_dynamic_frame(graph: CellGraph) -> Findings:
    """Yield dynamic frames without a publisher."""
    for frame in graph.cell.frames:
        if frame.kind is FrameKind.DYNAMIC and not graph.cell.states(*frame.path, "published_by"):
            message = f"dynamic frame `{frame.name}` has no publisher"
            yield found(graph, frame.path, message)
