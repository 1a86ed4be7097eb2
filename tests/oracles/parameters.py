"""What controllers declare of their own parameters, by file and distribution: a table of facts, no file of theirs."""

from __future__ import annotations

from functools import cache
from typing import Any

from tests.foreign_yaml import safe_load
from tests.oracles import RECORDED

Declaration = dict[str, Any]
"""``type``, and ``default_value`` and ``validation`` where a parameter has them."""


@cache
def declarations(file: str, distro: str) -> dict[str, Declaration]:
    """Return the declarations of a file of a distribution by their names with dots; none where it has no such file."""
    rows = (row for row in _table().get(file, ()) if distro in row.get("in", (distro,)))
    return {row["name"]: {key: value for key, value in row.items() if key not in ("name", "in")} for row in rows}


@cache
def _table() -> dict[str, list[Declaration]]:
    table: dict[str, list[Declaration]] = safe_load((RECORDED / "declared_parameters.yaml").read_text(encoding="utf-8"))
    return table
