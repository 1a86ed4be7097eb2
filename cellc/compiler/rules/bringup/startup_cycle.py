"""Parts of the cell wait for each other at start.

Each is ready only when the other is. Launched together they time out, and a delay that hides it works until the
machine is slow.

Example that is reported:

```yaml
nodes:
  left: {run: cell_tasks/left, host: control_pc, owner: integration}
  right: {run: cell_tasks/right, host: control_pc, owner: integration}
interfaces:
  /to_left: {service: std_srvs/srv/Trigger, server: left, client: right, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
  /to_right: {service: std_srvs/srv/Trigger, server: right, client: left, timeout: 1 s,  # expect at /to_right
              on_timeout: error,
              on_error: response.success is false}
```

Example that is accepted:

```yaml
nodes:
  left: {run: cell_tasks/left, host: control_pc, owner: integration}
  right: {run: cell_tasks/right, host: control_pc, owner: integration}
interfaces:
  /to_left: {service: std_srvs/srv/Trigger, server: left, client: right, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: turn one of the calls into a topic, or let a third node ask both.

Source: docs/principles.md#start-up
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("second-action-server",))
def check(graph: CellGraph) -> Findings:
    """Yield a circle of parts that wait for each other, with what each waits for."""
    cycle = graph.startup.cycle()
    if not cycle:
        return
    waits = list(zip(cycle, (*cycle[1:], cycle[0]), strict=True))
    needs = [next(n for n in graph.startup.needs if (n.part, n.needs) == pair) for pair in waits]
    names = " → ".join(f"`{name}`" for name in (*cycle, cycle[0]))
    places = [graph.cell.locate("interfaces", need.proof) for need in needs]
    related = tuple(Related(f"`{n.part}` waits for `{n.proof}`", p) for n, p in zip(needs, places, strict=True))
    path = ("interfaces", needs[0].proof)
    message = f"parts wait for each other at start: {names}"
    yield found(graph, path, message, related=related[1:])
