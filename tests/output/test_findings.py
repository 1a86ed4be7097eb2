"""Diagnostics of writing: two specs of one name are told, one spec that is named twice is not."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.output.findings import finding, shared_output
from cellc.contract.code_page import page_of
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Severity, Span


def _span(file: str) -> Span:
    return Span(file, 2, 7, 2, 12)


@pytest.mark.parametrize(
    ("here", "first", "told"),
    [
        ("a/cell.yaml", "b/cell.yaml", True),
        ("a/cell.yaml", "a/cell.yaml", False),
        ("a/../a/cell.yaml", "a/cell.yaml", False),
        ("{folder}/a/cell.yaml", "a/cell.yaml", False),
    ],
)
def test_two_specs_of_one_name_are_told(
    here: str, first: str, told: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "cell.yaml").touch()
    found = shared_output("bench", _span(here.format(folder=tmp_path)), _span(first))
    if not told:
        assert found is None
        return
    assert found is not None
    assert (found.code, found.span.file, found.related[0].span.file) == ("output-shared", here, first)
    assert "`bench`" in found.message


@pytest.mark.parametrize("code", STAGES["output"])
def test_finding_has_severity_and_fix_of_its_code_unless_another_is_given(code: str) -> None:
    found = finding(code, "said", Path("generated/bench"))
    assert (found.code, found.severity, found.message) == (code, Severity.ERROR, "said")
    assert found.help == page_of(code).fix
    assert (found.span.file, found.span.line) == ("generated/bench", 1)
    assert finding(code, "said", Path("x"), "do that").help == "do that"
