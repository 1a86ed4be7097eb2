"""A comment excuses a finding on its line, where it gives a reason and the family and severity of the rule allow it."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from cellc.compiler.pages import all_codes
from cellc.compiler.pipeline import Checked, check
from cellc.compiler.rules.ignores import apply_ignores, ignore_comments, may_be_ignored
from cellc.compiler.rules.kit import Rule
from cellc.compiler.rules.run import ALL_RULES
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Diagnostic, Severity, Span
from tests.cells import CORPUS

PICK = Path(__file__).resolve().parents[2] / "cells/ur5e_pick/cell.yaml"
REVISION = "    revision: UNKNOWN\n    serial"
REASON = "the supplier answers by May"


def checked_with(folder: Path, *changes: tuple[str, str]) -> Checked:
    """Check the pick cell after replacing texts, the first occurrence of each."""
    text = PICK.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    return check(folder / "cell.yaml")


def on_revision(comment: str) -> tuple[str, str]:
    return REVISION, REVISION.replace("UNKNOWN", f"UNKNOWN  {comment}")


def told(checked: Checked) -> list[tuple[str, int]]:
    return [(found.code, found.span.line) for found in checked.diagnostics]


def changes_of_comment(folder: Path, comment: str) -> tuple[set[tuple[str, int]], set[tuple[str, int]]]:
    """Return what a comment on the arm's revision takes away and adds."""
    before, after = told(checked_with(folder)), told(checked_with(folder, on_revision(comment)))
    return set(before) - set(after), set(after) - set(before)


REVISION_LINE = PICK.read_text(encoding="utf-8").split(REVISION)[0].count("\n") + 1


def test_reasoned_comment_takes_the_finding_of_its_line_away(tmp_path: Path) -> None:
    gone, new = changes_of_comment(tmp_path, f"# cellc: ignore unknown-version {REASON}")
    assert gone == {("unknown-version", REVISION_LINE)}
    assert new == set()


def test_comment_without_reason_has_no_effect_and_is_reported(tmp_path: Path) -> None:
    gone, new = changes_of_comment(tmp_path, "# cellc: ignore unknown-version --")
    assert gone == set()
    assert new == {("ignore-without-reason", REVISION_LINE)}


def test_code_that_does_not_exist_is_reported_with_the_nearest(tmp_path: Path) -> None:
    checked = checked_with(tmp_path, on_revision(f"# cellc: ignore unknown-versions {REASON}"))
    (found,) = (diagnostic for diagnostic in checked.diagnostics if diagnostic.code == "unknown-ignored-code")
    assert "`unknown-version`" in found.help
    line = PICK.read_text(encoding="utf-8").splitlines()[found.span.line - 1]
    assert found.span.column == len(line) + 1 + len("  # cellc: ignore ")


def test_several_codes_are_judged_one_by_one(tmp_path: Path) -> None:
    comment = f"# cellc: ignore unknown-version, no-such-thing, no-other-thing: {REASON}"
    gone, new = changes_of_comment(tmp_path, comment)
    assert gone == {("unknown-version", REVISION_LINE)}
    assert ("unknown-ignored-code", REVISION_LINE) in new


def test_comment_on_a_line_without_that_finding_is_unused(tmp_path: Path) -> None:
    checked = checked_with(tmp_path, ("format: 1\n", f"format: 1  # cellc: ignore unknown-version {REASON}\n"))
    assert ("unused-ignore", 2) in told(checked)


def test_text_that_looks_like_a_comment_is_none(tmp_path: Path) -> None:
    text = f'summary: "# cellc: ignore unknown-version {REASON}"\n'
    checked = checked_with(
        tmp_path, ("summary: UR5e with a Robotiq 2F-85 picks parts from fixture A under a wrist camera\n", text)
    )
    assert told(checked) == told(checked_with(tmp_path))


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("unknown-stop-authority", "family SAF"),
        ("uncalibrated-frame", "family FRM"),
        ("duplicate-key", "not known"),
    ],
)
def test_what_nobody_may_ignore_is_refused(tmp_path: Path, code: str, reason: str) -> None:
    checked = checked_with(tmp_path, on_revision(f"# cellc: ignore {code} {REASON}"))
    (found,) = (diagnostic for diagnostic in checked.diagnostics if diagnostic.code == "ignore-refused")
    assert reason in found.message
    assert not checked.ok


def test_refused_comment_leaves_the_error_that_it_names(tmp_path: Path) -> None:
    line = "independent_of: [control_pc], evidence: [injected-stop result]}"
    comment = f"# cellc: ignore stop-authority-in-the-cell {REASON}"
    excused = checked_with(tmp_path, ("authority: safety_plc", "authority: task"), (line, f"{line}  {comment}"))
    codes = {code for code, _ in told(excused)}
    assert {"stop-authority-in-the-cell", "ignore-refused"} <= codes
    assert not excused.ok


def test_comment_in_an_included_file_counts_there(tmp_path: Path) -> None:
    text = PICK.read_text(encoding="utf-8")
    start, end = text.index("devices:\n"), text.index("calibrations:\n")
    part = text[start:end].replace(
        "firmware: UNKNOWN", f"firmware: UNKNOWN  # cellc: ignore unknown-version {REASON}", 1
    )
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "devices.yaml").write_text(part, encoding="utf-8")
    root = text[:start] + text[end:] + "include: parts/devices.yaml\n"
    (tmp_path / "cell.yaml").write_text(root, encoding="utf-8")
    checked = check(tmp_path / "cell.yaml")
    line = part.split("ignore unknown-version")[0].count("\n") + 1
    assert line not in {
        diagnostic.span.line for diagnostic in checked.diagnostics if diagnostic.span.file.endswith("devices.yaml")
    }
    assert "unused-ignore" not in {diagnostic.code for diagnostic in checked.diagnostics}
    unknown = [diagnostic for diagnostic in check(PICK).diagnostics if diagnostic.code == "unknown-version"]
    assert (
        len([diagnostic for diagnostic in checked.diagnostics if diagnostic.code == "unknown-version"])
        == len(unknown) - 1
    )


