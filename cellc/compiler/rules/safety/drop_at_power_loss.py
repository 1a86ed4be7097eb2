"""A held part falls, or may fall, when air or power is lost, and no person has accepted it.

A valve with a spring opens the gripper as its output goes off: in an emergency stop the part flies. Whether that is
borne is an answer of the risk assessment, not of a program. UNKNOWN is judged as a drop.

Example that is reported:

```yaml
# a cell of wired outputs
devices:
  clamp: {model: ./demo_clamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
          switching: {outputs: {valve: io/io/out_0}, power_lost: drops}}  # expect at power_lost
```

Example that is accepted:

```yaml
# a cell of wired outputs
devices:
  clamp: {model: ./demo_clamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
          switching: {outputs: {valve: io/io/out_0}, power_lost: drops, accepted_by: safety}}
```

Fix: take a valve that keeps its state and state `power_lost: holds`, or have the drop accepted and state
`accepted_by:`.

Source: docs/principles.md#digital-signals
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices that hold something, may lose it without power, and name no person who accepts that."""
    for device in graph.cell.devices:
        one = device.switched
        if one is None or one.holds is None or one.power_lost == "holds" or one.accepted_by not in (None, UNKNOWN):
            continue
        unknown = f"it is not stated whether `{device.name}` holds its load when power is lost"
        message = unknown if one.power_lost == UNKNOWN else f"`{device.name}` drops its load when power is lost"
        yield found(graph, (*device.path, "switching", "power_lost"), message)
