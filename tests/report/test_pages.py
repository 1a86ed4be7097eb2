"""The documents of all codes say what the commands say, and are the ones that are committed."""

from __future__ import annotations

import re
from pathlib import Path

from cellc.compiler.pages import all_pages, render_handbook, render_page
from cellc.compiler.rules.kit import FAMILIES
from cellc.compiler.rules.run import ALL_RULES
from tests.cli.run import run

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "rules"


def headings(text: str) -> set[str]:
    """Return the anchors that GitHub and mkdocs give to the headings of a page."""
    return {
        re.sub(r"[^\w -]", "", line).strip().lower().replace(" ", "-") for line in re.findall(r"^#+ (.+)$", text, re.M)
    }


def test_committed_documents_are_the_ones_of_the_pages() -> None:
    written = {file.name: file.read_text(encoding="utf-8") for file in FOLDER.iterdir()}
    assert written == render_handbook(), "run `cellc explain --all -o docs/rules` and commit it"


def test_every_page_stands_in_one_document_word_for_word_but_for_links() -> None:
    files = render_handbook()
    unlinked = [re.sub(r"\[(\w+\.md(?:#[\w-]+)?)\]\([^)]*\)", r"docs/\1", text) for text in files.values()]
    for page in all_pages().values():
        assert sum(render_page(page) in text for text in unlinked) == 1, page.code


def test_index_names_every_code_and_links_to_its_heading() -> None:
    files = render_handbook()
    links = re.findall(r"^\| \[([\w-]+)\]\(([\w.]+)#([\w-]+)\)", files["README.md"], re.M)
    assert sorted(code for code, *_ in links) == sorted(all_pages())  # each once: one stage or rule declares it
    for _, file, anchor in links:
        assert anchor in headings(files[file])


def test_links_to_our_own_pages_lead_to_a_heading() -> None:
    for text in render_handbook().values():
        for file, anchor in re.findall(r"\]\(\.\./(\w+\.md)#([\w-]+)\)", text):
            assert anchor in headings((FOLDER.parent / file).read_text(encoding="utf-8")), anchor


def test_titles_use_the_article_that_is_spoken() -> None:
    assert [page.title for page in all_pages().values() if re.search(r"\ba [aeio]", page.title)] == []


def test_all_rules_of_a_family_stand_in_its_document() -> None:
    for folder, family in FAMILIES.items():
        codes = re.findall(r"^## ([\w-]+) \(", render_handbook()[f"{folder}.md"], re.M)
        assert codes == sorted(rule.code for rule in ALL_RULES if rule.family == family)


def test_command_writes_the_documents(tmp_path: Path) -> None:
    folder = tmp_path / "docs" / "rules"
    assert run("explain", "--all", "-o", folder.as_posix()).code == 0
    assert {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir()} == render_handbook()
    assert run("explain", "reversed-limits", "-o", folder.as_posix()).code == 2
