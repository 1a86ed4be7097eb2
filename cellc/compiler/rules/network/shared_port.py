"""Two drivers on one computer listen on one port.

The second finds the port taken and does not start; or a robot connects back to the driver of the other, and follows
its commands. Where a spec is silent each device gets ports of its own.

Example that is reported:

```yaml
devices:
  left: {model: ./demo_io, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: io 1.0.0,
         driver: demo_io_driver 1.0.0, connection: {host: control_pc, nic: bulk, address: 10.10.0.20, first_port: 5030}}
  right: {model: ./demo_io, mount: {parent: world, xyz: 0 3 0 m}, revision: A, firmware: io 1.0.0,
          driver: demo_io_driver 1.0.0,
          connection: {host: control_pc, nic: bulk, address: 10.10.0.21, first_port: 5030}}  # expect at first_port
```

Example that is accepted:

```yaml
devices:
  left: {model: ./demo_io, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: io 1.0.0,
         driver: demo_io_driver 1.0.0, connection: {host: control_pc, nic: bulk, address: 10.10.0.20, first_port: 5030}}
  right: {model: ./demo_io, mount: {parent: world, xyz: 0 3 0 m}, revision: A, firmware: io 1.0.0,
          driver: demo_io_driver 1.0.0, connection: {host: control_pc, nic: bulk, address: 10.10.0.21}}
```

Fix: state another `first_port`, or none; a port that is a plain number in `device.yaml` is written there as `{port_N}`.

Source: https://man7.org/linux/man-pages/man2/bind.2.html
(man-pages 6.9): EADDRINUSE, the address is already in use
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second device that listens on a port of a host, once."""
    first: dict[tuple[str, int], Device] = {}
    for device in graph.cell.devices:
        link = device.connection
        listens = () if device.network is None or link is None else device.network.listens
        taken = [(port, owner) for port in listens if (owner := first.get((device.host, port))) is not None]
        first.update({(device.host, port): device for port in listens if (device.host, port) not in first})
        if taken:
            port, owner = taken[0]
            message = f"`{device.name}` must have ports of its own on `{device.host}`, got {port} of `{owner.name}`"
            related = (Related("first used here", graph.cell.locate(*owner.path, "connection")),)
            yield found(graph, (*device.path, "connection", "first_port"), message, related=related)
