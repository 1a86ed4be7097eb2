"""Two nodes of a cell have the same full name.

Parameters, actions and lifecycle services of the two mix: a request reaches one of them, by chance. The middleware
allows it and prints one warning.

Example that is reported:

```yaml
nodes:
  arm_trajectory: {run: cell_tasks/tracker, host: control_pc, owner: integration}
# expect at control.controllers.arm_trajectory
```

Example that is accepted:

```yaml
nodes:
  tracker: {run: cell_tasks/tracker, host: control_pc, owner: integration, lifecycle: true}
```

Fix: rename one of the two, or give it a namespace.

Source: https://github.com/ros2/design/issues/187 (as of 2026-11-22): features of ROS assume unique node names
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule


@rule(Severity.ERROR, assumes=("shared-manager-name",))
def check(graph: CellGraph) -> Findings:
    """Yield nodes and controllers whose full name is taken."""
    named = [(node.full_name, node.path) for node in graph.cell.nodes]
    named += [(c.full_name, c.path) for c in graph.cell.controllers]
    first: dict[str, YamlPath] = {}
    for name, path in named:
        earlier = first.setdefault(name, path)
        if earlier != path:
            message = f"two nodes are named `{name}`"
            related = (Related("the first is here", graph.cell.locate(*earlier)),)
            yield found(graph, path, message, related=related)
