"""A node of the cell starts the program on the robot's own controller.

The program is what lets set points reach the drives. A person starts it, who has seen that no person is in reach; a
node that starts it restarts the robot after each stop, even with a person in the cell.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             program: {played_by: task, mode: local}}  # expect at played_by
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             program: {played_by: operator, mode: local}}
```

Fix: name the role of the person who starts it.

Source: docs/principles.md#recovery
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield programs that are started by what is no person, and not the driver that owns them."""
    cell = graph.cell
    software = (
        {node.name for node in cell.nodes} | {controller.name for controller in cell.controllers} | set(cell.hosts)
    )
    for device in cell.devices:
        if device.program is not None and device.program.played_by in software:
            played_by = device.program.played_by
            message = f"the program of `{device.name}` must be started by a person, got `{played_by}` of this cell"
            yield found(graph, (*device.path, "program", "played_by"), message)