def spot(line: int, file: str = "cell.yaml") -> Span:
    return Span(file, line, 5, line, 9)


def warning(code: str, place: Span) -> Diagnostic:
    return Diagnostic(code, Severity.WARNING, "found", place)


def judged(text: str, *found: Diagnostic) -> list[tuple[str, Span]]:
    """Return code and place of what remains when the comments of ``cell.yaml`` are applied."""
    ignores = ignore_comments({"cell.yaml": text, "part.yaml": "a: 1\n"})
    return [(ignore.code, ignore.span) for ignore in apply_ignores(found, ignores, all_codes())]


@pytest.mark.parametrize("place", [spot(2), spot(1, "part.yaml")])
def test_finding_on_another_line_or_in_another_file_stays(place: Span) -> None:
    text = "a: 1  # cellc: ignore unknown-version checked by hand\nb: 2\n"
    remaining = judged(text, warning("unknown-version", place), warning("unknown-version", spot(1)))
    assert remaining == [("unknown-version", place)]


def test_other_finding_on_the_line_stays() -> None:
    text = "a: 1  # cellc: ignore unknown-version checked by hand\n"
    remaining = judged(text, warning("missing-rollback", spot(1)), warning("unknown-version", spot(1)))
    assert remaining == [("missing-rollback", spot(1))]


def test_comment_at_the_end_of_a_span_over_lines_counts() -> None:
    text = "a: [1,\n    2]  # cellc: ignore unknown-version checked by hand\n"
    assert judged(text, warning("unknown-version", Span("cell.yaml", 1, 4, 2, 7))) == []


def test_comment_is_not_called_unused_where_its_rule_could_not_run() -> None:
    rule = next(rule for rule in ALL_RULES if rule.assumes and rule.family not in ("SAF", "OWN", "FRM"))
    text = f"a: 1  # cellc: ignore {rule.code} checked by hand\n"
    cause = warning(rule.assumes[0], spot(3))
    assert judged(text, cause) == [(rule.assumes[0], spot(3))]
    assert [code for code, _ in judged(text)] == ["unused-ignore"]


def test_marker_inside_a_word_of_a_comment_is_none() -> None:
    assert ignore_comments({"cell.yaml": "a: 1  # see page# cellc: ignore unknown-version why\n"}) == ()


def test_comment_without_a_code_is_reported() -> None:
    assert [code for code, _ in judged("a: 1  # cellc: ignore\n")] == ["unknown-ignored-code"]


def test_comment_on_an_error_of_the_spec_is_refused_although_no_rule_runs(tmp_path: Path) -> None:
    line = "  kernel: 6.8.1-1015-realtime"
    checked = checked_with(tmp_path, (line, f"  kernl: 6.8.1-1015-realtime  # cellc: ignore unknown-key {REASON}"))
    assert {"unknown-key", "ignore-refused"} <= {code for code, _ in told(checked)}
    # Whether this one is used nobody knows before the rules have run on what is meant.
    checked = checked_with(tmp_path, (line, f"  kernl: 6.8.1-1015-realtime  # cellc: ignore unknown-version {REASON}"))
    codes = {code for code, _ in told(checked)}
    assert ("unknown-key" in codes, codes & {"ignore-refused", "unused-ignore"}) == (True, set())


_MARK = re.compile(r"# expect: ([a-z0-9, -]+)$", re.MULTILINE)


def _is_protected(rule: Rule) -> bool:
    # Issue 5: errors of safety, ownership and frames cannot be ignored; what blocks motion there cannot either.
    stops = rule.family in ("SAF", "OWN", "FRM") and rule.severity in (Severity.ERROR, Severity.BLOCKER)
    return stops or rule.code in STAGES["link"]  # errors of linking end the check before a rule could speak


def test_what_may_be_ignored_is_decided_by_family_and_severity() -> None:
    assert [rule.code for rule in ALL_RULES if may_be_ignored(rule.code) is _is_protected(rule)] == []


def _cases() -> dict[tuple[str, Severity], tuple[Rule, Path]]:
    """Return a case of the corpus for each family and severity, whose only finding is marked in the spec itself."""
    cases: dict[tuple[str, Severity], tuple[Rule, Path]] = {}
    rules = {rule.code: rule for rule in ALL_RULES}
    for file in sorted((CORPUS / "invalid").glob("*.yaml")):
        text = file.read_text(encoding="utf-8")
        marks = _MARK.findall(text)
        if len(marks) == 1 and marks[0] in rules and "# expect at" not in text:
            rule = rules[marks[0]]
            cases.setdefault((rule.family, rule.severity), (rule, file))
    return cases


def test_one_finding_of_each_family_and_severity_is_excused_or_refused(tmp_path: Path) -> None:
    folder, cases = shutil.copytree(CORPUS / "invalid", tmp_path / "invalid"), _cases()
    assert len(cases) > 30
    for rule, case in cases.values():
        text = case.read_text(encoding="utf-8")
        file = folder / case.name
        file.write_text(_MARK.sub(f"# cellc: ignore {rule.code} the test asks for it", text), encoding="utf-8")
        codes = {diagnostic.code for diagnostic in check(file).diagnostics}
        assert codes == ({rule.code, "ignore-refused"} if _is_protected(rule) else set()), case.name
