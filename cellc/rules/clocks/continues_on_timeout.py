"""Motion goes on although an answer is overdue.

A server that does not answer may have died in the middle of a motion, or a clock has jumped. The caller has to end in
a state that somebody can see.

Example that is reported:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: continue,
             on_error: response.success is false}
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: write `cancel_and_hold` or `error`.

Source: chapter 4, section 2: rather than an indefinitely blocked caller; section 3, acceptance gate 5.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield services and actions whose timeout changes nothing."""
    for interface in graph.cell.interfaces:
        if interface.on_timeout == "continue":
            message = f"the client of `{interface.name}` goes on although no answer came"
            yield found(graph, (*interface.path, "on_timeout"), message, "write `cancel_and_hold` or `error`")


RULE = define("continues-on-timeout", Severity.ERROR, check, __doc__)
