"""What a person sees."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import pytest

from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span
from cellc.contract.printing import as_text
from cellc.tools.report.text_report import SEVERITY_STYLES, render_text, summary
from tests.properties import given, st
from tests.report.findings import FILE, finding


def _shown(found: Sequence[Diagnostic], texts: Mapping[str, str], *, color: bool) -> str:
    return as_text(render_text(found, texts), color=color)


def _summary(found: Sequence[Diagnostic], files: Sequence[str]) -> str:
    return as_text([summary(found, files)], color=False).rstrip("\n")


def _rows(line: str, start: int, end: int) -> tuple[str, str]:
    """Return the source line and the carets below it, without gutter."""
    shown = _shown([finding(Span(FILE, 1, start, 1, end))], {FILE: line}, color=False).split("\n")
    source, carets = shown[3], shown[4]
    return source.removeprefix("1 | "), carets.removeprefix("  | ")


def test_finding_looks_like_that_of_a_compiler() -> None:
    text = "\n" * 8 + "lower: 1\nupper: -1\n"
    found = finding(
        Span(FILE, 10, 8, 10, 10), advice="swap them", related=(Related("lower is here", Span(FILE, 9, 1, 9, 6)),)
    )
    assert _shown([found], {FILE: text}, color=False) == (
        "error[reversed-limits]: limit is reversed\n"
        "  --> cells/a.yaml:10:8\n"
        "   |\n"
        "10 | upper: -1\n"
        "   |        ^^\n"
        "note: lower is here\n"
        "  --> cells/a.yaml:9:1\n"
        "   |\n"
        " 9 | lower: 1\n"
        "   | -----\n"
        "help: swap them\n"
    )


def test_error_stands_before_the_blockers_above_it() -> None:
    blocker = replace(finding(Span(FILE, 1, 1, 1, 2), "asked"), severity=Severity.BLOCKER)
    error = finding(Span(FILE, 9, 1, 9, 2), "wrong")
    shown = _shown([blocker, error], {}, color=False)
    assert shown.index("wrong") < shown.index("asked")


def test_findings_stand_in_the_order_of_the_file() -> None:
    later, earlier = finding(Span(FILE, 2, 1, 2, 2), "later"), finding(Span(FILE, 1, 1, 1, 2), "earlier")
    shown = _shown([later, earlier], {}, color=False)
    assert shown.index("earlier") < shown.index("later")
    assert shown.count("\n\n") == 1
    assert shown == _shown([earlier, later], {}, color=False)


def test_findings_of_one_code_are_cut_and_the_last_says_how_many_more_there_are() -> None:
    many = [finding(Span(FILE, line, 1, line, 2), f"number {line},", advice="swap them") for line in range(1, 251)]
    other = replace(many[0], code="other", span=Span(FILE, 300, 1, 300, 2))
    shown = _shown([*many, other], {}, color=False)
    assert shown.count("[reversed-limits]") == 100
    assert "number 100," in shown
    assert "number 101," not in shown
    assert "\nhelp: swap them; not shown: 150 more `reversed-limits`\n" in shown
    assert "[other]" in shown
    assert "not shown" not in _shown(many[:100], {}, color=False)


def test_nothing_found_is_no_text() -> None:
    assert _shown([], {}, color=True) == ""


@pytest.mark.parametrize("line", [0, 7])
def test_place_without_text_is_only_named(line: int) -> None:
    shown = _shown([finding(Span(FILE, line, 1, line, 1))], {FILE: "a\n"}, color=False)
    assert shown.endswith(f"--> cells/a.yaml:{line}:1\n")


@pytest.mark.parametrize(
    ("line", "start", "end", "source", "carets"),
    [
        ("a: 1", 4, 5, "a: 1", "   ^"),
        # A tab reaches to the next multiple of four cells.
        ("a\tb", 3, 4, "a   b", "    ^"),
        ("\t\tb", 2, 3, "        b", "    ^^^^"),
        # Wide characters take two cells, combining ones none (UAX #11).
        ("漢字: x", 5, 6, "漢字: x", "      ^"),
        ("漢字: x", 1, 3, "漢字: x", "^^^^"),
        ("e\u0301: x", 5, 6, "e\u0301: x", "   ^"),
        # An empty span, the end of a line, and a place behind it are still marked.
        ("abc", 2, 2, "abc", " ^"),
        ("abc", 4, 4, "abc", "   ^"),
        ("abc", 9, 12, "abc", "   ^"),
        ("", 1, 1, "", "^"),
        ("a\x1b[2Jb", 6, 7, "a\\x1b[2Jb", "        ^"),
    ],
)
def test_carets_stand_under_the_culprit(line: str, start: int, end: int, source: str, carets: str) -> None:
    shown, marks = _rows(line, start, end)
    assert shown.removeprefix("1 |") == source
    assert marks == carets


def test_span_of_several_lines_is_marked_to_the_end_of_the_first() -> None:
    shown = _shown([finding(Span(FILE, 1, 4, 3, 2))], {FILE: "a: |\n  b\n  c\n"}, color=False)
    assert "1 | a: |\n  |    ^\n" in shown


def test_long_line_is_cut_around_the_culprit() -> None:
    source, carets = _rows("x" * 5000 + "HERE" + "y" * 5000, 5001, 5005)
    assert len(source) <= 120
    assert source.startswith("...x")
    assert source.endswith("y...")
    assert source[carets.index("^") : carets.rindex("^") + 1] == "HERE"


def test_long_culprit_is_cut_too() -> None:
    source, carets = _rows("x" * 5000, 1, 5001)
    assert len(source) <= 120
    assert len(carets) <= 120


_STYLES = re.compile(r"\x1b\[[0-9;]*m")


@given(line=st.text(max_size=60), start=st.integers(1, 80), length=st.integers(0, 80), message=st.text(max_size=40))
def test_hostile_text_cannot_drive_the_terminal(line: str, start: int, length: int, message: str) -> None:
    found = finding(Span(message, 1, start, 1, start + length), message, advice=message)
    plain = _shown([found], {message: line}, color=False)
    colored = _shown([found], {message: line}, color=True)
    assert not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2066-\u2069]", plain)
    assert _STYLES.sub("", colored) == plain
    plain.encode()


def test_severity_has_its_colour() -> None:
    for severity in Severity:
        shown = _shown([finding(severity=severity)], {FILE: "abc"}, color=True)
        assert f"{SEVERITY_STYLES[severity].value}{severity.value}[reversed-limits]" in shown
        assert f"{SEVERITY_STYLES[severity].value}^^^" in shown


def test_summary_counts_by_severity() -> None:
    severities = [Severity.WARNING] * 3 + [Severity.ERROR] * 2 + [Severity.BLOCKER]
    found = [finding(severity=severity) for severity in severities]
    assert _summary(found, [FILE]) == "2 errors, 1 blocker, 3 warnings in cells/a.yaml"
    assert _summary([], [FILE]) == "no findings in cells/a.yaml"
    assert _summary([finding(severity=Severity.AUDIT)], ["a", "b"]) == "1 audit item in 2 files"


@pytest.mark.parametrize(
    ("character", "shown"),
    [("\x1b", "\\x1b"), ("\x9b", "\\x9b"), ("\u202e", "\\u202e"), ("\u2028", "\\u2028"), ("\ud800", "\\ud800")],
)
def test_steering_character_is_shown_as_its_escape(character: str, shown: str) -> None:
    text = _shown([finding(message=f"a{character}b")], {FILE: f"c{character}d"}, color=False)
    assert f"a{shown}b" in text
    assert f"c{shown}d" in text
    assert character not in text
