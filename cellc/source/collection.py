"""A list or mapping whose end has not been reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import yaml

from cellc.diagnostics import Span
from cellc.source.marks import event_span, flow_span
from cellc.source.node import Child, Node
from cellc.source.plain import Plain


@dataclass(frozen=True, slots=True)
class Key:
    """A key that waits for its value; ``name`` is None where the key was refused and its value is dropped."""

    name: str | None
    span: Span


@dataclass(slots=True)
class OpenCollection:
    """What is known of a collection between its start and its end."""

    start: yaml.CollectionStartEvent
    is_mapping: bool
    key: Key | None = None
    children: dict[str | int, Child] = field(default_factory=dict)
    size: int = 1
    height: int = 0

    @property
    def expects_key(self) -> bool:
        """Whether the next value is a key."""
        return self.is_mapping and self.key is None

    @property
    def position(self) -> str | int | None:
        """The key or index at which the next value will stand, None before or after a refused key."""
        if not self.is_mapping:
            return len(self.children)
        return self.key.name if self.key is not None else None

    def put(self, node: Node, span: Span) -> None:
        """Take the next value, written at ``span``."""
        position = self.position
        key_span = self.key.span if self.key is not None else None
        if position is not None:
            self.children[position] = Child(node, span, key_span)
        self.key = None
        self.size += node.size
        self.height = max(self.height, node.height)

    def close(self, end: yaml.Event, file: str, lines: Sequence[str]) -> Node:
        """Return the complete node."""
        span = flow_span(self.start, end, file) or self._first_span(file, lines)
        data: Plain
        if self.is_mapping:
            data = {str(name): child.node.data for name, child in self.children.items()}
        else:
            data = [child.node.data for child in self.children.values()]
        return Node(span, data, "", self.children, self.size, self.height + 1)

    def _first_span(self, file: str, lines: Sequence[str]) -> Span:
        first = next(iter(self.children.values()), None)
        if first is not None and first.key_span is not None and not self.start.flow_style:
            return first.key_span
        return event_span(self.start, file, lines)
