"""The type of an interface is not written as package/kind/Name.

The two-part spelling of ROS 1 and a lower-case name are found by no type support; the node fails when it starts.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/PoseStamped, from: perception, to: {task: {depth: 1}},  # expect at topic
             frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: write three parts, such as `sensor_msgs/msg/Image`.

Source: https://docs.ros.org/en/jazzy/Concepts/Basic/About-Interfaces.html
(Jazzy): names of messages, services and actions
"""

from __future__ import annotations

import re

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_TYPE = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Z][A-Za-z0-9]*")
_FOLDER = {InterfaceKind.TOPIC: "msg", InterfaceKind.SERVICE: "srv", InterfaceKind.ACTION: "action"}


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield types of another shape."""
    for interface in graph.cell.interfaces:
        if _TYPE.fullmatch(interface.type) is None:
            message = f"`{interface.type}` is not an interface type"
            parts = interface.type.split("/")
            nearest = (
                f"{parts[0]}/{_FOLDER[interface.kind]}/{parts[-1]}" if len(parts) == 2 else "sensor_msgs/msg/Image"
            )
            yield found(
                graph, (*interface.path, interface.kind.value), message, f"write three parts, such as `{nearest}`"
            )
