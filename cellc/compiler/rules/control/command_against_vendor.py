"""A controller commands real hardware through another interface than its vendor does.

What a hardware plugin does with a command depends on its interface: limiters, filters and the mode of the robot's own
control are chosen by it. The mock follows all of them alike, and the controller manager grants them all.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory:
      command_interfaces: [velocity]  # expect at command_interfaces
      parameters: {gains.arm_joint_1.p: 2.0, gains.arm_joint_2.p: 2.0, gains.arm_joint_3.p: 2.0,
                   gains.arm_joint_4.p: 2.0, gains.arm_joint_5.p: 2.0, gains.arm_joint_6.p: 2.0}
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [position, velocity]}
```

Fix: leave `command_interfaces` out: a controller then claims on real hardware what the vendor's does, with its gains.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=("unprovided-command-interface", "trajectory-without-gains"))
def check(graph: CellGraph) -> Findings:
    """Yield controllers without what the vendor's own claim of a joint on the real target."""
    for controller in graph.cell.controllers:
        vendor = controller.vendor
        if vendor is None or "real" not in controller.targets:
            continue
        claimed = tuple(dict.fromkeys(name.rpartition("/")[2] for name in controller.claims("real")))
        if not set(vendor.interfaces) <= set(claimed):
            theirs = " + ".join(vendor.interfaces)
            message = (
                f"`{controller.name}` commands {' + '.join(claimed)} of `{controller.device}`, its vendor {theirs}: "
                f"{vendor.because}"
            )
            yield found(graph, (*controller.path, "command_interfaces"), message)
