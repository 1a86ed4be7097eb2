"""Substitutions of launch XML that the cell uses."""

from __future__ import annotations

from cellc.cell.cell import Cell

ON_REAL = "$(eval \"'$(var target)' == 'real'\")"
"""True on the real target; `eval` because Humble has no `equals`, harmless because the argument has choices."""


def share(cell: Cell, path: str) -> str:
    """Return the installed place of a file of the package."""
    return f"$(find-pkg-share {cell.name})/{path}"


def description(cell: Cell) -> str:
    """Return the URDF of the target, share folders of other packages put in by xacro."""
    return f"$(command 'xacro {share(cell, f'urdf/{cell.name}.$(var target).urdf')}')"
