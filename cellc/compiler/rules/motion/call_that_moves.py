"""A rehearsal calls a service that moves a device by itself.

Such a call goes past every controller: its path is not planned, no claim keeps others away, and on the mock nothing
moves at all, so that the rehearsal passes what was never tried. A gripper that calibrates its fingers, or an arm that
goes home, is moved by a person, in a gate, with the area empty.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./programmed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             program: {played_by: pendant, mode: local}}
nodes:
  side: {run: programmed_arm_driver/side, host: control_pc, owner: integration}
interfaces:
  /side_arm/go_home: {service: std_srvs/srv/Trigger, server: side, client: task, timeout: 9 s, on_timeout: error,
                      on_error: response.success is false}
rehearsals:
  homed: {steps: [call: /side_arm/go_home]}  # expect at call
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
rehearsals:
  inspected: {steps: [call: /inspect, move: home]}
```

Fix: move by a `move` step, through the controller that owns the joints; leave the call to the gate that names it.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import Motion


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield calls of services that the catalog knows to move something."""
    moving = dict(_moving(graph.cell))
    for rehearsal in graph.cell.rehearsals:
        for step in rehearsal.steps:
            if step.kind == "call" and step.name in moving:
                message = f"`{step.name}` moves past every controller: {moving[step.name]}"
                yield found(graph, (*step.path, "call"), message)


def _moving(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield the names that drivers and controllers offer and that move something, with what a call does."""
    for device in cell.devices:
        for offer in device.offers:
            if offer.effect is not None and offer.effect.motion not in _HARMLESS:
                yield offer.name, offer.effect.does
    for controller in cell.controllers:
        for service in () if controller.declared is None else controller.declared.services:
            if service.effect is not None and service.effect.motion not in _HARMLESS:
                yield service.name.replace("~", controller.full_name), service.effect.does


_HARMLESS = (Motion.NONE, Motion.HOLDS)
