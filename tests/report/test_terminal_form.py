"""Documents at a terminal: nothing is wider than it, and nothing of them is lost."""

from __future__ import annotations

import re

import pytest

from cellc.tools.browse.page import page
from cellc.tools.report.terminal_form import terminal_form
from tests.cells import built, device_of


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W_]+", text.replace("<br>", " "))


@pytest.mark.parametrize("wide", [60, 80, 120])
@pytest.mark.parametrize("name", ["audit", "ur5e", "robotiq_2f_85"])
def test_no_line_is_wider_and_no_word_is_lost(name: str, wide: int) -> None:
    text = built("ur5e_pick").texts["audit.md"] if name == "audit" else page(device_of(name))
    assert max(map(len, text.splitlines())) > 300
    lines = list(terminal_form(text, wide))
    whole = [line for line in lines if " " in line.strip()]  # a name that is longer stays whole or is cut
    assert max(map(len, whole)) <= wide
    body = re.sub(r"^\|.*\n(?=\|---)", "", text, flags=re.MULTILINE)  # a column without a value has no name
    assert set(_words(body)) - set(_words("".join(line.strip() + " " for line in lines))) <= _cut(text, wide)


def _cut(text: str, wide: int) -> set[str]:
    """Words of texts without a blank that are wider than the terminal."""
    return {word for long in text.split() if len(long) > wide - 10 for word in _words(long)}


def test_narrow_table_keeps_its_columns_and_a_wide_one_is_a_list() -> None:
    table = "| part | says |\n|---|---|\n| arm | a \\| b |\n| gripper | c<br>d |\n"
    assert list(terminal_form(table, 80)) == ["part     says", "arm      a | b", "gripper  c; d"]
    long = table.replace("a ", "one two three four five six seven eight nine ")
    assert list(terminal_form(long, 40)) == [
        "part: arm",
        "    says: one two three four five six",
        "      seven eight nine | b",
        "part: gripper",
        "    says: c; d",
    ]


def test_text_in_a_fence_is_left_as_it_is() -> None:
    fence = "```yaml\n" + "a: " + "b " * 60 + "\n| no | table |\n```"
    assert list(terminal_form(fence, 40)) == fence.split("\n")
