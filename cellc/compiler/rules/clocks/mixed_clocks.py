"""A node runs on another clock than its target.

If one node takes `/clock` and another wall time, transforms extrapolate, timeouts fire early or never, and a replay
shows something else than happened.

Example that is reported:

```yaml
nodes:
  perception: {clock: sim}  # expect at clock
```

Example that is accepted:

```yaml
nodes:
  perception: {clock: wall}
```

Fix: remove `clock:` and `use_sim_time` from the node, so that it follows its target, or set the clock of the target.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.cell.interface import Node
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule

_PARAMETER = "use_sim_time"


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield nodes and controllers whose clock is not that of a target that starts them, by whichever road it is set."""
    for node in graph.cell.nodes:
        clock, path = _stated(node)
        yield from _other(graph, f"node `{node.name}`", clock, path)
    for controller in graph.cell.controllers:
        if isinstance(simulated := controller.written_parameters.get(_PARAMETER), bool):
            path = (*controller.path, "parameters", _PARAMETER)
            yield from _other(graph, f"controller `{controller.name}`", "sim" if simulated else "wall", path)


def _stated(node: Node) -> tuple[str | None, YamlPath]:
    """Return the clock that a node gets, by its own key or by the parameter that ROS has for it."""
    simulated = node.parameters.get(_PARAMETER)
    if node.clock is None and isinstance(simulated, bool):
        return "sim" if simulated else "wall", (*node.path, "parameters", _PARAMETER)
    return node.clock, (*node.path, "clock")


def _other(graph: CellGraph, who: str, clock: str | None, path: YamlPath) -> Findings:
    targets = {name: target.clock for name, target in graph.cell.targets.items()}
    other = next((name for name, own in targets.items() if clock not in (None, own)), None)
    if other is not None:
        yield found(graph, path, f"{who} runs on {clock} time, but target `{other}` on {targets[other]} time")
