"""Rules on transforms that change: their rate, their buffer, and the time at which they are asked for."""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Interface
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("short-transform-buffer",))
def budget_beyond_buffer(graph: CellGraph) -> Findings:
    """Yield dynamic frames of goals whose buffer is below age limit plus plan-to-execute target."""
    target = graph.cell.kpis.plan_to_execute_s
    goals = {goal.frame for goal in graph.cell.goals}
    for frame in graph.cell.frames:
        if frame.kind is not FrameKind.DYNAMIC or frame.buffer_s is None or frame.name not in goals or target is None:
            continue
        oldest = _oldest(graph, frame.authority)
        if oldest is None or oldest.max_age_s is None or oldest.max_age_s + target <= frame.buffer_s:
            continue
        needed = oldest.max_age_s + target
        message = (
            f"`buffer` of `{frame.name}` must be at least {needed:g} s "
            f"(`{oldest.name}` {oldest.max_age_s:g} s + plan to execute {target:g} s), got {frame.buffer_s:g} s"
        )
        related = (
            Related("the age is allowed here", graph.cell.locate(*oldest.path, "max_age")),
            Related("the time to execution here", graph.cell.locate("kpis", "plan_to_execute")),
        )
        yield found(graph, (*frame.path, "buffer"), message, f"keep it for at least {needed:g} s", related)


def _oldest(graph: CellGraph, node: str) -> Interface | None:
    """Return the topic of a node whose samples may be oldest."""
    sent = [i for i in graph.cell.interfaces if i.max_age_s and any(source.node == node for source in i.sources)]
    return max(sent, key=lambda interface: interface.max_age_s or 0.0, default=None)


@rule(Severity.ERROR)
def dynamic_frame_without_rate(graph: CellGraph) -> Findings:
    """Yield dynamic frames without a rate."""
    for frame in graph.cell.frames:
        if frame.kind is FrameKind.DYNAMIC and frame.rate_hz is None:
            message = f"dynamic frame `{frame.name}` has no rate"
            yield found(graph, frame.path, message)


@rule(Severity.ERROR)
def latest_transform(graph: CellGraph) -> Findings:
    """Yield goals that would be transformed at another time than their observation."""
    for goal in graph.cell.goals:
        if goal.transform_at == "latest":
            message = f"goal `{goal.name}` asks for the latest transform of `{goal.frame}`"
            yield found(graph, (*goal.path, "transform_at"), message)


@rule(Severity.ERROR)
def pose_of_dynamic_frame(graph: CellGraph) -> Findings:
    """Yield dynamic frames with a transform or a calibration of their own."""
    for frame in graph.cell.frames:
        field = next((key for key in ("xyz", "rpy", "calibration") if graph.cell.states(*frame.path, key)), None)
        if frame.kind is FrameKind.DYNAMIC and field is not None:
            message = f"frame `{frame.name}` is dynamic but states `{field}`"
            yield found(graph, (*frame.path, field), message)


@rule(Severity.ERROR)
def short_transform_buffer(graph: CellGraph) -> Findings:
    """Yield dynamic frames whose buffer ends before the oldest sample that their publisher's users may use."""
    for frame in graph.cell.frames:
        if frame.kind is not FrameKind.DYNAMIC or frame.buffer_s is None:
            continue
        for interface in graph.cell.interfaces:
            sent = any(source.node == frame.authority for source in interface.sources)
            if sent and interface.max_age_s is not None and interface.max_age_s > frame.buffer_s:
                message = (
                    f"`buffer` of `{frame.name}` must be at least {interface.max_age_s:g} s, "
                    f"the `max_age` of `{interface.name}`, got {frame.buffer_s:g} s"
                )
                related = (Related("the age is allowed here", graph.cell.locate(*interface.path, "max_age")),)
                yield found(graph, (*frame.path, "buffer"), message, related=related)
                break
