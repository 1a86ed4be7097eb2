"""The first motion takes longer than its timeout.

The stop reason would always be the timeout, so a real failure looks like every other run.

Example that is reported:

```yaml
bringup:
  first_motion:
    joint: arm/joint_6
    direction: +
    max_delta: 10 deg
    velocity: 1 deg/s
    timeout: 5 s  # expect at timeout
    stop_if: [wrong direction]
```

Example that is accepted:

```yaml
bringup:
  first_motion:
    joint: arm/joint_6
    direction: +
    max_delta: 5 deg
    velocity: 5 deg/s
    timeout: 5 s
    stop_if: [wrong direction]
```

Fix: raise the timeout, or shorten the move.

Source: docs/principles.md#the-first-motion
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a first motion whose delta needs more time at its velocity than allowed."""
    motion = graph.cell.bringup.first_motion
    if motion is None:
        return
    needed = motion.max_delta.value / motion.velocity.value
    if needed > motion.timeout_s:
        max_delta, velocity, timeout = (
            graph.cell.text("bringup", "first_motion", key) for key in ("max_delta", "velocity", "timeout")
        )
        message = f"{max_delta} at {velocity} takes {needed:.3g} s, but the timeout is {timeout}"
        yield found(graph, ("bringup", "first_motion", "timeout"), message, f"allow at least {needed:.3g} s")
