"""What the names of a text are: of the cell's contract where it has them, of the field where they are well known."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache
from typing import TYPE_CHECKING

from cellc.compiler.catalog.catalog_model import CatalogModel, Text
from cellc.contract.vocabulary import InterfaceKind
from cellc.tools.diagnose.symptoms import Pattern, read_table, small_letters

if TYPE_CHECKING:
    from cellc.compiler.cell.cell import Cell
    from cellc.compiler.cell.interface import Endpoint, Interface

_OF_CELL, _WELL_KNOWN = 3, 2
"""How many names are named."""
_FULL_NAME = re.compile(r"(?<![\w./:~-])/[A-Za-z]\w*(?:/\w+)*(?![\w/.]*\.\w)(?![\w/])")
_OF_TOPIC = re.compile(r"\b(topics?|publish\w*|subscri\w*|echo|hz)\b", re.IGNORECASE)
_NO_TOPIC = re.compile(r"^/(home|tmp|opt|usr|etc|dev|var|proc|sys|mnt|root|media)\b")


class Name(CatalogModel):
    """A well-known name."""

    name: Text
    says: Pattern
    means: Text


class Names(CatalogModel):
    """All well-known names."""

    names: tuple[Name, ...]


@cache
def names() -> Names:
    """Return the table.

    Raises:
        ValueError: a file of the package is not what its model says; tests hold that none is.
    """
    return read_table("symptoms/names.yaml", Names)


def named_in(text: str, cell: Cell | None) -> tuple[str, ...]:
    """Return what the names of a text are, one line each, those of the cell first."""
    small = small_letters(text)
    of_cell = [] if cell is None else list(dict.fromkeys(_of_cell(text, cell)))
    so_far = " ".join(of_cell)
    known = [
        f"`{each.name}`: {each.means}"
        for each in names().names
        if re.search(each.says, small) and f"`{each.name}`" not in so_far
    ]
    return (*of_cell[:_OF_CELL], *known[:_WELL_KNOWN])


def _of_cell(text: str, cell: Cell) -> Iterator[str]:
    by_name = {interface.name: interface for interface in cell.interfaces}
    for match in _FULL_NAME.finditer(text):
        name = match[0]
        if name in by_name:
            yield _interface(by_name[name])
        elif _OF_TOPIC.search(text) and not _NO_TOPIC.match(name) and name.count("/") > 1:
            near = next((other for other in by_name if other.endswith(name.rsplit("/", 1)[-1])), None)
            hint = "" if near is None else f"; `{near}` ends alike"
            yield f"`{name}`: the contract of this cell has no such name{hint}"


def _interface(interface: Interface) -> str:
    first, second = ("from", "to") if interface.kind is InterfaceKind.TOPIC else ("served by", "client")
    ends = f"{first} {_nodes(interface.sources)}, {second} {_nodes(interface.sinks)}"
    return f"`{interface.name}`: {interface.kind} {interface.type}, {ends}, by the contract of this cell"


def _nodes(ends: Iterable[Endpoint]) -> str:
    return ", ".join(dict.fromkeys(end.node for end in ends)) or "none that is declared"
