"""A YAML text as a tree of what is written: scalars as they stand, with every comment beside what it belongs to.

A comment belongs to the value before it on its line; on a line of its own, to the key or item below it, unless it
is as deep as the collection that ends above it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Union


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment with the column, from 0, in which its author put it."""

    column: int
    text: str


@dataclass(slots=True)
class Scalar:
    """A scalar or an alias as written.

    Args:
        lines: the text with its quotes and anchor; further lines of it without their indentation.
        block: the lines below the header of a block scalar, with their indentation; None for any other scalar.
        depth: column, from 0, that a block is indented against.
    """

    lines: tuple[str, ...]
    block: tuple[str, ...] | None = None
    depth: int = 0


@dataclass(slots=True)
class Collection:
    """A mapping or a list.

    Args:
        anchor: with its ``&`` and a space behind it, or empty.
        flow: whether it is in braces or brackets.
        bare: a mapping of one pair in a list in brackets, which needs no braces.
        below: comments on own lines after the last entry, and empty lines between them as "".
    """

    is_mapping: bool
    anchor: str = ""
    flow: bool = False
    bare: bool = False
    entries: list[Entry] = field(default_factory=list)
    below: list[str] = field(default_factory=list)


Value = Union[Scalar, Collection]


@dataclass(slots=True)
class Entry:
    """A key with its value, or an item of a list.

    Args:
        key: as written; None in a list.
        above: comments on own lines before it, and one empty line as "".
        beside: the comment on the line of the key, or where the value ends on that line, behind the value.
        broken: whether the value begins on a line below the key.
        opens: whether it begins a line, within braces.
    """

    key: str | None
    value: Value
    above: list[str] = field(default_factory=list)
    beside: Comment | None = None
    broken: bool = False
    opens: bool = False


@dataclass(slots=True)
class Written:
    """A whole file.

    Args:
        head: comments and the mark of a document before the first value, and empty lines between them as "".
    """

    head: list[str]
    root: Value
    beside: Comment | None = None


def plain(key: str) -> str:
    """Return a key without its quotes."""
    return key[1:-1] if key[:1] in ("'", '"') else key


def names(value: Value) -> Iterator[str]:
    """Yield every name that a value gives as an anchor, or takes as an alias."""
    if isinstance(value, Scalar):
        if value.lines[0][:1] in ("&", "*"):
            yield value.lines[0][1:].partition(" ")[0]
        return
    if value.anchor:
        yield value.anchor[1:-1]
    for entry in value.entries:
        yield from names(entry.value)
