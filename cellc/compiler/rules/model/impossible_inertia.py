"""No body can have such an inertia tensor.

The moments of inertia of a real body are positive, and none exceeds the sum of the other two, in any axes. URDF
libraries load a tensor that breaks this; simulations then gain energy and explode, and model-based control commands
wrong torques.

Example that is reported:

```xml
<link name="carriage">  <!-- expect -->
  <inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.5"/></inertial>
</link>
```

Example that is accepted:

```xml
<link name="carriage">
  <inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.2"/></inertial>
</link>
```

Fix: compute the tensor about the center of mass from the CAD model, in kg m^2; mm and g are the usual mistake.

Source: docs/principles.md#robot-descriptions
"""

from __future__ import annotations

from cellc.compiler.rules.excuses import spared
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule
from cellc.robot.description.model import Inertial

Matrix = tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]
_ROUNDING = 1e-6  # of the trace; tensors are written with few digits


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield links whose tensor is not positive or breaks the triangle inequality."""
    for part in graph.model.links():
        if spared(graph, part.device, "", "impossible-inertia"):
            continue
        if part.link.inertial is not None and (reason := _impossible(part.link.inertial)):
            message = f"link `{part.link.name}` has an impossible inertia tensor: {reason}"
            yield Finding(message, part.span, part.path)


def _impossible(inertial: Inertial) -> str:
    moments = (inertial.ixx, inertial.iyy, inertial.izz)
    if not any((*moments, inertial.ixy, inertial.ixz, inertial.iyz)):
        return ""  # all zero is how a point or a bare frame is written
    if min(moments) <= 0.0:
        name = ("ixx", "iyy", "izz")[moments.index(min(moments))]
        return f"{name} is {min(moments):g}"
    half = sum(moments) / 2.0
    if not _semidefinite(_tensor(inertial, 1.0, 0.0), half):
        return "a principal moment is negative"
    if not _semidefinite(_tensor(inertial, -1.0, half), half):
        return "one principal moment exceeds the sum of the other two"
    return ""


def _tensor(inertial: Inertial, sign: float, shift: float) -> Matrix:
    xy, xz, yz = sign * inertial.ixy, sign * inertial.ixz, sign * inertial.iyz
    xx, yy, zz = (shift + sign * moment for moment in (inertial.ixx, inertial.iyy, inertial.izz))
    return ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))


def _semidefinite(m: Matrix, scale: float) -> bool:
    # A symmetric matrix has no negative eigenvalue where no principal minor is negative.
    first = (m[0][0], m[1][1], m[2][2])
    second = tuple(m[i][i] * m[j][j] - m[i][j] ** 2 for i, j in ((0, 1), (0, 2), (1, 2)))
    third = m[0][0] * second[2] - m[0][1] * (m[0][1] * m[2][2] - m[1][2] * m[0][2])
    third += m[0][2] * (m[0][1] * m[1][2] - m[1][1] * m[0][2])
    minors = ((first, scale), (second, scale**2), ((third,), scale**3))
    return all(value >= -_ROUNDING * size for values, size in minors for value in values)
