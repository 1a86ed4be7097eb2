"""How long a sample waits for the other callbacks of its node, as far as the spec states executor and callbacks.

What executes one after the other is busy without a pause for a time that follows from times and rates; whatever the
order, a sample is done within it. Where a rate is missing, as of a service, a single-threaded executor has another
bound: it takes what is ready as a set and executes each callback of it once, then looks again (Casini et al.,
Response-Time Analysis of ROS 2 Processing Chains under Reservation-Based Scheduling, ECRTS 2019, section 3.2). A sample
that has just missed a set waits for all of it, and for all before it in its own: twice the sum, and once more for each
sample that may be in its queue before it. Several threads take the callbacks of a group in no fair order.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from math import ceil

from cellc.compiler.cell.cell import Cell, InterfaceEnd
from cellc.compiler.cell.interface import Callback, Node
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import InterfaceKind

_ROUNDS = 100
"""A group that is busy for longer is as good as always busy."""


@dataclass(frozen=True, slots=True)
class Response:
    """Time from the arrival of a sample at a node to the end of its callback, s at most; None with why not."""

    bound_s: float | None
    why: str = ""


def stating(cell: Cell) -> Iterator[Node]:
    """Yield the nodes of which the spec states an executor or callbacks."""
    return (node for node in cell.nodes if node.executor is not None or node.callbacks or node.threads is not None)


def handled(cell: Cell, node: Node) -> Mapping[str, InterfaceEnd]:
    """Return the ends of a node at which it executes something by name: topics that it hears, and calls it serves."""
    ends = (end for end in cell.ends_of.get(node.full_name, ()) if not end.interface.derived)
    return {end.interface.name: end for end in ends if end.serves != (end.interface.kind is InterfaceKind.TOPIC)}


def response(cell: Cell, node: Node, topic: str) -> Response:
    """Return how long a sample of a topic takes in a node that hears it."""
    if node.executor is None:
        return Response(None, "`executor` is not stated")
    if node.executor == "events":
        return Response(None, "an events executor takes events as they come, any number of one callback")
    untimed = [name for name in handled(cell, node) if name not in node.callbacks]
    untimed += [
        name for name, callback in node.callbacks.items() if callback.takes_s is None and _executes(cell, node, name)
    ]
    callback = node.callbacks.get(topic)
    if node.is_one_thread and not untimed:
        return _in_rounds(cell, node, topic)
    if untimed and (node.is_one_thread or callback is None or topic in untimed):
        return Response(None, f"`takes` of `{untimed[0]}` is not stated")
    return _in_group(cell, node, topic, untimed)


def _executes(cell: Cell, node: Node, name: str) -> bool:
    """Tell whether a row is for more than the group of a client."""
    return name in handled(cell, node) or node.callbacks[name].period_s is not None


def _in_rounds(cell: Cell, node: Node, topic: str) -> Response:
    if all(period_s(cell, node, name) for name in node.callbacks):
        return _busy(cell, node, node.callbacks)
    total_s = sum(callback.takes_s or 0.0 for callback in node.callbacks.values())
    end = handled(cell, node)[topic]
    rate_hz, qos = end.interface.rate_hz, end.end.qos
    if rate_hz and total_s * rate_hz <= 1.0:
        return Response(2 * total_s)
    if qos.history == "keep_all":
        return Response(None, "its queue keeps all, and is filled faster than it is read")
    return Response((1 + max(1, qos.depth)) * total_s)


def _in_group(cell: Cell, node: Node, topic: str, untimed: Collection[str]) -> Response:
    default = node.line_of(Callback(takes_s=None))
    groups = {node.line_of(callback) or name for name, callback in node.callbacks.items()}
    groups |= {default} if untimed else set()
    if node.threads is None or node.threads < len(groups):
        return Response(None, f"a thread for each of {len(groups)} callback groups is not stated")
    line = node.line_of(node.callbacks[topic])
    if untimed and line == default:
        return Response(None, f"`takes` of `{next(iter(untimed))}` is not stated")
    return _busy(
        cell, node, [name for name, row in node.callbacks.items() if name == topic or line == node.line_of(row) != ""]
    )


def _busy(cell: Cell, node: Node, names: Collection[str]) -> Response:
    """Return the longest time without a pause of callbacks of a node that execute one after the other."""
    work = [(node.callbacks[name].takes_s or 0.0, period_s(cell, node, name)) for name in names]
    if any(period is None for _, period in work):
        return Response(None, "a callback of its group has no rate")
    busy_s = sum(takes_s for takes_s, _ in work)
    for _ in range(_ROUNDS):
        longer_s = sum(takes_s * ceil(round(busy_s / (period or busy_s), 9)) for takes_s, period in work)
        if longer_s <= busy_s:
            return Response(busy_s)
        busy_s = longer_s
    return Response(None, "its group has more to execute than time")


def period_s(cell: Cell, node: Node, name: str) -> float | None:
    """Return the period of a callback: its own, or that of the topic; None where neither is stated."""
    callback, end = node.callbacks[name], handled(cell, node).get(name)
    rate_hz = None if end is None else end.interface.rate_hz
    return callback.period_s or (1.0 / rate_hz if rate_hz else None)
