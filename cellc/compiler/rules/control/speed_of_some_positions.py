"""A cell allows a speed that its device has in some positions alone.

The description has one velocity for a joint, and the robot allows less of it near the ends of the joint. A planner that
reads the description plans through there at full speed: the robot stops with a violated limit.

Example that is reported:

```yaml
devices:
  stage: {model: ./hasty, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0,
          limits: {velocity: 80 %}}  # expect at velocity
```

Example that is accepted:

```yaml
devices:
  stage: {model: ./hasty, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0,
          limits: {velocity: 50 %}}
```

Fix: allow the share that holds everywhere, and more only where each motion is tried.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_ROUNDING = 1.001


@rule(Severity.WARNING, assumes=("limit-share-above-full",))
def check(graph: CellGraph) -> Findings:
    """Yield devices with a joint that may be faster than the device allows it everywhere, once each."""
    for device in graph.cell.devices:
        shares = {
            joint.velocity / joint.velocity_everywhere: joint
            for joint in device.joints
            if joint.velocity and joint.velocity_everywhere
        }
        most = max(shares, default=0.0)
        if most > _ROUNDING:
            joint = shares[most]
            path = (*device.path, "limits", "velocity")
            message = (
                f"`{joint.name}` must have at most {joint.velocity_everywhere:g} rad/s, which it has in every position,"
            )
            message += f" got {joint.velocity:.3g} rad/s"
            written = device.limit_shares.velocity
            advice = f"write at most {written / most * 100:.0f} %"
            yield found(graph, path, message, advice, described(graph, [joint.name]))
