"""A part is brought to a goal and never let go.

The gripper closes, the arm goes to another goal and away from it, and nothing opens the gripper: the arm takes the part
along, into anything on its way, and the next cycle closes on a part that it holds already.

Example that is reported:

```yaml
rehearsals:
  pick_and_place:
    steps: [move: home, detect: object, move: pick, grip: close, move: place, move: home]  # expect at 3.grip
```

Example that is accepted:

```yaml
rehearsals:
  pick_and_place:
    steps: [move: home, detect: object, move: pick, grip: close, move: place, grip: open, move: home]
```

Fix: open the gripper at the goal, before the arm leaves.

Source: docs/principles.md#rehearsals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield steps that close a gripper which opens no more, although the arm visits another goal and leaves it."""
    goals = {goal.name for goal in graph.cell.goals}
    reported = set()
    for rehearsal in graph.cell.rehearsals:
        for number, step in enumerate(rehearsal.steps):
            if step.kind != "grip" or step.command != "close" or step.path in reported:
                continue
            before = [step.name for step in rehearsal.steps[:number] if step.kind == "move"][-1:]
            after = rehearsal.steps[number + 1 :]
            opened = any(item.kind == "grip" and item.name == step.name for item in after)
            moves = [step for step in after if step.kind == "move"]
            left = next((move for move in moves[:-1] if move.name in goals and [move.name] != before), None)
            if not opened and left is not None:
                reported.add(step.path)
                message = f"`{step.name}` must open at `{left.name}` or after it, and stays closed to the end"
                yield found(graph, step.path, message, related=(Related("the arm leaves this goal", left.span),))
