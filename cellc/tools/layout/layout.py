"""One text into its canonical form, held against what it says.

The round trip of ruamel.yaml 0.19.1 is no replacement (tried 2026-11-24 on the 593 files that tests/layout formats):
19 had other words afterwards and 2 other comments. It drops a comment in braces, a comment above ``---`` and an
anchor without an alias, writes an empty value as ``null``, joins texts of several lines, and 10 of 28 results changed
once more.
"""

from __future__ import annotations

import re
from collections import Counter

from cellc.compiler.source.compose import compose
from cellc.compiler.source.document import Plain
from cellc.compiler.source.events import comments
from cellc.compiler.spec.quantity import spaced
from cellc.contract.diagnostics import Outcome
from cellc.tools.layout.order import put_in_order
from cellc.tools.layout.read import UnusualError, read_written
from cellc.tools.layout.write import write_written

_COMMENT = re.compile("#")


def formatted(name: str, text: str) -> Outcome[str]:
    """Return the canonical form of a file, or why it cannot be read.

    A legal text whose form is not written by hand (explicit keys, directives) stays as it is.

    Args:
        name: the file in findings.
        text: with line breaks as ``\\n`` and without byte order mark.
    """
    composed = compose(name, text)
    if composed.diagnostics or composed.value is None:
        return Outcome(None if composed.diagnostics else text, composed.diagnostics)
    try:
        tree = read_written(text)
    except UnusualError:
        return Outcome(text)
    put_in_order(tree.root, composed.value.data)
    result = write_written(tree)
    return Outcome(result if result == text or says_the_same(composed.value.data, text, result) else text)


def says_the_same(data: Plain, text: str, made: str) -> bool:
    """Whether every comment is there, and every value but for the spaces of quantities."""
    after = compose("", made).value
    return (
        after is not None
        and _unspaced(data) == _unspaced(after.data)
        and _comment_counts(text) == _comment_counts(made)
    )


def _comment_counts(text: str) -> Counter[str]:
    lines = dict[int, str]()
    for comment in comments(text, _COMMENT):
        lines.setdefault(comment.line, comment.text)
    return Counter(lines.values())


def _unspaced(data: object) -> object:
    """Return data in which quantities have the spaces of the canonical form."""
    if isinstance(data, dict):
        return {key: _unspaced(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_unspaced(value) for value in data]
    return spaced(data) if isinstance(data, str) else (type(data), repr(data))
