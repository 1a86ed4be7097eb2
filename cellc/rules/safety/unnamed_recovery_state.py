"""A state that stops the robot has no recovery.

Recovery from a state that nobody named is a restart and a hope.

Example that is reported:

```yaml
safety: {recovery: {states: [emergency_stop]}}
```

Example that is accepted:

```yaml
safety: {recovery: {states: [protective_stop, emergency_stop, fault]}}
```

Fix: name the states, and write down what is done in each.

Source: chapter 4, section 6: safety-relevant recovery needs named states, not unconditional restart.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found

_DUE = ("protective_stop", "emergency_stop", "fault")


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield the states that are missing, in one finding."""
    states = graph.cell.spec.safety.recovery.states
    missing = [state for state in _DUE if state not in states]
    if missing:
        names = ", ".join(f"`{state}`" for state in missing)
        yield found(graph, ("safety", "recovery", "states"), f"no recovery is named for {names}", f"add {names}")


RULE = define("unnamed-recovery-state", Severity.ERROR, check, __doc__)
