"""Rules on samples that wait, are lost, or are late."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.graph.data_flow import age_chains
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.vocabulary import InterfaceKind


@rule(Severity.WARNING)
def backlog_of_newest(graph: CellGraph) -> Findings:
    """Yield subscribers whose queue keeps what is old of a topic of which they want the newest sample."""
    for topic in graph.cell.interfaces:
        if topic.derived or topic.wants != "newest":
            continue
        for end in topic.sinks:
            endless = end.qos.history == "keep_all"
            queue = "every sample" if endless else f"{end.qos.depth} samples"
            message = f"`{end.node}` wants the newest of `{topic.name}` but queues {queue}"
            if end.qos.reliability == "reliable":
                if endless or end.qos.depth > 1:
                    yield found(graph, end.path, f"{message} reliably")
            elif endless and topic.rate_hz and topic.max_age_s is not None:
                yield found(graph, end.path, message)


@rule(Severity.ERROR)
def deadline_below_period(graph: CellGraph) -> Findings:
    """Yield endpoints with a deadline that a publisher on time cannot keep."""
    for topic in graph.cell.interfaces:
        if topic.kind is not InterfaceKind.TOPIC or not topic.rate_hz:
            continue
        for end in (*topic.sources, *topic.sinks):
            if end.qos.deadline_s is not None and end.qos.deadline_s < 1.0 / topic.rate_hz:
                deadline, period = end.qos.deadline_s * 1e3, 1e3 / topic.rate_hz
                message = (
                    f"`deadline` of `{end.node}` on `{topic.name}` must be at least its period of {period:.4g} ms, "
                    f"got {deadline:g} ms"
                )
                path = (*end.path, "deadline")
                related = enters(graph, "its period follows from it", (*topic.path, "rate"))
                yield found(graph, path, message, f"allow at least {period:.4g} ms", related)


@rule(Severity.ERROR)
def lifespan_below_max_age(graph: CellGraph) -> Findings:
    """Yield publishers whose samples expire before the age limit of the topic."""
    for topic in graph.cell.interfaces:
        for end in topic.sources:
            if topic.max_age_s is not None and end.qos.lifespan_s is not None and end.qos.lifespan_s < topic.max_age_s:
                message = (
                    f"`lifespan` of `{topic.name}` must be at least its `max_age` of {topic.max_age_s * 1e3:g} ms, "
                    f"got {end.qos.lifespan_s * 1e3:g} ms"
                )
                related = enters(graph, "the age is limited here", (*topic.path, "max_age"))
                yield found(graph, (*end.path, "lifespan"), message, related=related)


@rule(Severity.WARNING)
def lossy_every_sample(graph: CellGraph) -> Findings:
    """Yield best-effort endpoints on a topic of which every sample counts."""
    for topic in graph.cell.interfaces:
        if topic.derived or topic.wants != "every_sample":
            continue
        lossy = next((end for end in (*topic.sinks, *topic.sources) if end.qos.reliability == "best_effort"), None)
        if lossy is not None:
            message = f"every sample of `{topic.name}` counts, but `{lossy.node}` uses best effort"
            related = (Related("every sample counts", graph.cell.locate(*topic.path, "wants")),)
            yield found(graph, lossy.path, message, related=related)


_ROUNDING = 1.0 + 1e-9


@rule(Severity.WARNING, assumes=("max-age-too-short", "age-budget-exceeded"))
def queue_older_than_max_age(graph: CellGraph) -> Findings:
    """Yield subscribers whose full queue is older than their topic, or one that its stamp reaches, may be."""
    passed_on = _passed_on(graph)
    for topic in graph.cell.interfaces:
        if topic.derived or not topic.rate_hz:
            continue
        for end in topic.sinks:
            passed = [pair for pair in passed_on.get(topic.name, ()) if _publishes(end, pair[0])]
            bounds = (topic, *(last for _, last in passed))
            stated = [(other.max_age_s, other) for other in bounds if other.max_age_s is not None]
            if not stated or end.qos.history == "keep_all" or _is_a_backlog(topic, end):
                continue
            if topic.wants == "every_sample" and not any(
                (passing.rate_hz or 0.0) < topic.rate_hz for passing, _ in passed
            ):
                continue
            oldest_s = end.qos.depth / topic.rate_hz
            max_age_s, bound = min(stated, key=lambda passing: passing[0])
            if oldest_s > max_age_s * _ROUNDING:
                message = (
                    f"`{end.node}` queues {end.qos.depth} samples of `{topic.name}` at {topic.rate_hz:g} Hz: "
                    f"a full queue must hold at most {max_age_s * 1e3:.4g} ms, the `max_age` of `{bound.name}`, "
                    f"got {oldest_s * 1e3:.4g} ms"
                )
                most = int(max_age_s * topic.rate_hz * _ROUNDING)  # one at least: no age is below a period
                advice = f"use `depth: {most}`{' or less' if most > 1 else ''}, or allow a greater age"
                related = enters(graph, "so fast", (*topic.path, "rate"))
                place = graph.cell.locate(*bound.path, "max_age")
                yield found(graph, end.path, message, advice, (Related("allowed here", place), *related))


def _is_a_backlog(topic: Interface, end: Endpoint) -> bool:
    """Tell whether `backlog-of-newest` tells of the queue already."""
    return topic.wants == "newest" and end.qos.reliability == "reliable"


def _passed_on(graph: CellGraph) -> Mapping[str, list[tuple[Interface, Interface]]]:
    """Return, for each topic, those that its stamp reaches, each behind the one to which a reader passes it on."""
    topics = {topic.name: topic for topic in graph.cell.interfaces}
    reached: dict[str, list[tuple[Interface, Interface]]] = {}
    for name, shares in age_chains(graph.cell).items():
        for share, through in pairwise(share for share in shares if share.response_s is None):
            reached.setdefault(share.topic, []).append((topics[through.topic], topics[name]))
    return reached


def _publishes(end: Endpoint, topic: Interface) -> bool:
    return any(source.node == end.node for source in topic.sources)


@rule(Severity.WARNING)
def shallow_queue_for_every_sample(graph: CellGraph) -> Findings:
    """Yield subscribers of depth one on a topic of which every sample counts."""
    for topic in graph.cell.interfaces:
        if topic.derived or topic.wants != "every_sample":
            continue
        for end in topic.sinks:
            if end.qos.history == "keep_last" and end.qos.depth == 1:
                message = f"every sample of `{topic.name}` counts, but `{end.node}` keeps only one"
                related = (Related("every sample counts", graph.cell.locate(*topic.path, "wants")),)
                yield found(graph, end.path, message, related=related)
