"""What is at a place of a text: the path of a value or a key, also in a text that is being written."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from cellc.compiler.source.compose import compose
from cellc.compiler.source.document import Node, Plain, places
from cellc.contract.diagnostics import Span, YamlPath

MARK = "cellc__here"
"""Represents what is being written while the text around it is read."""

_WORD = re.compile(r"[^\s,{}\[\]:#\"']*$")
_REST = re.compile(r"[^\s,{}\[\]:#\"']*")
_CLOSING = {"{": "}", "[": "]"}


@dataclass(frozen=True, slots=True)
class Here:
    """What is at a place.

    Args:
        path: of the value, or of the key.
        is_key: whether the key of ``path`` is meant.
        span: the scalar, or the key.
        text: the scalar or key as plain text.
    """

    path: YamlPath
    is_key: bool
    span: Span
    text: str


def here(root: Node, line: int, column: int) -> Here | None:
    """Return the key or scalar at a place, counted from 1; None between them."""
    for path, child in places(root):
        key = child.key_span
        if key is not None and _within(key, line, column):
            return Here(path, True, key, str(path[-1]))
        if not child.node.is_collection and _within(child.span, line, column):
            return Here(path, False, child.span, child.node.text)
    return None


def _within(span: Span, line: int, column: int) -> bool:
    return (span.line, span.column) <= (line, column) <= (span.end_line, span.end_column)


@dataclass(frozen=True, slots=True)
class Typed:
    """The key or value that is being typed at a position.

    Args:
        path: of the mapping for a key, of the value for a value.
        is_key: whether a key is being written.
        word: what is there so far, up to the place.
        data: of the file, with the mark in the place of the word.
    """

    path: YamlPath
    is_key: bool
    word: str
    data: Plain


def word_before(text: str, line: int, column: int) -> str:
    """Return what is written of a word up to a place, which a completion replaces."""
    lines = text.split("\n")
    match = _WORD.search(lines[line - 1][: column - 1]) if 1 <= line <= len(lines) else None
    return match[0] if match is not None else ""


def typed_at(text: str, line: int, column: int) -> list[Typed]:
    """Return what may be being typed at a position, counted from 1; empty where the text around it cannot be parsed."""
    lines = text.split("\n")
    if not 1 <= line <= len(lines):
        return []
    before, after = lines[line - 1][: column - 1], lines[line - 1][column - 1 :]
    match = _WORD.search(before)
    word = match[0] if match is not None else ""
    head = before[: len(before) - len(word)]
    rest = _REST.sub("", after, count=1)
    typed: dict[tuple[YamlPath, bool], Typed] = {}
    for guess in _guesses(head, rest):
        composed = compose("", "\n".join((*lines[: line - 1], guess, *lines[line:])))
        if composed.value is not None and not composed.diagnostics:
            marked = _marked(composed.value)
            if marked is not None:
                typed.setdefault(marked, Typed(*marked, word, composed.value.data))
    return list(typed.values())


def _guesses(kept: str, rest: str) -> Iterator[str]:
    """Yield the line with the mark, as a key and as a value, with its rest and without, braces closed."""
    opened = [text for text in kept if text in "{["]
    for text in kept:
        if text in "}]" and opened:
            opened.pop()
    closing = "".join(_CLOSING[text] for text in reversed(opened))
    is_value = kept.rstrip().endswith((":", "-", "[")) or (bool(opened) and opened[-1] == "[")
    pairs = (MARK, f"{MARK}: 0") if is_value else (f"{MARK}: 0", MARK)
    for mark in pairs:
        if not rest.lstrip().startswith(":"):
            yield f"{kept}{mark}{rest}"
        yield f"{kept}{mark}{closing}"


def _marked(root: Node) -> tuple[YamlPath, bool] | None:
    if root.data == MARK:
        return (), True
    for path, child in places(root):
        if path[-1] == MARK:
            return path[:-1], True
        if child.node.data == MARK:
            return path, False
    return None
