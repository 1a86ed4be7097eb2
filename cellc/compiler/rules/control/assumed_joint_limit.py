"""A limit of a driven joint is assumed.

A vendor's description may leave out how far, how fast or how strongly a joint moves. `cellc import` then writes a
careful figure into `device.yaml` with the source UNKNOWN, so that the mock runs. The real joint may have less: it hits
its stop, or its drive faults. The real target stays closed until each figure has a source.

Example that is reported:

```yaml
devices:
  slow_arm: {model: ./assumed_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  slow_arm: {model: ./bare_arm_with_tool, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: look the figures up in the vendor's manual, and write them with their `source` under `limits` of `device.yaml`.

Source: https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): lower, upper, velocity and effort of a limit
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices with joints of which a limit has no source."""
    for device in graph.cell.devices:
        assumed = _assumed(device)
        if assumed:
            named = ", ".join(f"`{key}` of {_shown(joints)}" for key, joints in assumed.items())
            message = f"limits of `{device.name}` are assumed: {named}"
            first = [joints[0] for joints in assumed.values()]
            places = described(graph, [f"{device.prefix}{name}" for name in first])
            yield found(graph, (*device.path, "model"), message, related=places)


def _assumed(device: Device) -> dict[str, list[str]]:
    """Return the keys of the limits that are assumed, each with its joints."""
    joints: dict[str, list[str]] = {}
    for joint in device.actuated_joints:
        for key in joint.assumed:
            joints.setdefault(key, []).append(joint.local_name)
    return joints


def _shown(joints: list[str]) -> str:
    return f"`{joints[0]}`" if len(joints) == 1 else f"`{joints[0]}` and {len(joints) - 1} more"
