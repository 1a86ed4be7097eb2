"""Two controller managers have the same name.

Both would be `/controller_manager`: a spawner reaches one of them, by chance.

Example that is reported:

```yaml
managers:
  second:  # expect at second
    update_rate: 500 Hz
    controllers: {second_states: {type: joint_state_broadcaster}}
```

Example that is accepted:

```yaml
managers:
  second:
    update_rate: 500 Hz
    namespace: /second
    controllers: {second_states: {type: joint_state_broadcaster}}
```

Fix: give each manager a namespace of its own.

Source: https://control.ros.org/jazzy/doc/ros2_control/controller_manager/doc/userdoc.html
(Jazzy): the node is named controller_manager in its namespace
"""

from __future__ import annotations

from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield managers whose namespace is taken."""
    first: dict[str, ControllerManager] = {}
    for manager in graph.cell.managers:
        earlier = first.setdefault(manager.namespace, manager)
        if earlier is not manager:
            name = manager.namespace or "/"
            message = f"managers `{earlier.name}` and `{manager.name}` are both in namespace `{name}`"
            related = (Related("the first is here", earlier.span),)
            yield found(graph, manager.path, message, related=related)
