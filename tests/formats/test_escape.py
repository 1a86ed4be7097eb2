"""Text as each format takes it for text alone, read back by parsers that are not ours or by public grammars."""

from __future__ import annotations

import re

import pytest
from markdown_it import MarkdownIt

from cellc.compiler.formats.escape import code, markdown

_PAGES = MarkdownIt("commonmark").enable(["table", "strikethrough"])


@pytest.mark.parametrize(
    "text", ["__b__", "a__b", "_a_", "~~c~~", "*d*", "[e](f)", "<g>", "&amp;", "# h", "- i", "1. j", "\\", "a \\| b"]
)
def test_markdown_shows_a_text_as_it_is(text: str) -> None:
    assert _PAGES.render(f"x\n\n{markdown(text)}") == f"<p>x</p>\n<p>{_html(text)}</p>\n"


def test_a_dollar_begins_no_formula_on_a_page_of_github() -> None:
    # GitHub Docs, "Writing mathematical expressions": a backslash before a dollar sign shows the sign.
    assert markdown("costs $1 or $2") == "costs \\$1 or \\$2"


@pytest.mark.parametrize("text", ["a", "a ` b", "`a`", "``", "a `` b ` c"])
def test_code_holds_backticks_and_stays_code_within_prose(text: str) -> None:
    assert _PAGES.render(markdown(f"x {code(text)} y")) == f"<p>x <code>{text}</code> y</p>\n"


def test_a_backslash_before_a_bar_does_not_end_a_cell_of_a_table() -> None:
    cell = markdown(code("a\\| b")).replace("|", "\\|")
    cells = re.findall("<td>(.*?)</td>", _PAGES.render(f"| x | y |\n|---|---|\n| {cell} | z |"))
    assert cells == ["a\\| b", "z"]


def _html(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
