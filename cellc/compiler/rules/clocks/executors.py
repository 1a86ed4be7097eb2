"""Rules on executors and callback groups of nodes."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.interface import Callback, Node
from cellc.compiler.graph.executors import handled, period_s, stating
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, did_you_mean, found, rule

_ROUNDING = 1e-9


@rule(Severity.ERROR, assumes=("unknown-callback",))
def callback_waits_for_itself(graph: CellGraph) -> Findings:
    """Yield callbacks that wait for an answer which their own thread or group would have to take."""
    for node in stating(graph.cell):
        served = handled(graph.cell, node)
        for name, callback in node.callbacks.items():
            for index, call in enumerate(callback.waits_for):
                answer = node.callbacks.get(call, Callback(takes_s=None))
                line = node.line_of(callback)
                if line and line == node.line_of(answer):
                    by = "the one thread of its executor" if node.is_one_thread else "its mutually exclusive group"
                    taken = "executes the call" if call in served else "takes the answer"
                    message = f"`{name}` of `{node.name}` waits for `{call}` and blocks {by}, which {taken}"
                    row = graph.cell.locate(*node.path, "callbacks", call)
                    related = (Related("its group is here", row),) if call in node.callbacks else ()
                    yield found(graph, (*node.path, "callbacks", name, "waits_for", index), message, related=related)


@rule(Severity.ERROR)
def callback_group_of_two_types(graph: CellGraph) -> Findings:
    """Yield callbacks whose group another one says is of the other type."""
    for node in stating(graph.cell):
        first: dict[str, str] = {}
        for name, callback in node.callbacks.items():
            other = first.setdefault(callback.group, name)
            if node.callbacks[other].reentrant != callback.reentrant:
                group = f"group `{callback.group}`" if callback.group else "the default group"
                message = f"{group} of `{node.name}` must be reentrant or mutually exclusive, got both"
                row = graph.cell.locate(*node.path, "callbacks", other)
                related = (Related("the other type is here", row),)
                yield found(graph, (*node.path, "callbacks", name), message, related=related)


@rule(Severity.ERROR, assumes=("unknown-callback",))
def callbacks_exceed_thread(graph: CellGraph) -> Findings:
    """Yield nodes whose callbacks need more time than the thread has that executes them."""
    for node in stating(graph.cell):
        lines: dict[str, list[str]] = {}
        for name, callback in node.callbacks.items():
            if line := node.line_of(callback):
                lines.setdefault(line, []).append(name)
        for names in lines.values():
            share = sum(_load(graph, node, name) for name in names)
            if share > 1.0 + _ROUNDING:
                by = "one thread" if node.is_one_thread else "one mutually exclusive group"
                message = f"callbacks of `{node.name}` in {by} must need at most 1 s each second, got {share:.3g} s"
                related = tuple(_enters(graph, node, names))
                yield found(graph, (*node.path, "callbacks"), message, related=related)


def _load(graph: CellGraph, node: Node, name: str) -> float:
    period = period_s(graph.cell, node, name)
    return (node.callbacks[name].takes_s or 0.0) / period if period else 0.0


def _enters(graph: CellGraph, node: Node, names: list[str]) -> Iterator[Related]:
    ends = handled(graph.cell, node)
    for name in names:
        yield Related("it takes this", graph.cell.locate(*node.path, "callbacks", name, "takes"))
        if name in ends and node.callbacks[name].period_s is None:
            yield Related("as often as this", graph.cell.locate(*ends[name].interface.path, "rate"))


@rule(Severity.ERROR)
def unknown_callback(graph: CellGraph) -> Findings:
    """Yield callbacks of what a node neither hears, serves nor calls, and calls that it does not make."""
    for node in stating(graph.cell):
        ends = tuple(end for end in graph.cell.ends_of.get(node.full_name, ()) if not end.interface.derived)
        known = [end.interface.name for end in ends]
        calls = {end.interface.name for end in graph.cell.ends_of.get(node.full_name, ()) if not end.serves}
        for name, callback in node.callbacks.items():
            path = (*node.path, "callbacks", name)
            if name not in known and callback.period_s is None:
                message = f"`{node.name}` neither hears, serves nor calls `{name}`, and as a timer it has no `period`"
                yield found(graph, path, message, did_you_mean(name, known, f"interfaces of `{node.name}`"))
            for index, call in enumerate(callback.waits_for):
                if call not in calls:
                    message = f"`{node.name}` waits for `{call}` and is not a client of it"
                    yield found(
                        graph,
                        (*path, "waits_for", index),
                        message,
                        did_you_mean(call, calls, f"calls of `{node.name}`"),
                    )


@rule(Severity.WARNING)
def threads_without_effect(graph: CellGraph) -> Findings:
    """Yield numbers of threads of an executor that has one."""
    for node in stating(graph.cell):
        if node.threads is not None and node.executor != "multi_threaded":
            executor = "an executor that is not stated" if node.executor is None else f"`{node.executor}`"
            message = f"`threads` of `{node.name}` must be of a `multi_threaded` executor, got {executor}"
            yield found(graph, (*node.path, "threads"), message)
