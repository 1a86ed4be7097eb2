"""A line on a terminal is no wider than the terminal, and loses nothing."""

from __future__ import annotations

import re

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from cellc.contract.diagnostics.wording import aligned
from cellc.contract.folding import cells
from cellc.contract.printing import Style, Styled, as_text
from tests.printing.payloads import PAYLOADS, harm, without_colour


def _folded(*pieces: str | Styled, wide: int, color: bool = False) -> list[str]:
    return as_text([pieces], color=color, wide=wide).removesuffix("\n").split("\n")


@pytest.mark.parametrize(
    ("line", "folded"),
    [
        ("help: write the id of the last run", ["help: write the id of", "  the last run"]),
        ("  - one two three four five", ["  - one two three four", "    five"]),
        ("  ok    one two three four five", ["  ok    one two three", "        four five"]),
        ("the tip moves about 8 mm", ["the tip moves about", "  8 mm"]),
        ("read it with `cellc show FILE`", ["read it with", "  `cellc show FILE`"]),
        ("name      a_word_of_20_letters x", ["name", "  a_word_of_20_letters", "  x"]),
        ("one two three four ::five six", ["one two three four ::five", "  six"]),  # a runner would obey `::five`
        ("short", ["short"]),
        ("/arm/follow_joint_trajectory_of_one", ["/arm/follow_joint_trajectory_of_one"]),
        ("", [""]),
    ],
)
def test_what_is_too_wide_goes_on_below_itself(line: str, folded: list[str]) -> None:
    assert _folded(line, wide=22) == folded


def test_a_file_has_no_end_of_a_line() -> None:
    assert _folded("word " * 100, wide=0) == ["word " * 100]


def test_a_wide_character_takes_two_cells() -> None:
    assert _folded("ab 漢字 漢字", wide=8) == ["ab 漢字", "  漢字"]


def test_a_style_goes_on_with_its_text() -> None:
    lines = _folded(Styled("error", Style.RED), Styled(": one two three", Style.BOLD), wide=13, color=True)
    assert lines == ["\x1b[1;31merror\x1b[0m\x1b[1m: one\x1b[0m", "  \x1b[1mtwo three\x1b[0m"]


@given(st.lists(st.text(alphabet="ab:`漢é -.1", max_size=12), max_size=12), st.integers(40, 120))
def test_no_line_is_wider_unless_it_is_one_word_and_nothing_is_lost(words: list[str], wide: int) -> None:
    text = " ".join(words)
    assume("::" not in text)  # a word of two colons stays where it is, above
    lines = _folded(text, wide=wide)
    assert "".join("".join(lines).split()) == "".join("".join(_folded(text, wide=0)).split())
    for line in lines:
        assert cells(line) <= wide or re.fullmatch(r" *(\S|`[^`]*`|(?<=\d) )+", line) is not None


@pytest.mark.parametrize("text", PAYLOADS.values(), ids=PAYLOADS.keys())
@pytest.mark.parametrize("before", range(30, 45))
def test_no_line_that_goes_on_is_a_command_to_a_runner(before: int, text: str) -> None:
    lines = _folded("x" * before, " ", Styled(text, Style.RED), " ::error::forged", wide=40, color=True)
    assert harm(without_colour("\n".join(lines))) == []


def test_long_names_of_a_narrow_table_stand_above_their_rows() -> None:
    rows = [("fault", "1", "2"), ("freeze:arm", "stale", "ok"), ("mismatch_qos:/arm/joint_states", "time", "time")]
    assert aligned(rows, 30) == [
        "fault              1      2",
        "freeze:arm         stale  ok",
        "mismatch_qos:/arm/joint_states",
        "                   time   time",
    ]
    assert aligned(rows, 80) == aligned(rows)
