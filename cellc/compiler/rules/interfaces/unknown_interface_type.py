"""The type of an interface is misspelled.

A misspelled type is found by no type support, and the node fails when it starts. Types of packages that cellc does not
know are left alone: every cell may have its own.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStampd, from: perception, to: {task: {depth: 1}},  # expect at topic
             frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: use the nearest type that exists.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

import re
from difflib import SequenceMatcher

from cellc.compiler.graph.data_flow import interface_types
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_ALIKE = 0.8  # ratio of difflib: one letter in a word of four, two in a word of ten


@rule(Severity.ERROR, assumes=("interface-kind-mismatch", "malformed-interface-type"))
def check(graph: CellGraph) -> Findings:
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
    """Tell whether one word of the type differs by a typing error; `UInt32` and `Int16` are no misspellings of
    `Int32`."""
    words, others = (re.findall(r"[A-Z][a-z]*|[a-z]+|[0-9]+|[/_]", name) for name in (known, written))
    differing = [(word, other) for word, other in zip(words, others, strict=False) if word != other]
    if len(words) != len(others) or len(differing) != 1:
        return False
    word, other = differing[0]
    return word.isalpha() and SequenceMatcher(None, word, other).ratio() >= _ALIKE
