"""The type of an interface does not fit its kind.

A message cannot be called and a service cannot be streamed: the nodes do not compile, or never meet. A stream
declared as a service or an action is the usual reason.

Example that is reported:

```yaml
interfaces:
  /inspect: {service: sensor_msgs/msg/Image, server: perception, client: task, timeout: 1 s,  # expect at service
             on_timeout: error,
             on_error: response.success is false}
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: use `msg` types for topics, `srv` types for services, `action` types for actions.

Source:

- docs/principles.md#interaction-types
- https://docs.ros.org/en/jazzy/Concepts/Basic/About-Interfaces.html (Jazzy)
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_FOLDER = {InterfaceKind.TOPIC: "msg", InterfaceKind.SERVICE: "srv", InterfaceKind.ACTION: "action"}


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield interfaces whose type is in the folder of another kind."""
    for interface in graph.cell.interfaces:
        parts = interface.type.split("/")
        expected = _FOLDER[interface.kind]
        if len(parts) == 3 and parts[1] in _FOLDER.values() and parts[1] != expected:
            message = f"`{interface.name}` is a {interface.kind.value}, but `{interface.type}` is a `{parts[1]}` type"
            path = (*interface.path, interface.kind.value)
            yield found(graph, path, message, f"use a `{expected}` type, or declare it as what it is")
