"""What was read: plain data, the text, and the position of every path."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.diagnostics import Span, YamlPath
from cellc.source.node import Child, Node
from cellc.source.plain import Plain


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
        child = self._child(path)
        if child is not None and child.key_span is not None:
            return child.key_span
        return self.locate(path)

    def has(self, path: YamlPath) -> bool:
        """Return whether the user wrote a value at ``path``; the root always exists."""
        return not path or self._child(path) is not None

    def text_at(self, path: YamlPath) -> str:
        """Return the scalar at ``path`` as written (``1e3``, ``0x1F``), quotes removed; empty for anything else."""
        child = self._child(path)
        return child.node.text if child is not None else ""

    def _child(self, path: YamlPath) -> Child | None:
        node, child = self.root, None
        for part in path:
            child = node.children.get(part)
            if child is None:
                return None
            node = child.node
        return child

    def _nearest(self, path: YamlPath) -> Child | None:
        node, found = self.root, None
        for part in path:
            child = node.children.get(part)
            if child is None:
                break
            node, found = child.node, child
        return found
