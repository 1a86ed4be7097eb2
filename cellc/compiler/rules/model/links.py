"""Rules on the links of a description: their tree, masses and inertia."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.robot import Moments6, Payload
from cellc.compiler.graph.frame_tree import ModelJoint, ModelLink
from cellc.compiler.rules.excuses import spared
from cellc.compiler.rules.kit import (
    CellGraph,
    Finding,
    Findings,
    Related,
    Severity,
    YamlPath,
    did_you_mean,
    found,
    rule,
)
from cellc.contract.transforms import identity
from cellc.robot.description.model import Inertial


@rule(Severity.ERROR)
def duplicate_model_name(graph: CellGraph) -> Findings:
    """Yield the second and every later bearer of a name."""
    seen: dict[tuple[str, str, str], ModelLink | ModelJoint] = {}
    named: list[tuple[str, str, ModelLink | ModelJoint]] = []
    named += [("link", link.link.name, link) for link in graph.model.links()]
    named += [("joint", joint.joint.name, joint) for joint in graph.model.joints()]
    for kind, name, part in named:
        first = seen.setdefault((part.device.name, kind, name), part)
        if first is not part:
            message = f"`{part.device.name}` has two {kind}s named `{name}`"
            related = (Related(f"first {kind} `{name}` here", first.span),)
            yield Finding(message, part.span, part.path, related=related)


Matrix = tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]
_ROUNDING = 1e-6  # of the trace; tensors are written with few digits


@rule(Severity.ERROR)
def impossible_inertia(graph: CellGraph) -> Findings:
    """Yield links whose tensor is not positive or breaks the triangle inequality."""
    for part in graph.model.links():
        if spared(graph, part.device, "", "impossible-inertia"):
            continue
        if part.link.inertial is not None and (reason := _impossible(part.link.inertial)):
            message = f"link `{part.link.name}` has an impossible inertia tensor: {reason}"
            yield Finding(message, part.span, part.path)
    for device in graph.cell.devices:
        for path, inertial in _carried(device.robot.payload):
            if reason := _impossible(inertial):
                message = f"the {path[-1]} of `{device.name}` has an impossible inertia tensor: {reason}"
                yield found(graph, (*device.path, *path, "inertia"), message)


def _carried(payload: Payload | None) -> Iterator[tuple[YamlPath, Inertial]]:
    """Yield what an arm is set to carry and the part of it that a service sets, where a tensor is stated."""
    if payload is not None and payload.inertia is not None:
        yield ("payload",), _body(payload.mass_kg, payload.inertia)
    if payload is not None and payload.load is not None:
        yield ("payload", "load"), _body(payload.load.mass_kg, payload.load.inertia)


def _body(mass_kg: float, tensor: Moments6) -> Inertial:
    ixx, iyy, izz, ixy, ixz, iyz = tensor
    return Inertial(pose=identity(), mass=mass_kg, ixx=ixx, ixy=ixy, ixz=ixz, iyy=iyy, iyz=iyz, izz=izz)


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


@rule(Severity.ERROR)
def joint_of_unknown_link(graph: CellGraph) -> Findings:
    """Yield joints whose parent or child is no link."""
    for part in graph.model.joints():
        description = part.device.body.description
        for role, name in (("parent", part.joint.parent), ("child", part.joint.child)):
            if description.link(name) is None:
                message = f"the {role} of joint `{part.joint.name}` is `{name}`, which is not a link"
                links = (link.name for link in description.links)
                yield Finding(message, part.span, part.path, did_you_mean(name, links, "links"))


@rule(Severity.ERROR, assumes=("duplicate-model-name",))
def link_with_two_parents(graph: CellGraph) -> Findings:
    """Yield the second joint that ends in one link."""
    seen: dict[tuple[str, str], ModelJoint] = {}
    for part in graph.model.joints():
        first = seen.setdefault((part.device.name, part.joint.child), part)
        if first is not part:
            message = f"link `{part.joint.child}` is the child of joints `{first.joint.name}` and `{part.joint.name}`"
            related = (Related(f"already the child of `{first.joint.name}`", first.span),)
            yield Finding(message, part.span, part.path, related=related)


@rule(Severity.ERROR)
def negative_mass(graph: CellGraph) -> Findings:
    """Yield links that weigh less than nothing."""
    for part in graph.model.links():
        inertial = part.link.inertial
        if inertial is not None and inertial.mass < 0.0:
            message = f"the mass of link `{part.link.name}` must not be negative, got {inertial.mass:g} kg"
            yield Finding(message, part.span, part.path)


@rule(Severity.ERROR, assumes=("joint-of-unknown-link",))
def several_root_links(graph: CellGraph) -> Findings:
    """Yield every root but the one that is mounted."""
    for part in graph.model.links():
        root = part.device.body.root_link
        if part.link.name != root and part.link.name in part.device.body.description.roots():
            message = f"link `{part.link.name}` has no parent; the root of `{part.device.name}` is `{root}`"
            mounted = part.device.body.description.link(root)
            related = (Related("the root", mounted.span),) if mounted is not None and mounted.span is not None else ()
            yield Finding(message, part.span, part.path, related=related)
