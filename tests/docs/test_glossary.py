"""The glossary holds every word of the closed lists, each term once, in the order of the alphabet."""

from __future__ import annotations

import re

from cellc.contract.diagnostics import Severity
from cellc.contract.vocabulary import AttemptOutcome, GateCode
from tests.cells import ROOT

TEXT = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
FIELD, OURS, LISTS = (part for part in TEXT.split("\n## ")[1:])


def _terms(part: str) -> list[str]:
    return re.findall(r"^- \*\*(.+?)\*\*: ", part, re.MULTILINE)


def test_closed_lists_are_whole() -> None:
    told = set(re.findall(r"`(\w+)`", LISTS))
    assert {str(word.value) for words in (Severity, AttemptOutcome, GateCode) for word in words} <= told


def test_terms_stand_in_order_and_once() -> None:
    for part in (FIELD, OURS):
        assert _terms(part) == sorted(_terms(part), key=str.lower)
    terms = _terms(FIELD) + _terms(OURS)
    assert len(terms) == len(set(terms)) > 50
