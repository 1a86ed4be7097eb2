"""Misspelt keys of which only one existing key is near."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import takewhile

from cellc.diagnostics import Diagnostic, only_suggestion
from cellc.edit.edit import Edit
from cellc.source.document import SourceDocument

_SEPARATORS = str.maketrans("", "", "-_ ")


def misspelt_keys(diagnostics: Iterable[Diagnostic], document: SourceDocument) -> Iterator[Edit]:
    """Yield the edit of each unknown key that can mean only one thing, and that does not stand there already."""
    unknown = [found for found in diagnostics if found.code == "unknown-key" and found.yaml_path]
    # An alias brings one line into several places, where its key may mean different things.
    times = Counter(found.span for found in unknown)
    taken = set()
    for found in unknown:
        meant = only_suggestion(found.help)
        if meant is None or times[found.span] > 1:
            continue
        key, place = str(found.yaml_path[-1]), (*found.yaml_path[:-1], meant)
        if document.has(place) or place in taken or not _is_safe(key, meant, found, document):
            continue
        taken.add(place)
        span = found.span
        yield Edit(span.file, span.line, span.column, span.end_column, meant, f"`{key}` becomes `{meant}`")


def _is_safe(key: str, meant: str, found: Diagnostic, document: SourceDocument) -> bool:
    """Whether the span holds the bare key itself, one slip away from what is meant."""
    span = found.span
    lines = document.texts.get(span.file, "").split("\n")
    if span.line != span.end_line or span.line > len(lines):
        return False
    written = lines[span.line - 1][span.column - 1 : span.end_column - 1]
    return written == key and _is_slip(key, meant)


def _is_slip(key: str, meant: str) -> bool:
    """Whether one slip of the fingers lies between two keys; a suggestion may be further, but a person reads that.

    A slip is one character too many, too few, wrong, or swapped with its neighbour; or another way to join words.
    """
    if key.lower().translate(_SEPARATORS) == meant.lower().translate(_SEPARATORS):
        return True
    start = _common_start(key, meant)
    end = _common_start(key[start:][::-1], meant[start:][::-1])
    ours, theirs = key[start : len(key) - end], meant[start : len(meant) - end]
    return max(len(ours), len(theirs)) == 1 or (len(ours) == len(theirs) == 2 and ours == theirs[::-1])


def _common_start(ours: str, theirs: str) -> int:
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(ours, theirs, strict=False)))
