"""One value of a YAML document together with the places that wrote it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cellc.diagnostics import Span
from cellc.source.plain import Plain


@dataclass(frozen=True, slots=True)
class Node:
    """A scalar, list or mapping; aliases share the node of their anchor.

    Args:
        span: where it is written. A collection in block style is marked at its first key or dash.
        data: the plain value, aliases expanded.
        text: a scalar as written, quotes and escapes resolved; empty for a collection.
        children: by key or index, in the order of the file.
        size: number of values in it with all aliases written out, itself included.
        height: levels of nesting, 1 for a scalar.
    """

    span: Span
    data: Plain
    text: str = ""
    children: Mapping[str | int, Child] = field(default_factory=dict)
    size: int = 1
    height: int = 1

    @property
    def is_collection(self) -> bool:
        """Whether it is a list or a mapping."""
        return isinstance(self.data, (list, dict))


@dataclass(frozen=True, slots=True)
class Child:
    """A node in its place.

    Args:
        span: the value here; where the value is an alias, the alias.
        key_span: the key, or None in a list.
    """

    node: Node
    span: Span
    key_span: Span | None

    @property
    def place(self) -> Span:
        """What a finding about this value marks: a scalar itself, else the key, else the start of the collection."""
        is_written = self.span.column < self.span.end_column or self.span.line < self.span.end_line
        if self.key_span is not None and (self.node.is_collection or not is_written):
            return self.key_span
        return self.span
