"""A full queue holds samples that are too old to be used.

A reader that is slower than its topic, or starts late, works on a full queue: each sample that it takes has waited for
depth ÷ rate. Where that is above `max_age`, it rejects every one, fresh data arrives all the while, and the cell stops
with `stale_state`. A detector passes the stamp of its image on, so that the age limit of its poses counts too. ROS 2
warns of nothing: the profiles match, and no sample is lost. Where every sample counts, a deep queue is for bursts. It
is reported only if what the reader makes of it has a lower rate, so that the queue stays full.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1}}
    to: {task: {reliability: best_effort, depth: 10}}  # expect at task
    frame: world
    wants: newest
    rate: 30 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Example that is accepted:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1}}
    to: {task: {reliability: best_effort, depth: 5}}
    frame: world
    wants: newest
    rate: 30 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: lower `depth` to at most `max_age` × rate, or allow a greater age.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.graph.data_flow import age_chains
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_ROUNDING = 1.0 + 1e-9


@rule(Severity.WARNING, assumes=("max-age-too-short", "age-budget-exceeded"))
def check(graph: CellGraph) -> Findings:
    """Yield subscribers whose full queue is older than their topic, or one that its stamp reaches, may be."""
    passed_on = _passed_on(graph)
    for topic in graph.cell.interfaces:
        if topic.derived or not topic.rate_hz:
            continue
        for end in topic.sinks:
            passed = [pair for pair in passed_on.get(topic.name, ()) if _publishes(end, pair[0])]
            bounds = (topic, *(last for _, last in passed))
            stated = [(other.max_age_s, other) for other in bounds if other.max_age_s is not None]
            if not stated or end.qos.history == "keep_all" or end.qos.depth == 1 or _is_a_backlog(topic, end):
                continue
            if topic.wants == "every_sample" and not any((one.rate_hz or 0.0) < topic.rate_hz for one, _ in passed):
                continue
            oldest_s = end.qos.depth / topic.rate_hz
            max_age_s, bound = min(stated, key=lambda one: one[0])
            if oldest_s > max_age_s * _ROUNDING:
                message = (
                    f"`{end.node}` queues {end.qos.depth} samples of `{topic.name}` at {topic.rate_hz:g} Hz: "
                    f"a full queue must hold at most {max_age_s * 1e3:.4g} ms, the `max_age` of `{bound.name}`, "
                    f"got {oldest_s * 1e3:.4g} ms"
                )
                most = max(1, int(max_age_s * topic.rate_hz * _ROUNDING))
                advice = f"use `depth: {most}`{' or less' if most > 1 else ''}, or allow a greater age"
                place = graph.cell.locate(*bound.path, "max_age")
                yield found(graph, end.path, message, advice, (Related("allowed here", place),))


def _is_a_backlog(topic: Interface, end: Endpoint) -> bool:
    """Tell whether `backlog-of-newest` tells of the queue already."""
    return topic.wants == "newest" and end.qos.reliability == "reliable"


def _passed_on(graph: CellGraph) -> Mapping[str, list[tuple[Interface, Interface]]]:
    """Return, for each topic, those that its stamp reaches, each behind the one to which a reader passes it on."""
    topics = {topic.name: topic for topic in graph.cell.interfaces}
    reached: dict[str, list[tuple[Interface, Interface]]] = {}
    for name, shares in age_chains(graph.cell).items():
        for share, through in pairwise(shares):
            reached.setdefault(share.topic, []).append((topics[through.topic], topics[name]))
    return reached


def _publishes(end: Endpoint, topic: Interface) -> bool:
    return any(source.node == end.node for source in topic.sources)
