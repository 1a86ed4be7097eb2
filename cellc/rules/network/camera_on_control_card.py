"""A camera is connected to the card of the robot.

Its stream fills the queue of the card, whatever `carries` says.

Example that is reported:

```yaml
devices: {camera: {connection: {nic: robot}}}
```

Example that is accepted:

```yaml
devices: {camera: {connection: {nic: bulk}}}
```

Fix: connect it to another card.

Source: chapter 4, section 5: do not mix camera streams onto the robot-control NIC.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield cameras on a card that carries control."""
    cameras = {device.name for device in graph.cell.devices if device.facts.kind == "camera"}
    for device in graph.network.devices:
        nic = graph.network.nic_of(device)
        if nic is not None and "control" in nic.carries and device.device in cameras:
            message = f"camera `{device.device}` is on `{nic.full_name}`, which carries control"
            yield found(graph, (*device.path, "nic"), message, "connect it to another card")


RULE = define("camera-on-control-card", Severity.ERROR, check, __doc__)
