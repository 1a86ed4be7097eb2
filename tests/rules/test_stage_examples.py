"""Every code of the spec and of its links shows an example, which is reported where it is marked and nowhere else."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.diagnostics.diagnostic import CodePage
from cellc.report.pages import STAGES, render_page
from tests.rules.examples import Example, Place, matches, places

PAGES = [*STAGES["spec"], *STAGES["link"]]
# The first takes two controller managers, of the second the catalog has no kind that a distribution lacks, and an empty
# value is lost where an example is merged into the complete cell.
WITHOUT = {"ambiguous-node", "controller-not-in-distro", "empty-value"}


def test_every_code_of_spec_and_links_has_an_example() -> None:
    assert {page.code for page in PAGES if not page.example} == WITHOUT


@pytest.mark.parametrize("page", [page for page in PAGES if page.example], ids=lambda page: page.code)
def test_example_of_a_stage_is_reported_at_its_mark_and_nowhere_else(page: CodePage, tmp_path: Path) -> None:
    example = Example("yaml", page.example.lstrip("\n"))
    lines = enumerate(example.text.splitlines(), start=1)
    marked = [(number, mark[1]) for number, line in lines if (mark := re.search("# expect at (.+)", line))]
    expected = [Place(page.code, number, key) for number, key in marked]
    found = places(example, tmp_path)
    assert len(found) == len(expected) > 0
    assert all(matches(one, wanted) for one, wanted in zip(found, expected, strict=True)), found


def test_marks_of_an_example_are_not_shown() -> None:
    assert [page.code for page in PAGES if "expect at" in render_page(page)] == []
