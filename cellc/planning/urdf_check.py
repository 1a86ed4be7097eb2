"""The reasons for which a URDF parser refuses a text, found before the parser sees it.

The parser underneath pinocchio prints its reason to stderr and raises the same sentence for every cause, so the causes
are looked for here. What this check lets through and the parser still refuses ends in the parser's own sentence.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable

from cellc.planning.failure import ModelError

_MOVABLE = ("revolute", "continuous", "prismatic", "planar", "floating")


def check_urdf(text: str) -> None:
    """Raise ModelError with the first reason, in document order, for which the text is no robot description."""
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise ModelError(f"the robot description is not well-formed XML: {error}") from None
    if root.tag != "robot":
        raise ModelError(f"the root element is `{root.tag}`, not `robot`")
    links = [link.get("name", "") for link in root.findall("link")]
    joints = root.findall("joint")
    if not links:
        raise ModelError("the robot description has no link")
    _refuse_repeated("link", links)
    _refuse_repeated("joint", [joint.get("name", "") for joint in joints])
    for joint in joints:
        _check_joint(joint, links)
    _check_tree(joints, links)


def _refuse_repeated(kind: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if not name:
            raise ModelError(f"a {kind} has no name")
        if name in seen:
            raise ModelError(f"{kind} `{name}` is declared twice")
        seen.add(name)


def _check_joint(joint: ElementTree.Element, links: list[str]) -> None:
    name, kind = joint.get("name", ""), joint.get("type", "")
    if kind != "fixed" and kind not in _MOVABLE:
        raise ModelError(f"joint `{name}` has the unknown type `{kind}`")
    for end in ("parent", "child"):
        link = _link_of(joint, end)
        if link not in links:
            raise ModelError(f"joint `{name}` has the {end} link `{link}`, which does not exist")
    if kind in ("revolute", "prismatic") and joint.find("limit") is None:
        raise ModelError(f"joint `{name}` is {kind} and has no limit")
    limit = joint.find("limit")
    for value in ("effort", "velocity"):
        if limit is not None and limit.get(value) is None:
            raise ModelError(f"the limit of joint `{name}` states no {value}")


def _check_tree(joints: list[ElementTree.Element], links: list[str]) -> None:
    parent_of: dict[str, str] = {}
    for joint in joints:
        child = _link_of(joint, "child")
        if child in parent_of:
            raise ModelError(f"link `{child}` is the child of two joints")
        parent_of[child] = _link_of(joint, "parent")
    roots = [link for link in links if link not in parent_of]
    if len(roots) != 1:
        shown = ", ".join(f"`{root}`" for root in roots) or "none"
        raise ModelError(f"the links must have exactly one root, found {shown}")
    for link in links:
        _refuse_cycle(link, parent_of)


def _refuse_cycle(link: str, parent_of: dict[str, str]) -> None:
    at = link
    for _ in range(len(parent_of) + 1):
        if at not in parent_of:
            return
        at = parent_of[at]
    raise ModelError(f"link `{link}` is on a cycle of joints")


def _link_of(joint: ElementTree.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")
