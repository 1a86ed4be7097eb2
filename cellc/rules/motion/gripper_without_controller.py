"""A rehearsal grips with a gripper that nothing drives.

The step sends a goal to an action that no controller serves.

Example that is reported:

```yaml
control:
  controllers: {gripper_action: null}
```

Example that is accepted:

```yaml
control:
  controllers: {gripper_action: {type: parallel_gripper, device: gripper, client: task}}
```

Fix: add a gripper controller.

Source: chapter 4, section 10: a missing action server prevents execution.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield the first grip step of each gripper without a controller with an action."""
    driven = {controller.device for controller in graph.cell.controllers if controller.action}
    reported: set[str] = set()
    for step in (step for rehearsal in graph.cell.rehearsals for step in rehearsal.steps):
        if step.kind == "grip" and step.name not in driven and step.name not in reported:
            reported.add(step.name)
            message = f"no controller drives gripper `{step.name}`"
            yield found(graph, step.path, message, "add a controller of type `parallel_gripper` for it")


RULE = define("gripper-without-controller", Severity.ERROR, check, __doc__, assumes=("wrong-joint-count",))
