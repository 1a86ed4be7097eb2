"""A device is connected to a card that its host does not have.

Nobody can check the subnet or the traffic of a card that is not there.

Example that is reported:

```yaml
devices: {arm: {connection: {nic: robott}}}
```

Example that is accepted:

```yaml
devices: {arm: {connection: {nic: robot}}}
```

Fix: name a card of the host.

Source: chapter 4, section 5: preserve the NIC and route snapshot.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity, did_you_mean
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield connections that name a missing card of a host that exists."""
    for device in graph.network.devices:
        if device.nic is None or device.host not in graph.cell.spec.hosts:
            continue
        if graph.network.nic_of(device) is None:
            cards = graph.cell.spec.hosts[device.host].nics
            message = f"host `{device.host}` has no card `{device.nic}`"
            yield found(
                graph, (*device.path, "nic"), message, did_you_mean(device.nic, cards, f"cards of `{device.host}`")
            )


RULE = define("unknown-nic", Severity.ERROR, check, __doc__)
