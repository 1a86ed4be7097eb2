"""Single-fault cells: exactly the marked findings on exactly the marked lines, and no others."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from tests.cells import diagnose

CORPUS = Path(__file__).parent
INVALID = sorted((CORPUS / "invalid").glob("*.yaml"))
VALID = sorted((CORPUS / "valid").glob("*.yaml"))
# On the offending line itself, in YAML or in a description; or, for a finding in a shared part, anywhere in the case.
_MARK = re.compile(r"(?:#|<!--) expect: ([a-z0-9, -]+?)(?: -->)?$")
_MARK_ELSEWHERE = re.compile(r"# expect at (\S+):(\d+): ([a-z0-9, -]+)$")

Findings = Counter[tuple[str, str, int]]


def expected(case: Path) -> Findings:
    """Return the findings that a case and its descriptions are marked with: code, file, line."""
    marks: Findings = Counter()
    descriptions = re.findall(r"\./(descriptions/[\w-]+)", case.read_text(encoding="utf-8"))
    files = [case, *(file for folder in descriptions for file in sorted((case.parent / folder).glob("*.urdf")))]
    for file in files:
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
            if mark := _MARK.search(line):
                marks.update((code, file.name, number) for code in mark[1].split(", "))
            if mark := _MARK_ELSEWHERE.search(line):
                marks.update((code, Path(mark[1]).name, int(mark[2])) for code in mark[3].split(", "))
    return marks


@pytest.mark.parametrize("case", INVALID, ids=lambda case: case.stem)
def test_invalid_cell_has_exactly_the_marked_findings(case: Path) -> None:
    found = Counter((d.code, Path(d.span.file).name, d.span.line) for d in diagnose(case))
    assert found == expected(case)
    assert found


@pytest.mark.parametrize("case", VALID, ids=lambda case: case.stem)
def test_valid_cell_has_no_finding(case: Path) -> None:
    assert diagnose(case) == ()


def test_a_case_is_named_after_a_code_that_it_is_marked_with() -> None:
    for case in INVALID:
        assert any(case.stem.startswith(code) for code, _, _ in expected(case)), case.name
