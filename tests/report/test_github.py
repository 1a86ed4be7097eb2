"""What GitHub shows beside the lines of a pull request."""

from __future__ import annotations

from pathlib import PurePosixPath

import pytest

from cellc.contract.diagnostics import Diagnostic, Severity, Span
from cellc.contract.printing import as_text
from cellc.tools.report.github_report import render_github
from tests.report.findings import FILE, finding

HOME = PurePosixPath("/project")


def _shown(found: list[Diagnostic]) -> str:
    return as_text(render_github(found, HOME), color=False)


def test_command_names_place_code_and_help() -> None:
    text = _shown([finding(Span(FILE, 2, 8, 2, 10), advice="swap them")])
    assert text == (
        f"::error file={FILE},line=2,col=8,endLine=2,endColumn=10,title=error[reversed-limits]"
        "::limit is reversed%0Ahelp: swap them\n"
    )


@pytest.mark.parametrize(
    ("severity", "command"),
    [
        (Severity.ERROR, "error"),
        (Severity.BLOCKER, "warning"),
        (Severity.WARNING, "warning"),
        (Severity.AUDIT, "notice"),
    ],
)
def test_severity_becomes_one_of_githubs_three(severity: Severity, command: str) -> None:
    assert _shown([finding(severity=severity)]).startswith(f"::{command} ")


def test_span_over_lines_has_no_columns() -> None:
    text = _shown([finding(Span(FILE, 2, 8, 4, 3))])
    assert f"file={FILE},line=2,endLine=4,title=" in text


def test_file_is_counted_from_the_checkout() -> None:
    assert "file=cells/b.yaml," in _shown([finding(Span(f"{HOME}/cells/b.yaml", 1, 1, 1, 2))])


def test_text_cannot_begin_another_command_or_property() -> None:
    # @actions/core: data escapes % CR LF; properties also colon and comma.
    hostile = finding(Span("a,line=9:x%.yaml", 1, 1, 1, 2), "100%\n::error::forged")
    text = _shown([hostile])
    assert text.count("\n") == 1
    assert "file=a%2Cline=9%3Ax%25.yaml," in text
    assert "::100%25\\n::error::forged" in text


def test_no_findings_are_nothing() -> None:
    assert _shown([]) == ""
