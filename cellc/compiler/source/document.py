"""What was read: plain data, the text, and the position of every path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from typing import TypeAlias, Union

from cellc.contract.diagnostics import Fix, Span, YamlPath
from cellc.contract.frozen import dataclass

PlainScalar: TypeAlias = Union[bool, int, float, str, None]

Plain: TypeAlias = Union[bool, int, float, str, list["Plain"], dict[str, "Plain"], None]
"""What YAML 1.2 core can say; every mapping has string keys."""

MAX_FINDINGS = 100
"""After so many findings in one file it is not a spec with mistakes, and reading stops."""


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

    def with_node(self, node: Node) -> Child:
        """Return another value in the same place."""
        return replace(self, node=node)

    @property
    def place(self) -> Span:
        """What a finding about this value marks: a scalar itself, else the key, else the start of the collection."""
        is_written = self.span.column < self.span.end_column or self.span.line < self.span.end_line
        if self.key_span is not None and (self.node.is_collection or not is_written):
            return self.key_span
        return self.span


@dataclass(frozen=True, slots=True)
class SourceDocument:
    """A spec with its includes merged in.

    Args:
        file: the root spec as the user named it.
        texts: every file that was read, by the name that spans carry, with line breaks as ``\\n``.
        root: the merged document; each node keeps its place in the file that wrote it.
    """

    file: str
    texts: Mapping[str, str]
    root: Node

    @property
    def data(self) -> Plain:
        """The values alone, without ``include``; to be read, never changed, because aliases share them."""
        return self.root.data

    def locate(self, path: YamlPath) -> Span:
        """Return where the value of ``path`` is written.

        A list or mapping is marked at its key. A path that does not exist is marked at its nearest existing ancestor;
        the root is the start of line 1.
        """
        child = self._nearest(path)
        return child.place if child is not None else Span(self.file, 1, 1, 1, 1)

    def locate_key(self, path: YamlPath) -> Span:
        """Return where the key of ``path`` is written; for an item of a list or a missing path, as `locate`."""
        child = self.child(path)
        if child is not None and child.key_span is not None:
            return child.key_span
        return self.locate(path)

    def has(self, path: YamlPath) -> bool:
        """Return whether the user wrote a value at ``path``; the root always exists."""
        return not path or self.child(path) is not None

    def text_at(self, path: YamlPath) -> str:
        """Return the scalar at ``path`` as written (``1e3``, ``0x1F``), quotes removed; empty for anything else."""
        child = self.child(path)
        return child.node.text if child is not None else ""

    def child(self, path: YamlPath) -> Child | None:
        """Return the value at a path in its place; None for the root and a path that does not exist."""
        node, child = self.root, None
        for part in path:
            child = node.children.get(part)
            if child is None:
                return None
            node = child.node
        return child

    def below(self, path: YamlPath) -> Iterator[tuple[YamlPath, Child]]:
        """Yield all that is written below a path with its own path, outer ones first; nothing for a missing one."""
        child = self.child(path)
        if child is not None or not path:
            yield from places(self.root if child is None else child.node, path)

    def fix(self, span: Span, written: str, text: str | None, *, sure: bool) -> Fix | None:
        """Return the edit of a text at the end of a span, quotes apart; None where it is not there as it is."""
        lines = self.texts.get(span.file, "").split("\n")
        if not text or span.line != span.end_line or span.line > len(lines):
            return None
        held = lines[span.line - 1][span.column - 1 : span.end_column - 1].rstrip("\"'")
        before = held[: len(held) - len(written)]
        if not held.endswith(written) or before.strip("\"' ,.0123456789+-eE"):
            return None
        start = span.column + len(before)
        return Fix(Span(span.file, span.line, start, span.line, start + len(written)), written, text, sure)

    def without(self, path: YamlPath) -> SourceDocument:
        """Return the same without the value of a path that exists; what is behind it in a list moves up."""
        return replace(self, root=_changed(self.root, path, None))

    def renamed(self, path: YamlPath, key: str) -> SourceDocument:
        """Return the same with another key for the value of a path that exists; places stay."""
        return replace(self, root=_renamed(self.root, path, key))

    def with_text(self, path: YamlPath, text: str) -> SourceDocument:
        """Return the same with another scalar at a path that exists; places stay."""
        child = self.child(path)
        if child is None:
            return self
        scalar = replace(child, node=replace(child.node, data=text, text=text))
        return replace(self, root=_changed(self.root, path, scalar))

    def with_value(self, key: str, value: Plain) -> SourceDocument:
        """Return the same with a section that was not written; its values are marked where the document begins."""
        node = Node(self.root.span, value)
        return replace(self, root=_changed(self.root, (key,), Child(node, node.span, None)))

    def with_child(self, path: YamlPath, child: Child | None, texts: Mapping[str, str]) -> SourceDocument:
        """Return the same with what another document has at a path, or without what is there; what holds it exists.

        Args:
            texts: of the files of the other document.
        """
        return replace(self, root=_changed(self.root, path, child), texts={**texts, **self.texts})

    def with_root(self, root: Node) -> SourceDocument:
        """Return the same with other values."""
        return replace(self, root=root)

    def _nearest(self, path: YamlPath) -> Child | None:
        node, found = self.root, None
        for part in path:
            child = node.children.get(part)
            if child is None:
                break
            node, found = child.node, child
        return found


def places(node: Node, path: YamlPath = ()) -> Iterator[tuple[YamlPath, Child]]:
    """Yield every child below a node with its path, outer ones first."""
    for part, child in node.children.items():
        yield (*path, part), child
        yield from places(child.node, (*path, part))


def rebuilt(node: Node, children: Mapping[str | int, Child], text: str = "") -> Node:
    """Return a collection with other children, or a scalar with another text."""
    if isinstance(node.data, list):
        listed = list(children.values())
        return replace(node, data=[child.node.data for child in listed], children=dict(enumerate(listed)))
    if isinstance(node.data, dict):
        return replace(node, data={str(key): child.node.data for key, child in children.items()}, children=children)
    return replace(node, data=text, text=text)


def _changed(node: Node, path: YamlPath, child: Child | None) -> Node:
    """Return a collection with another child at a path, or without the one there."""
    first, rest = path[0], path[1:]
    if rest:
        held = node.children[first]
        child = held.with_node(_changed(held.node, rest, child))
    return rebuilt(
        node,
        {key: changed for key, changed in {**node.children, first: child}.items() if changed is not None},
    )


def _renamed(node: Node, path: YamlPath, key: str) -> Node:
    """Return a mapping with another key at the end of a path, in its order."""
    first, rest = path[0], path[1:]
    held = node.children[first]
    if rest:
        return rebuilt(node, {**node.children, first: held.with_node(_renamed(held.node, rest, key))})
    return rebuilt(node, {key if each == first else each: child for each, child in node.children.items()})
