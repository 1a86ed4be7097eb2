"""One package is in the tuple with two versions.

A workspace holds a package once. Whichever version is built or sourced last serves both devices, and one of them runs
with a driver that was not tested with it.

Example that is reported:

```yaml
devices:
  gripper: {driver: demo_camera_driver 4.58.2}  # expect at driver
```

Example that is accepted:

```yaml
devices:
  gripper: {driver: demo_gripper_driver 0.0.1}
```

Fix: pin one version for both, or run the drivers on two hosts.

Source: docs/principles.md#pinned-versions
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.graph.versions import Pin, device_pins
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.pins import version_numbers

_PACKAGES = ("driver", "sdk", "description")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second version of a package on one host; a description is read wherever the cell is."""
    hosts = {device.name: device.host for device in graph.cell.devices}
    first: dict[tuple[str, str], Pin] = {}
    for pin in device_pins(graph.cell):
        words = pin.text.split()
        if pin.part not in _PACKAGES or pin.text == UNKNOWN or len(words) != 2 or not version_numbers(pin.text):
            continue
        host = "" if pin.part == "description" else hosts[pin.holder]
        other = first.setdefault((words[0], host), pin)
        if version_numbers(other.text) != version_numbers(pin.text):
            number = other.text.split()[1]
            message = f"`{words[0]}` must have one version in a workspace, got {words[1]} for `{pin.holder}`"
            message += f" and {number} for `{other.holder}`"
            related = (Related(f"{number} is written here", graph.cell.locate(*other.path)),)
            yield found(graph, pin.path, message, related=related)
