"""The page that maps requirements to codes and files names what exists, and leaves nothing out."""

from __future__ import annotations

import re
from difflib import get_close_matches

import pytest

from cellc.compiler.rules.run import ALL_RULES
from cellc.contract.codes import STAGES
from tests.cells import ROOT, built
from tests.coverage.sentences import expand, units

DESIGN = ROOT.parent / "shared" / "design"
CHECKS = DESIGN / "checks.md"
CHAPTER = DESIGN / "chapter-4.txt"
PAGE = (ROOT / "docs" / "coverage.md").read_text(encoding="utf-8")
ROWS = [line.strip("| ").split(" | ") for line in PAGE.splitlines() if line.startswith("| ")]
NAMED = set(re.findall(r"`([^`]+)`", "\n".join(row[-1] for row in ROWS)))
RULE_CODES = {rule.code for rule in ALL_RULES}


def test_every_code_that_is_named_exists() -> None:
    stages = {code for stage in ("catalog", "fleet", "link", "source", "spec") for code in STAGES[stage]}
    codes = {name for name in NAMED if re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)+", name)}
    assert codes <= RULE_CODES | stages


def test_every_rule_is_named() -> None:
    assert RULE_CODES <= NAMED


def test_every_file_that_is_named_is_emitted() -> None:
    files = {name for name in NAMED if re.search(r"[./]", name)}
    assert files
    assert files <= set(built("ur5e_pick").texts)


def test_every_requirement_says_what_holds_it() -> None:
    for row in ROWS:
        assert row[-1].startswith("**") or row[0].startswith("**") or all(row), row


@pytest.mark.skipif(not CHECKS.exists(), reason="the list of checks is not beside the checkout")
def test_every_row_of_the_list_of_checks_is_mapped() -> None:
    rows = [
        line.strip("| ").rsplit(" | ", 1)
        for line in CHECKS.read_text(encoding="utf-8").splitlines()
        if line.startswith("| ")
    ]
    wrong = [row[0] for row in rows if row[0] != "what is wrong"]
    assert len(wrong) > 60
    # The page says it in our own words and spelling: the nearest row is meant, and no row is meant twice.
    nearest = {text: _nearest(text) for text in wrong}
    assert [text for text, row in nearest.items() if row is None] == []
    assert len(set(nearest.values())) == len(set(wrong))


def _nearest(text: str) -> str | None:
    near = get_close_matches(text, [row[0] for row in ROWS], n=1, cutoff=0.9)
    return near[0] if near else None


@pytest.mark.skipif(not CHAPTER.exists(), reason="the chapter is not beside the checkout")
def test_every_unit_of_the_chapter_is_mapped_or_listed_as_demanding_nothing() -> None:
    table, _, nothing = PAGE.partition("## The chapter")[2].partition("Units that describe")
    mapped = {unit for where in re.findall(r"^\| (\d[^|]*) \|", table, re.M) for unit in expand(where)}
    listed = {unit for where in re.findall(r"^- (.+)$", nothing, re.M) for unit in expand(where)}
    assert mapped | listed == set(units(CHAPTER))
    assert not mapped & listed
