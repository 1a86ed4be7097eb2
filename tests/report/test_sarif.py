"""What code hosts and editors read."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Any

import jsonschema
import pytest

from cellc.compiler.pages import all_codes
from cellc.contract.diagnostics import Diagnostic, Fix, Related, Severity, Span
from cellc.tools.report.sarif_report import render_sarif
from tests.cells import diagnose
from tests.report.findings import FILE, finding

SCHEMA = json.loads((Path(__file__).parent / "sarif_subset.schema.json").read_text(encoding="utf-8"))
HOME = PurePosixPath("/home/someone/project")
CORPUS = Path(__file__).resolve().parents[1] / "corpus" / "invalid"


def log_of(*found: Diagnostic) -> dict[str, Any]:
    log: dict[str, Any] = json.loads(render_sarif(found, HOME))
    jsonschema.validate(log, SCHEMA)
    return log


def only_result(log: dict[str, Any]) -> dict[str, Any]:
    (result,) = log["runs"][0]["results"]
    assert isinstance(result, dict)
    return result


def uri_of(file: str) -> dict[str, str]:
    place: dict[str, str] = only_result(log_of(finding(Span(file, 1, 1, 1, 2))))["locations"][0]["physicalLocation"][
        "artifactLocation"
    ]
    return place


def test_no_findings_are_a_run_without_results() -> None:
    assert log_of()["runs"][0]["results"] == []


def test_region_keeps_the_span() -> None:
    # SARIF 3.30.6: endColumn is one greater than the last column of the region, as the exclusive end of a span.
    place = only_result(log_of(finding(Span(FILE, 2, 8, 3, 10))))["locations"][0]["physicalLocation"]
    assert place["region"] == {"startLine": 2, "startColumn": 8, "endLine": 3, "endColumn": 10}


def test_related_places_have_their_message_and_number() -> None:
    related = (Related("lower", Span(FILE, 1, 1, 1, 6)), Related("upper", Span(FILE, 4, 1, 4, 6)))
    places = only_result(log_of(finding(related=related)))["relatedLocations"]
    assert [(place["id"], place["message"]["text"]) for place in places] == [(1, "lower"), (2, "upper")]


def test_fix_is_an_edit_that_a_program_can_make() -> None:
    found = replace(finding(), fix=Fix(Span(FILE, 2, 9, 2, 13), "velo", "velocity", sure=False))
    (fix,) = only_result(log_of(found))["fixes"]
    (change,) = fix["artifactChanges"]
    region = {"startLine": 2, "startColumn": 9, "endLine": 2, "endColumn": 13}
    assert change["replacements"] == [{"deletedRegion": region, "insertedContent": {"text": "velocity"}}]
    assert change["artifactLocation"] == uri_of(FILE)


def test_result_points_at_the_rule_with_its_page() -> None:
    log = log_of(finding())
    rule = log["runs"][0]["tool"]["driver"]["rules"][only_result(log)["ruleIndex"]]
    assert rule["id"] == only_result(log)["ruleId"] == "reversed-limits"
    assert "Fix: " in rule["help"]["markdown"]


@pytest.mark.parametrize(
    ("severity", "level"),
    [
        (Severity.ERROR, "error"),
        (Severity.BLOCKER, "warning"),
        (Severity.WARNING, "warning"),
        (Severity.AUDIT, "note"),
    ],
)
def test_level_tells_whether_artifacts_stop(severity: Severity, level: str) -> None:
    result = only_result(log_of(finding(severity=severity)))
    assert result["level"] == level
    assert result["properties"]["severity"] == severity.value


def test_file_under_the_folder_is_relative_to_it() -> None:
    assert uri_of(f"{HOME}/cells/a b.yaml") == {"uri": "cells/a%20b.yaml", "uriBaseId": "%SRCROOT%"}


def test_file_elsewhere_is_absolute_and_has_no_base() -> None:
    assert uri_of("/elsewhere/ü.yaml") == {"uri": "file:///elsewhere/%C3%BC.yaml"}


def test_file_above_the_folder_has_no_base() -> None:
    assert uri_of("../cell.yaml") == {"uri": "../cell.yaml"}


def test_colon_in_a_name_is_no_scheme() -> None:
    assert uri_of("a:b.yaml")["uri"] == "a%3Ab.yaml"


def test_hostile_text_is_escaped() -> None:
    assert render_sarif([finding(message="\x1b[2J\ud800é")], HOME).isascii()


@pytest.mark.parametrize("case", sorted(CORPUS.glob("*.yaml"))[::9], ids=lambda case: case.stem)
def test_findings_of_real_cells_are_valid(case: Path) -> None:
    found = diagnose(case)
    assert len(log_of(*found)["runs"][0]["results"]) == len(found)


def test_every_page_is_a_valid_rule() -> None:
    found = [Diagnostic(code, severity, "found", Span(FILE, 1, 1, 1, 2)) for code, severity in all_codes().items()]
    assert len(log_of(*found)["runs"][0]["tool"]["driver"]["rules"]) == len(found)


def test_each_result_points_at_its_own_rule() -> None:
    found = [
        Diagnostic(code, Severity.ERROR, "found", Span(FILE, 1, 1, 1, 2)) for code in ("zero-axis", "duplicate-key")
    ]
    run = log_of(*found)["runs"][0]
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert [rules[result["ruleIndex"]] for result in run["results"]] == ["duplicate-key", "zero-axis"]
