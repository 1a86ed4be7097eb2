"""A robot stops in a way that the cell has no recovery for.

Its vendor tells how people get it back: a safeguard that was opened, a stop that a user pressed at the enabling device.
They are the stops of every day, and without a name in the cell their recovery has no owner.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
safety: {recovery: {states: [protective_stop, emergency_stop, fault]}}  # expect at states
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
safety: {recovery: {states: [protective_stop, user_stop, emergency_stop, fault]}}
```

Fix: name the state; `audit.md` prints its vendor's steps.

Source: docs/principles.md#recovery
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.BLOCKER, assumes=("unnamed-recovery-state",))
def check(graph: CellGraph) -> Findings:
    """Yield the stops of a device that its vendor leads out of and the cell does not name, one finding a device."""
    named = set(graph.cell.safety.recovery.states)
    for device in graph.cell.devices:
        missing = [state for state in device.safety.recoverable_stops if state not in named]
        if missing:
            names = ", ".join(f"`{state}`" for state in missing)
            message = f"`{device.name}` can stop in {names}, and no recovery is named for it"
            related = (Related("the device", device.span),)
            yield found(graph, ("safety", "recovery", "states"), message, f"add {names}", related)
            named |= set(missing)
