"""An answer as plain values is the same answer again, whatever stands in it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cellc.batch.answer import Answer, answer_of, plain_of
from cellc.batch.compute import compute
from cellc.diagnostics import Diagnostic, Related, Severity, Span
from cellc.diagnostics.findings import Findings
from tests.cli.run import MINIMAL, ROOT

CELLS = sorted((ROOT / "tests/corpus/invalid").glob("*.yaml"))[::15]


def _there_and_back(answer: Answer) -> Answer:
    return answer_of(json.loads(json.dumps(plain_of(answer))))


@pytest.mark.parametrize("file", CELLS, ids=lambda file: file.stem)
def test_findings_of_a_cell_survive(file: Path) -> None:
    answer, _ = compute("check", file.as_posix())
    assert answer.findings.diagnostics
    assert _there_and_back(answer) == answer


def test_artifacts_survive() -> None:
    answer, _ = compute("compile", MINIMAL)
    assert answer.artifacts
    assert _there_and_back(answer) == answer


def test_every_part_of_a_finding_survives() -> None:
    span = Span("a\udcff/ü.yaml", 1, 2, 3, 4)
    found = Diagnostic("code", Severity.AUDIT, "said “\x1b”", span, ("a", 0, "0"), "do", (Related("there", span),))
    answer = Answer(Findings("a\udcff/ü.yaml", {"a\udcff/ü.yaml": "text\n🤖"}, (found,)))
    assert _there_and_back(answer) == answer


@pytest.mark.parametrize("strange", [[], {"findings": 1}, {"findings": [], "cell": None, "artifacts": None}])
def test_something_else_is_refused_in_a_way_that_is_caught(strange: dict[str, object]) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        answer_of(strange)
