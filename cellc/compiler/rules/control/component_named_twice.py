"""Two devices under one controller manager have a hardware component of one name.

Parsers of URDF take the two `<ros2_control>` elements, and so does everything that reads the description. The
controller manager refuses the second one as it loads the hardware, and none of its components starts.

Example that is reported:

```yaml
devices:
  left: {model: ./named_component, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
  right:  # expect at devices.right
    {model: ./named_component, mount: {parent: world, xyz: 0 3 0 m}, revision: A, firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  left: {model: ./named_component, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: name the component after its device, as `component: "{device}_hardware"` in its `device.yaml`.

Source: https://github.com/ros-controls/ros2_control/blob/4.46.0/hardware_interface/src/resource_manager.cpp
(4.46.0): nothing more is loaded after a name that is duplicated
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each device of a manager whose component has the name of an earlier one's."""
    for manager in graph.cell.managers:
        first: dict[str, Device] = {}
        for device in map(graph.cell.device, manager.devices):
            if device.hardware is None:
                continue
            earlier = first.setdefault(device.hardware.name, device)
            if earlier is not device:
                message = f"`{device.name}` and `{earlier.name}` both have the hardware component"
                message += f" `{device.hardware.name}` under `{manager.node}`"
                related = (Related(f"`{earlier.name}` is here", earlier.span),)
                yield found(graph, device.path, message, related=related)
