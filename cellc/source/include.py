"""Which files an ``include`` names, and whether they may be read."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from cellc.diagnostics import Diagnostic, Span
from cellc.source.finding import finding
from cellc.source.merge import INCLUDE
from cellc.source.node import Child, Node


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
