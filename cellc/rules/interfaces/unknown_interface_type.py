"""The type of an interface exists nowhere, but nearly.

A misspelt type is found by no type support, and the node fails when it starts. Types of packages that cellc does not
know are left alone: every cell may have its own.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStampd, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: use the nearest type that exists.

Source: catalogue of interface types, with its sources and date.
"""

from __future__ import annotations

from collections.abc import Iterator
from difflib import SequenceMatcher

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.graph.interface_types import interface_types
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found

_ALIKE = 0.85  # ratio of difflib: one or two letters in a name of ten


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield types that are not known and nearly are."""
    known = interface_types()
    for interface in graph.cell.interfaces:
        if interface.type not in known and interface.type.count("/") == 2:
            close = [name for name in known if _alike(name, interface.type)]
            if close:
                path = (*interface.path, interface.kind.value)
                yield found(
                    graph, path, f"there is no interface type `{interface.type}`", f"did you mean `{close[0]}`?"
                )


def _alike(known: str, written: str) -> bool:
    package, _, name = known.split("/")
    other_package, _, other_name = written.split("/")
    if package == other_package:
        return SequenceMatcher(None, name, other_name).ratio() >= _ALIKE
    return name == other_name and SequenceMatcher(None, package, other_package).ratio() >= _ALIKE


RULE = define("unknown-interface-type", Severity.ERROR, check, __doc__, assumes=("interface-kind-mismatch",))
