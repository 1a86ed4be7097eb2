"""The first motion is not stated.

At gate G6 one joint moves, and everybody knows which, to which side, how far, how fast, for how long, and what ends
it.

Example that is reported:

```yaml
bringup: {first_motion: null}  # expect at bringup
```

Example that is accepted:

```yaml
bringup:
  first_motion: {joint: arm/joint_6, direction: +, max_delta: 5 deg, velocity: 5 deg/s, timeout: 5 s,
                 stop_if: [wrong direction, overshoot]}
```

Fix: write `bringup.first_motion` with joint, direction, delta, velocity, timeout and stop reasons.

Source: docs/principles.md#the-first-motion
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield a cell that moves joints and does not state its first motion."""
    moves = any(controller.command_interfaces for controller in graph.cell.controllers)
    if moves and graph.cell.bringup.first_motion is None:
        message = "the single-joint move of gate G6 is not stated"
        yield found(graph, ("bringup", "first_motion"), message)
