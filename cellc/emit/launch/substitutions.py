"""Substitutions of launch XML that the cell uses."""

from __future__ import annotations

from cellc.cell.cell import Cell

TARGET = "$(var target)"

HOST = "$(var host)"

ON_REAL = f"$(eval \"'{TARGET}' == 'real'\")"
"""True on the real target; `eval` because Humble has no `equals`, harmless because the argument has choices."""


def only_on(target: str | None) -> dict[str, str]:
    """Return the condition of what is started on one target alone; none for what is started on every target."""
    return {} if target is None else {"if" if target == "real" else "unless": ON_REAL}


def on_host(host: str) -> str:
    """Return what is true where a host's part is to be started."""
    return f"$(eval \"'{HOST}' == 'all' or '{HOST}' == '{host}'\")"


def share(cell: Cell, path: str) -> str:
    """Return the installed place of a file of the package."""
    return f"$(find-pkg-share {cell.name})/{path}"


def expanded(file: str) -> str:
    """Return the text of an installed description, share folders of other packages put in by xacro."""
    return f"$(command 'xacro {file}')"
