"""The reasons for which a URDF parser refuses a description, found before the parser sees it.

The parser underneath pinocchio prints its reason to stderr and raises the same sentence for every cause, so the causes
are looked for here. What this check lets through and the parser still refuses ends in the parser's own sentence.
"""

from __future__ import annotations

from collections.abc import Iterable

from cellc.description.model import Description, Joint
from cellc.planning.failure import ModelError


def check_description(description: Description) -> None:
    """Raise ModelError with the first reason for which links and joints are no robot."""
    links = [link.name for link in description.links]
    if not links:
        raise ModelError("the robot description has no link")
    _refuse_repeated("link", links)
    _refuse_repeated("joint", [joint.name for joint in description.joints])
    for joint in description.joints:
        _check_joint(joint, links)
    _check_tree(description)


def _refuse_repeated(kind: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise ModelError(f"{kind} `{name}` is declared twice")
        seen.add(name)


def _check_joint(joint: Joint, links: list[str]) -> None:
    for end, link in (("parent", joint.parent), ("child", joint.child)):
        if link not in links:
            raise ModelError(f"joint `{joint.name}` has the {end} link `{link}`, which does not exist")
    if joint.limit is None:
        if joint.type in ("revolute", "prismatic"):
            raise ModelError(f"joint `{joint.name}` is {joint.type} and has no limit")
        return
    for name, value in (("effort", joint.limit.effort), ("velocity", joint.limit.velocity)):
        if value is None:
            raise ModelError(f"the limit of joint `{joint.name}` states no {name}")


def _check_tree(description: Description) -> None:
    children: set[str] = set()
    for joint in description.joints:
        if joint.child in children:
            raise ModelError(f"link `{joint.child}` is the child of two joints")
        children.add(joint.child)
    roots = description.roots()
    if len(roots) != 1:
        shown = ", ".join(f"`{root}`" for root in roots) or "none"
        raise ModelError(f"the links must have exactly one root, found {shown}")
    unreached = description.unreached(roots[0])
    if unreached:
        raise ModelError(f"link `{unreached[0]}` is on a cycle of joints")
