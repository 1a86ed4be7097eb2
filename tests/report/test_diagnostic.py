"""Diagnostics by themselves: how paths and counts are written, and which severity stops what."""

from __future__ import annotations

import pytest

from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span
from cellc.contract.diagnostics.diagnostic import Findings, YamlPath, counted, format_path

_ERROR, _BLOCKER, _WARNING, _AUDIT = Severity


def _found(severity: Severity, line: int = 1, code: str = "a-code", message: str = "wrong") -> Diagnostic:
    return Diagnostic(code, severity, message, Span("cell.yaml", line, 2, line, 5))


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ((), ""),
        (("devices",), "devices"),
        (("devices", "arm", "mount"), "devices.arm.mount"),
        (("steps", 2, "move"), "steps[2].move"),
        (("steps", 0), "steps[0]"),
        ((1, "a"), "[1].a"),
        (("a", 1, 2), "a[1][2]"),
        (("a", "1"), "a.1"),
    ],
)
def test_path_is_written_with_indices_in_brackets(path: YamlPath, text: str) -> None:
    assert format_path(path) == text


@pytest.mark.parametrize(
    ("severities", "text"),
    [
        ((), "no findings"),
        ((_ERROR,), "1 error"),
        ((_AUDIT, _ERROR, _AUDIT), "1 error, 2 audit items"),
        ((_WARNING, _BLOCKER, _AUDIT), "1 blocker, 1 warning, 1 audit item"),
    ],
)
def test_findings_are_counted_the_worst_first(severities: tuple[Severity, ...], text: str) -> None:
    assert counted(map(_found, severities)) == text


@pytest.mark.parametrize("others", [(), (_BLOCKER, _WARNING, _AUDIT)])
def test_errors_alone_stop_what_comes_next(others: tuple[Severity, ...]) -> None:
    harmless = tuple(map(_found, others))
    for found, ok in ((harmless, True), ((*harmless, _found(_ERROR)), False), ((_found(_ERROR), *harmless), False)):
        assert Findings("cell.yaml", {}, found).ok is ok
        assert Outcome(0, found).ok is ok
        assert not Outcome(None, found).ok


def test_findings_are_sorted_by_place_code_and_message() -> None:
    ordered = (
        _found(_AUDIT, 1, "b"),
        _found(_ERROR, 2, "a", "y"),
        _found(_WARNING, 2, "b", "x"),
        _found(_ERROR, 2, "b", "y"),
        _found(_ERROR, 10),
    )
    findings = Findings("cell.yaml", {}, ordered[3:4]).with_more((ordered[4], ordered[0], ordered[2], ordered[1]))
    assert findings.diagnostics == ordered


def test_finding_is_one_line_and_an_outcome_a_count() -> None:
    assert str(_found(_ERROR, 3)) == "cell.yaml:3:2: error[a-code]: wrong"
    assert repr(_found(_AUDIT)) == "<cell.yaml:1:2: audit[a-code]: wrong>"
    assert repr(Outcome(1, (_found(_ERROR),))) == "<Outcome: int, 1 error>"
    assert repr(Outcome(None)) == "<Outcome: no value, no findings>"
