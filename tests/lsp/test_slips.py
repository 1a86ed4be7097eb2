"""One letter left out of every word of every cell: each finding that proposes a text has a fix, which ends it.

A session takes one word of thirty, others in each cell; with ``--long`` every word is taken.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from cellc.compiler.pipeline import check
from cellc.compiler.source import SourceDocument, read
from cellc.compiler.source.document import places
from cellc.contract.diagnostics import Span
from cellc.tools.edit.rewrite import Edit, apply_edits
from cellc.tools.lsp.remedies import word_in
from tests.cells import EVERY_CELL, spec_of, there
from tests.lsp.proposals import faults, proposing
from tests.sample import sample

_SHARE = 30
_WORD = re.compile(r"[A-Za-z_/][\w/]{2,}")
_FREE = {"owners", "kpis", "versions", "cell", "summary"}
"""Sections without names: numbers, people, and texts for people."""


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_slip_that_is_found_with_a_proposal_is_mended(cell: str, request: pytest.FixtureRequest) -> None:
    spec = spec_of(cell).as_posix()
    document = there(read(spec).value)
    before = {(one.code, one.message) for one in check(spec)}
    taken = sample(request, list(_slips(document)), _SHARE, lambda slip: f"{cell} {slip}")
    wrong, mended = [], 0
    for slip in taken:
        text = apply_edits(document.texts[spec], [slip])
        new = [one for one in proposing(check(spec, {spec: text})) if (one.code, one.message) not in before]
        slipped = there(read(spec, {spec: text}).value) if new else document
        wrong += [fault for one in new for fault in faults(one, slipped)]
        mended += len(new)
    assert wrong == []
    assert mended > len(taken) / 4


def _slips(document: SourceDocument) -> Iterator[Edit]:
    for span, word in dict.fromkeys(_words(document)):
        middle = len(word) // 2 + (word[len(word) // 2] == "/")
        yield Edit(
            span.file, span.line, span.column, span.end_column, word[:middle] + word[middle + 1 :], "a letter less"
        )


def _words(document: SourceDocument) -> Iterator[tuple[Span, str]]:
    for path, child in places(document.root):
        if len(path) == 1 or path[0] not in _FREE:
            text = "" if child.node.is_collection else child.node.text
            for span, word in ((child.key_span, str(path[-1])), (child.span, text)):
                place = word_in(span, word, document.texts) if span is not None and _WORD.fullmatch(word) else None
                if place is not None:
                    yield place, word
