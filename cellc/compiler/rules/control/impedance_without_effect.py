"""An impedance is stated, and what commands the arm is untouched by it.

The robot's own controller has the set stiffness with the commands that it follows itself, such as velocities.
Torques of a controller of the cell pass it by: the gains of that one are how stiff the arm is, whatever people set.

Example that is reported:

```yaml
devices:
  arm: {impedance: {joint: 3000 3000 3000 2500 2500 2000 N m/rad}}  # expect at impedance
```

Example that is accepted:

```yaml
devices:
  arm: {impedance: {joint: 3000 3000 3000 2500 2500 2000 N m/rad}}
control:
  controllers:
    arm_trajectory: {command_interfaces: [position, velocity]}
```

Fix: delete `impedance`, or command the arm by an interface that its own controller follows.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=("refused-impedance",))
def check(graph: CellGraph) -> Findings:
    """Yield impedance of an arm whose joints are claimed by other interfaces alone on the real target."""
    for device in graph.cell.devices:
        takes = device.robot.impedance_facts
        if device.impedance is None or takes is None:
            continue
        joints = {joint.name for joint in device.joints}
        ends = (
            claim.rpartition("/")
            for controller in graph.cell.controllers
            if "real" in controller.targets
            for claim in controller.claims("real")
        )
        claimed = {interface for owner, _, interface in ends if owner in joints}
        if claimed and not claimed & set(takes.acts_on):
            by = " and ".join(sorted(claimed))
            message = f"the impedance of `{device.name}` has no effect: controllers command its joints by {by}"
            yield found(graph, (*device.path, "impedance"), message)
