"""A driven joint has no velocity limit.

Neither the description nor the catalog says how fast the joint may move, so no trajectory can be timed.

Example that is reported:

```yaml
devices:
  bare_arm: {model: ./bare_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  stage: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
```

Fix: write `velocity` in the `<limit>` of the joint.

Source: https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): velocity is a required attribute of limit
"""

from __future__ import annotations

from cellc.compiler.rules.described import described
from cellc.compiler.rules.excuses import spared
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_CODE = "missing-velocity-limit"


@rule(Severity.ERROR, assumes=("missing-joint-limits", "limit-share-of-nothing"))
def check(graph: CellGraph) -> Findings:
    """Yield joints with a command interface and without a velocity limit above zero."""
    for device in graph.cell.devices:
        for joint in device.actuated_joints:
            if (joint.velocity is None or joint.velocity <= 0.0) and not spared(graph, device, joint.name, _CODE):
                stated = "no velocity limit" if joint.velocity is None else f"a velocity limit of {joint.velocity:g}"
                message = f"joint `{joint.name}` has {stated}"
                yield found(graph, (*device.path, "model"), message, related=described(graph, [joint.name]))
