"""A limit of a command interface in `<ros2_control>` is not a number, so that it limits nothing.

ros2_control prints a line, and skips `min` and `max` of that interface: those of the joint are left. A usual cause
is `{pi}`, which xacro leaves as it is; it evaluates `${pi}`.

Example that is reported:

```xml
<link name="tool"/>
<ros2_control name="stage" type="system">
  <hardware><plugin>stage_driver/Hardware</plugin></hardware>
  <joint name="turn">  <!-- expect -->
    <command_interface name="position"><param name="min">-2</param><param name="max">{pi}</param></command_interface>
  </joint>
</ros2_control>
```

Example that is accepted:

```xml
<link name="tool"/>
<ros2_control name="stage" type="system">
  <hardware><plugin>stage_driver/Hardware</plugin></hardware>
  <joint name="turn">
    <command_interface name="position"><param name="min">-2</param><param name="max">2</param></command_interface>
  </joint>
</ros2_control>
```

Fix: write the number, or remove the parameter.

Source: https://github.com/ros-controls/ros2_control/blob/4.47.0/hardware_interface/src/component_parser.cpp
(4.47.0): retrieve_min_max_interface_values
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule
from cellc.robot.description.model import as_number


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield each interface with a limit that is not a number, at its joint."""
    for device in graph.cell.devices:
        path = (*device.path, "model")
        for part in (part for component in device.description.hardware for part in component.joints):
            for interface in part.command_interfaces:
                written = {"min": interface.minimum, "max": interface.maximum}
                texts = [
                    f"`{key}` is `{text[:40]}`" for key, text in written.items() if text and as_number(text) is None
                ]
                if texts:
                    message = (
                        f"`{interface.name}` of `{part.name}` has a limit that is not a number: {', '.join(texts)}"
                    )
                    yield Finding(message, part.span or graph.cell.locate(*path), path)
