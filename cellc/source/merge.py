"""Merge the roots of a spec and its included files, section by section."""

from __future__ import annotations

from collections.abc import Sequence

from cellc.diagnostics import Diagnostic, Outcome, Related
from cellc.source.finding import finding
from cellc.source.limits import MAX_NODES
from cellc.source.node import Child, Node

INCLUDE = "include"


def merge(roots: Sequence[Node]) -> Outcome[Node]:
    """Return one root with the sections of all files, in the order of the files and without ``include``.

    Args:
        roots: mappings, the root spec first; where two write the same, the first counts as first written.
    """
    sections: dict[str | int, Child] = {}
    findings: list[Diagnostic] = []
    for root in roots:
        for name, section in root.children.items():
            if name == INCLUDE:
                continue
            first = sections.get(name)
            sections[name] = section if first is None else _merge_section(str(name), first, section, findings)
    merged = _mapping(roots[0], sections)
    if merged.size > MAX_NODES:
        message = f"the spec and its includes hold {merged.size} values; at most {MAX_NODES} are read"
        findings.append(finding("too-many-values", message, roots[0].span))
    return Outcome(merged, tuple(findings))


def _merge_section(name: str, first: Child, second: Child, findings: list[Diagnostic]) -> Child:
    first_is_mapping, second_is_mapping = isinstance(first.node.data, dict), isinstance(second.node.data, dict)
    if first_is_mapping != second_is_mapping:
        message = f"`{name}` is a mapping in one file and not in the other"
        findings.append(_clash("key-collision", message, (name,), first, second))
        return first
    if not first_is_mapping:
        findings.append(_clash("duplicate-key", f"the key `{name}` is written in two files", (name,), first, second))
        return first
    children = dict(first.node.children)
    for key, child in second.node.children.items():
        earlier = children.setdefault(key, child)
        if earlier is not child:
            message = f"the key `{key}` of `{name}` is written in two files"
            findings.append(_clash("duplicate-key", message, (name, key), earlier, child))
    return Child(_mapping(first.node, children), first.span, first.key_span)


def _clash(code: str, message: str, path: tuple[str | int, ...], first: Child, second: Child) -> Diagnostic:
    related = (Related("first written here", first.key_span or first.span),)
    return finding(code, message, second.key_span or second.span, path=path, related=related)


def _mapping(original: Node, children: dict[str | int, Child]) -> Node:
    """Return a mapping node at the place of ``original``."""
    nodes = [child.node for child in children.values()]
    data = {str(name): child.node.data for name, child in children.items()}
    size = 1 + sum(node.size for node in nodes)
    return Node(original.span, data, "", children, size, 1 + max((node.height for node in nodes), default=0))
