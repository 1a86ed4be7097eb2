"""What differs between two states of a spec: values, and parts that one side alone has, each with its place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cellc.compiler.source.document import Child, Node, SourceDocument
from cellc.contract.diagnostics import Span, YamlPath
from cellc.tools.review.renames import named_in


@dataclass(frozen=True, slots=True)
class SpecEdit:
    """A value of a spec that is another one, new or gone."""

    path: YamlPath
    before: Child | None
    after: Child | None

    @property
    def place(self) -> Span:
        """Where it is written now, else where it was."""
        child = self.after or self.before
        assert child is not None  # one of them differs from the other
        return child.key_span or child.span


def spec_edits(before: SourceDocument, after: SourceDocument) -> tuple[SpecEdit, ...]:
    """Return what differs, in the order of the file; comments and the order of keys do not."""
    return tuple(_differences(before.root, after.root, ()))


def with_edits(document: SourceDocument, edits: Sequence[SpecEdit], other: SourceDocument) -> SourceDocument:
    """Return a document in which some of the edits are made that lead to another."""
    for edit in edits:
        document = document.with_child(edit.path, edit.after, other.texts)
    return document


def undone(edits: Sequence[SpecEdit]) -> tuple[SpecEdit, ...]:
    """Return the edits that lead back."""
    return tuple(SpecEdit(edit.path, edit.after, edit.before) for edit in reversed(edits))


def _differences(before: Node, after: Node, path: YamlPath) -> Iterator[SpecEdit]:
    for key in dict.fromkeys((*after.children, *before.children)):
        was, now = before.children.get(key), after.children.get(key)
        if was is not None and now is not None and _have_parts(was.node, now.node, (*path, key)):
            yield from _differences(was.node, now.node, (*path, key))
        elif was is None or now is None or was.node.data != now.node.data:
            yield SpecEdit((*path, key), was, now)


def _have_parts(before: Node, after: Node, path: YamlPath) -> bool:
    """Whether two values are compared part by part: a list that grew is one value, and so is another alternative."""
    if isinstance(before.data, list) and isinstance(after.data, list):
        return len(before.data) == len(after.data) and all(isinstance(entry, dict) for entry in before.data)
    if not isinstance(before.data, dict) or not isinstance(after.data, dict):
        return False
    is_other = bool(before.data) and bool(after.data) and before.data.keys().isdisjoint(after.data)
    return not is_other or named_in(path) is not None
