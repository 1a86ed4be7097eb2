"""What a program reads."""

from __future__ import annotations

import json
from dataclasses import replace

from cellc.contract.diagnostics import Fix, Related, Severity, Span
from cellc.tools.report.json_report import render_json
from tests.report.findings import FILE, finding


def test_object_is_the_documented_one() -> None:
    found = replace(
        finding(Span(FILE, 2, 8, 2, 10), advice="swap", related=(Related("lower", Span(FILE, 1, 1, 1, 6)),)),
        fix=Fix(Span(FILE, 2, 9, 2, 10), "b", "c", sure=True),
    )
    text = render_json([found])
    assert text.endswith("}\n")
    place = {"file": FILE, "line": 2, "column": 8, "end_line": 2, "end_column": 10}
    first = {"message": "lower", "file": FILE, "line": 1, "column": 1, "end_line": 1, "end_column": 6}
    edit = place | {"column": 9, "text": "c", "sure": True}
    expected = {
        "format": 1,
        "diagnostics": [
            {"code": "reversed-limits", "severity": "error", "message": "limit is reversed"}
            | place
            | {"path": ["arm", 0], "help": "swap", "related": [first], "fix": edit}
        ],
        "summary": {"error": 1, "blocker": 0, "warning": 0, "audit": 0},
    }
    # Compared as text, because the order of the keys is part of the format.
    assert json.dumps(json.loads(text)) == json.dumps(expected)


def test_no_findings_are_an_empty_list() -> None:
    assert json.loads(render_json([]))["diagnostics"] == []


def test_order_of_findings_does_not_reach_the_text() -> None:
    found = [finding(Span(FILE, line, 1, line, 2), severity=Severity.WARNING) for line in (3, 1, 2)]
    assert render_json(found) == render_json(reversed(found))


def test_hostile_text_is_escaped() -> None:
    assert render_json([finding(message="\x1b[2J\ud800é")]).isascii()
