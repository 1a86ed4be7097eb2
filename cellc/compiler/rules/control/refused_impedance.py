"""An impedance does not fit its robot.

One figure short, or past what the controller of the robot takes, the request is refused when people send it, and the
arm stays as stiff as it was before, which may be stiffer than the risk assessment of the cell has it.

Example that is reported:

```yaml
devices:
  arm: {impedance: {joint: 3000 3000 3000 2500 2500 N m/rad}}  # expect at joint
```

Example that is accepted:

```yaml
devices:
  arm: {impedance: {joint: 3000 3000 3000 2500 2500 2000 N m/rad,
                    cartesian: {translation: 2000 2000 2000 N/m, rotation: 100 100 100 N m/rad}}}
control:
  controllers:
    arm_trajectory: {command_interfaces: [position, velocity]}
```

Fix: give each joint and axis a figure within what the robot takes, and none to a robot that takes none.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.robot import Impedance, ImpedanceFacts
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_Stated = tuple[tuple[str, ...], tuple[float, ...], tuple[float, float], str]


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield impedance for no device, of another number of joints, and figures that the robot does not take."""
    for device in graph.cell.devices:
        stated, takes = device.impedance, device.robot.impedance_facts
        if stated is None:
            continue
        path = (*device.path, "impedance")
        if takes is None:
            yield found(graph, path, f"the driver of `{device.name}` sets no impedance")
            continue
        joints = len(device.actuated_joints)
        if stated.joint is not None and len(stated.joint) != joints:
            message = f"the joint impedance of `{device.name}` must be {joints} figures, got {len(stated.joint)}"
            yield found(graph, (*path, "joint"), message)
        for keys, figures, (least, most), unit in _figures(stated, takes):
            refused = [figure for figure in figures if not least <= figure <= most]
            if refused:
                message = f"`{keys[-1]}` of `{device.name}` must be {least:g} to {most:g} {unit}, got {refused[0]:g}"
                yield found(graph, (*path, *keys), message)


def _figures(stated: Impedance, takes: ImpedanceFacts) -> Iterator[_Stated]:
    """Yield each figure that is written: its keys, values, least and most, and unit."""
    if stated.joint is not None:
        yield ("joint",), stated.joint, takes.joint, "N m/rad"
    if stated.cartesian is not None:
        yield ("cartesian", "translation"), stated.cartesian.translation, takes.translation, "N/m"
        yield ("cartesian", "rotation"), stated.cartesian.rotation, takes.rotation, "N m/rad"
