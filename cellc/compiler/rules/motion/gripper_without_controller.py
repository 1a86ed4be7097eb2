"""A rehearsal grips with a gripper that nothing drives.

The step sends a goal to an action that no controller serves.

Example that is reported:

```yaml
control:
  controllers: {gripper_action: null}
# expect at rehearsals.pick_and_place.steps.3.grip
```

Example that is accepted:

```yaml
control:
  controllers: {gripper_action: {type: parallel_gripper, device: gripper, client: task}}
```

Fix: add a controller of type `parallel_gripper` for it.

Source: docs/principles.md#planning-and-execution
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("wrong-joint-count",))
def check(graph: CellGraph) -> Findings:
    """Yield the first grip step of each gripper without a controller with an action."""
    driven = {controller.device for controller in graph.cell.controllers if controller.action}
    reported: set[str] = set()
    for step in (step for rehearsal in graph.cell.rehearsals for step in rehearsal.steps):
        if step.kind == "grip" and step.name not in driven and step.name not in reported:
            reported.add(step.name)
            message = f"no controller drives gripper `{step.name}`"
            yield found(graph, step.path, message)
