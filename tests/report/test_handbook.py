"""The document of all codes says what the commands say, and is the one that is committed."""

from __future__ import annotations

import re
from pathlib import Path

from cellc.report.handbook import render_handbook
from cellc.report.pages import all_pages, render_page
from cellc.rules.run import ALL_RULES
from tests.cli.run import run

ROOT = Path(__file__).resolve().parents[2]


def test_committed_document_is_the_one_of_the_pages() -> None:
    written = (ROOT / "docs/rules.md").read_text(encoding="utf-8")
    assert written == render_handbook(), "run `cellc explain --all -o docs/rules.md` and commit it"


def test_every_page_stands_in_the_document_word_for_word() -> None:
    text = render_handbook()
    for page in all_pages().values():
        assert render_page(page) in text


def test_index_names_every_code_and_links_to_its_heading() -> None:
    text = render_handbook()
    headings = {re.sub(r"[^\w -]", "", line).strip().replace(" ", "-") for line in re.findall(r"^## (.+)$", text, re.M)}
    links = re.findall(r"^\| \[([\w-]+)\]\(#([\w-]+)\)", text, re.M)
    assert sorted(code for code, _ in links) == sorted(all_pages())  # each once: one stage or rule declares it
    assert {anchor for _, anchor in links} <= headings


def test_titles_use_the_article_that_is_spoken() -> None:
    assert [page.title for page in all_pages().values() if re.search(r"\ba [aeio]", page.title)] == []


def test_all_rules_of_a_family_stand_under_it() -> None:
    section = render_handbook().split("## FRM: frames\n")[1].split("\n## ")[0]
    assert set(re.findall(r"\[([\w-]+)\]", section)) == {rule.code for rule in ALL_RULES if rule.family == "FRM"}


def test_command_writes_the_document(tmp_path: Path) -> None:
    file = tmp_path / "docs/rules.md"
    assert run("explain", "--all", "-o", file.as_posix()).code == 0
    assert file.read_text(encoding="utf-8") == render_handbook()
    assert run("explain", "reversed-limits", "-o", file.as_posix()).code == 2
