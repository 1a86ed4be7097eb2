"""Which files an ``include`` names, whether they may be read, and how the roots of several files become one."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from cellc.compiler.source.document import Child, Node
from cellc.compiler.source.findings import finding
from cellc.contract.diagnostics import Diagnostic, Outcome, Related, Span
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits


@dataclass(frozen=True, slots=True)
class IncludeLine:
    """One path of an ``include`` and where it is written."""

    path: str
    span: Span


def include_lines(root: Node) -> tuple[IncludeLine, ...] | Diagnostic:
    """Return the paths that the root of a file includes, in the order written."""
    child = root.children.get(INCLUDE)
    if child is None:
        return ()
    items: tuple[Child, ...] = (child,)
    if isinstance(child.node.data, list):
        items = tuple(child.node.children.values())
    lines = []
    for item in items:
        if not isinstance(item.node.data, str) or not item.node.data.strip():
            message = "`include` must be a relative path or a list of them"
            return finding("include-shape", message, item.place, path=(INCLUDE,))
        lines.append(IncludeLine(item.node.data, item.place))
    return tuple(lines)


def resolve_include(line: IncludeLine, folder: Path, root_folder: Path) -> Path | Diagnostic:
    """Return the real path of an included file, which lies in ``root_folder``.

    Args:
        folder: of the including file; the path counts from it.
        root_folder: of the root spec, with symbolic links resolved.
    """
    if PurePosixPath(line.path).is_absolute() or Path(line.path).is_absolute():
        return finding("include-escape", f"`{line.path}` is an absolute path", line.span, path=(INCLUDE,))
    try:
        real = Path(os.path.realpath(folder / line.path))
    except (OSError, ValueError):
        # A zero character in the name, say.
        return finding("file-unreadable", f"`{line.path}` leads to no file", line.span, path=(INCLUDE,))
    if not real.is_relative_to(root_folder):
        message = f"`{line.path}` leads out of the folder of the spec"
        return finding("include-escape", message, line.span, path=(INCLUDE,))
    return real


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
    if merged.size > limits().spec_values:
        message = f"the spec and its includes hold {merged.size} values; at most {limits().spec_values} are read"
        findings.append(finding("too-many-values", message, roots[0].span))
    return Outcome(merged, tuple(findings))


def overlay(below: Node, above: Node) -> Node:
    """Return ``below`` with what ``above`` writes in its place.

    Mappings merge by key, everything else replaces, and null takes a key away that ``below`` has.
    """
    if not isinstance(below.data, dict) or not isinstance(above.data, dict):
        return above
    children = dict(below.children)
    for key, child in above.children.items():
        under = children.get(key)
        if under is not None and child.node.data is None:
            del children[key]
            continue
        node = child.node if under is None else overlay(under.node, child.node)
        children[key] = Child(node, child.span, child.key_span)
    return _mapping(above, children)


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
