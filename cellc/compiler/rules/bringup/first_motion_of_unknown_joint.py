"""The first motion names a joint that does not exist.

The joint that is stated aloud must be the one that moves.

Example that is reported:

```yaml
bringup:
  first_motion:
    joint: arm/joint_7  # expect at joint
    direction: +
    max_delta: 5 deg
    velocity: 5 deg/s
    timeout: 5 s
    stop_if: [wrong direction]
```

Example that is accepted:

```yaml
bringup:
  first_motion:
    joint: arm/joint_6
    direction: +
    max_delta: 5 deg
    velocity: 5 deg/s
    timeout: 5 s
    stop_if: [wrong direction]
```

Fix: name a driven joint as `device/joint`.

Source: docs/principles.md#the-first-motion
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a first motion whose joint no device drives."""
    motion = graph.cell.bringup.first_motion
    driven = [f"{device.name}/{joint.local_name}" for device in graph.cell.devices for joint in device.actuated_joints]
    if motion is not None and motion.joint not in driven:
        message = f"no device drives a joint `{motion.joint}`"
        yield found(
            graph, ("bringup", "first_motion", "joint"), message, did_you_mean(motion.joint, driven, "driven joints")
        )
