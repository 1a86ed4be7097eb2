"""The gripper closes before the arm is at the part.

A rehearsal in this order passes on the mock and grips nothing: the closed fingers then go down into the part.

Example that is reported:

```yaml
rehearsals:
  pick_and_place:
    steps: [move: home, detect: object, grip: close,  # expect at 2.grip
            move: pick, move: place, grip: open, move: home]
```

Example that is accepted:

```yaml
rehearsals:
  pick_and_place:
    steps: [move: home, detect: object, move: pick, grip: close, move: place, grip: open, move: home]
```

Fix: move to the goal first, then close.

Source: docs/principles.md#rehearsals
"""

from __future__ import annotations

from collections.abc import Sequence

from cellc.compiler.cell.motion import Step
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_GOALS_WITH_A_PART = 2
"""A part that was gripped at a named pose is brought to one goal; two goals are where it is and where it goes."""


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield steps that close a gripper away from a goal and are followed by two goals before it opens."""
    goals = {goal.name for goal in graph.cell.goals}
    reported = set()
    for rehearsal in graph.cell.rehearsals:
        for number, step in enumerate(rehearsal.steps):
            if step.kind != "grip" or step.command != "close" or step.path in reported:
                continue
            before = [step.name for step in rehearsal.steps[:number] if step.kind == "move"]
            ahead = _goals_until_open(rehearsal.steps[number + 1 :], goals)
            if (not before or before[-1] not in goals) and len(ahead) >= _GOALS_WITH_A_PART:
                reported.add(step.path)
                message = f"`{step.name}` must close at a goal, but it closes before the arm goes to `{ahead[0]}`"
                yield found(graph, step.path, message)


def _goals_until_open(steps: Sequence[Step], goals: set[str]) -> list[str]:
    """Return the different goals that are taken before the gripper opens again."""
    found_: dict[str, None] = {}
    for step in steps:
        if step.kind == "grip" and step.command == "open":
            break
        if step.kind == "move" and step.name in goals:
            found_[step.name] = None
    return list(found_)
