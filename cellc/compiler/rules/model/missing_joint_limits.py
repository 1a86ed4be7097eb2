"""A joint that has ends does not state its limits.

URDF demands limits of revolute and prismatic joints. Where they are missing, one library refuses, one takes zero and
one takes infinity; the planner then moves the joint into its mechanical stop. urdfdom, which robot_state_publisher and
MoveIt read with, takes no joint whose limit has a velocity and no effort, also one that turns without end.

Example that is reported:

```xml
<joint name="slide" type="prismatic">  <!-- expect -->
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
</joint>
```

Example that is accepted:

```xml
<joint name="slide" type="prismatic">
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
</joint>
```

Fix: write `lower`, `upper`, `velocity` and `effort`, in rad or m, or declare the joint continuous.

Source: https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): limit is required for revolute and prismatic joints, and
effort and velocity in each limit
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.rules.excuses import spared
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule
from cellc.robot.description.model import Joint, JointLimit


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield joints with ends of which a limit is not stated."""
    for part in graph.model.joints():
        missing = tuple(_missing(part.joint))
        if missing and not spared(graph, part.device, part.joint.name, "missing-joint-limits"):
            names = ", ".join(f"`{name}`" for name in missing)
            message = f"{part.joint.type} joint `{part.joint.name}` does not state {names}"
            yield Finding(message, part.span, part.path)


def _missing(joint: Joint) -> Iterator[str]:
    """Yield what every reader of the description asks of the joint and the description does not have."""
    limit, has_ends = joint.limit or JointLimit(None, None, None, None), joint.type in ("revolute", "prismatic")
    if has_ends:
        stated = {"lower": limit.lower, "upper": limit.upper, "velocity": limit.velocity}
        yield from (name for name, value in stated.items() if value is None)
    # A limit without both is an excused one, or none.
    if (has_ends or joint.type == "continuous") and limit.velocity is not None and limit.effort is None:
        yield "effort"
