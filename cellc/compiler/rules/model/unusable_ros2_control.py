"""The `<ros2_control>` of a description cannot be loaded, or names what the robot does not have.

cellc writes the tag of a cell itself, so that nothing of this reaches the mock. The vendor's own launch files use it:
there the controller manager refuses the robot, or a controller waits for an interface that no hardware exports.

Example that is reported:

```xml
<link name="tool"/>
<ros2_control name="stage" type="system">
  <hardware><plugin>stage_driver/Hardware</plugin></hardware>
  <joint name="trun"><command_interface name="position"/><state_interface name="position"/></joint>  <!-- expect -->
</ros2_control>
```

Example that is accepted:

```xml
<link name="tool"/>
<ros2_control name="stage" type="system">
  <hardware><plugin>stage_driver/Hardware</plugin></hardware>
  <joint name="turn"><command_interface name="position"/><state_interface name="position"/></joint>
</ros2_control>
```

Fix: correct the tag in the description, or tell its vendor.

Source: https://github.com/ros-controls/ros2_control/blob/4.47.0/hardware_interface/src/component_parser.cpp
(4.47.0): parse_control_resources_from_urdf and what it throws
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule
from cellc.contract.diagnostics import Span, is_slip
from cellc.robot.description.model import Description, HardwareInterface, HardwarePart, as_number

_TYPES = ("system", "actuator", "sensor")
_STANDARD = ("position", "velocity", "acceleration", "effort")

Told = Iterator[tuple[str, Span | None]]
"""What is wrong, and where the description says it."""


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield what ros2_control refuses of the tags, and joints and interfaces that nothing has."""
    for device in graph.cell.devices:
        path = (*device.path, "model")
        for message, span in (*_refused(device.description), *_of_joints(device)):
            yield Finding(message, span or graph.cell.locate(*path), path)


def _refused(description: Description) -> Told:
    if description.hardware_error:
        yield f"ros2_control refuses the description: {description.hardware_error}", description.hardware_error_span
    names = Counter(component.name for component in description.hardware)
    for component in description.hardware:
        if component.type not in _TYPES:
            yield (
                f"`type` of `{component.name}` must be one of {', '.join(_TYPES)}, got `{component.type}`",
                component.span,
            )
        if names[component.name] > 1:
            yield f"two components have the name `{component.name}`", component.span
        if not component.plugin:
            yield f"`{component.name}` names no plugin", component.span


def _of_joints(device: Device) -> Told:
    joints = {joint.name.removeprefix(device.prefix): joint for joint in device.description.joints}
    commanded: dict[str, str] = {}
    for component in device.description.hardware:
        for part in component.joints:
            joint = joints.get(part.name)
            if joint is None:
                yield f"`{component.name}` has the joint `{part.name}`, which the description does not have", part.span
            elif joint.mimic is not None and part.command_interfaces and part.mimic != "false":
                yield f"`{part.name}` follows another joint, and has command interfaces", part.span
            if part.command_interfaces and part.name in commanded:
                yield f"`{part.name}` is commanded by `{commanded[part.name]}` and `{component.name}`", part.span
            elif part.command_interfaces:
                commanded[part.name] = component.name
            yield from _of_interfaces(part)
            follows = joint is not None and joint.mimic is not None
            if not part.command_interfaces and not part.state_interfaces and not follows:
                yield f"`{part.name}` of `{component.name}` has no interface", part.span


def _of_interfaces(part: HardwarePart) -> Told:
    for kind, interfaces in (("command", part.command_interfaces), ("state", part.state_interfaces)):
        names = Counter(interface.name for interface in interfaces)
        for interface in interfaces:
            near = next((text for text in _STANDARD if is_slip(interface.name, text)), None)
            if near is not None and interface.name not in _STANDARD:
                yield f"`{part.name}` has the {kind} interface `{interface.name}`, which is not `{near}`", part.span
            for wrong in _wrong_bounds(interface):
                yield f"`{interface.name}` of `{part.name}` {wrong}", part.span
        for name in (name for name, count in names.items() if count > 1):
            yield f"`{part.name}` has the {kind} interface `{name}` twice", part.span


def _wrong_bounds(interface: HardwareInterface) -> Iterator[str]:
    if interface.initial_value and as_number(interface.initial_value) is None:
        yield f"must have a number in `initial_value`, got `{interface.initial_value[:40]}`"
    least, most = as_number(interface.minimum), as_number(interface.maximum)
    if least is not None and most is not None and least > most:
        yield f"must have `min` at most `max`, got {least:g} and {most:g}"
