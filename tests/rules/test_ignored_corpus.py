"""Every rule's finding can be excused on its line, or is refused, as its family and severity say."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.compiler.rules.run import ALL_RULES
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Severity

INVALID = Path(__file__).resolve().parents[1] / "corpus" / "invalid"
_MARK = re.compile(r"# expect: ([a-z0-9, -]+)$", re.MULTILINE)
RULES = {rule.code: rule for rule in ALL_RULES}


def _cases() -> dict[str, Path]:
    """Return one case of the corpus for each rule whose finding is marked in the spec itself."""
    cases: dict[str, Path] = {}
    for file in sorted(INVALID.glob("*.yaml")):
        text = file.read_text(encoding="utf-8")
        marks = _MARK.findall(text)
        if len(marks) == 1 and marks[0] in RULES and "# expect at" not in text:
            cases.setdefault(marks[0], file)
    return cases


CASES = _cases()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shutil.copytree(INVALID, tmp_path_factory.mktemp("corpus"), dirs_exist_ok=True)


def test_most_rules_have_a_case() -> None:
    # The others are found in a description or in a shared part.
    assert len(CASES) > 120


@pytest.mark.parametrize("code", CASES)
def test_finding_is_excused_or_refused(code: str, folder: Path) -> None:
    file = folder / CASES[code].name
    text = CASES[code].read_text(encoding="utf-8")
    file.write_text(_MARK.sub(f"# cellc: ignore {code} the test asks for it", text), encoding="utf-8")
    told = {one.code for one in check(file).diagnostics}
    rule = RULES[code]
    # Issue 5: errors of safety, ownership and frames cannot be ignored; what blocks motion there cannot either.
    protected = rule.family in ("SAF", "OWN", "FRM") and rule.severity in (Severity.ERROR, Severity.BLOCKER)
    # Errors of linking end the check before a rule could speak.
    protected = protected or code in STAGES["link"]
    assert told == ({code, "ignore-refused"} if protected else set())
