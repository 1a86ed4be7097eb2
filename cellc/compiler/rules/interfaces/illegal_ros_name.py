"""An interface has a name that ROS does not allow.

The node that creates it ends with an exception, or the name is expanded to another one than the other side uses.

Example that is reported:

```yaml
interfaces:
  /camera-markers: {topic: geometry_msgs/msg/PoseStamped, from: perception,  # expect at /camera-markers
                    to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /camera_markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: begin with `/`, and use letters, digits and `_` between slashes; no part begins with a digit.

Source: https://design.ros2.org/articles/topic_and_service_names.html
(as of 2026-11-22): allowed characters and lengths
"""

from __future__ import annotations

import re

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_LONGEST = {InterfaceKind.TOPIC: 247, InterfaceKind.SERVICE: 240, InterfaceKind.ACTION: 221}


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield interfaces and recorded topics whose names are not full, hold other characters or are too long."""
    named = [(interface.path, interface.name, interface.kind) for interface in graph.cell.interfaces]
    recorded = enumerate(graph.cell.recording.topics)
    named += [(("recording", "topics", index), name, InterfaceKind.TOPIC) for index, name in recorded]
    for path, name, kind in named:
        if _NAME.fullmatch(name) is None:
            yield found(graph, path, f"`{name}` is not a legal ROS name", f"write `{_legal(name)}`, as the nodes do")
        elif len(name) > _LONGEST[kind]:
            message = f"`{name[:40]}…` must have at most {_LONGEST[kind]} characters, got {len(name)}"
            yield found(graph, path, message, "shorten the name")


def _legal(name: str) -> str:
    """Return the nearest legal full name: other characters as `_`, and `_` before a digit that begins a part."""
    parts = (re.sub(r"[^A-Za-z0-9]+", "_", part).strip("_") for part in name.split("/"))
    return "".join(f"/_{part}" if part[0].isdigit() else f"/{part}" for part in parts if part) or "/name"
