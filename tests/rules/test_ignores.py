"""A comment excuses a finding on its line, where it gives a reason and may."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.pipeline import Checked, check

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
    (found,) = (one for one in checked.diagnostics if one.code == "unknown-ignored-code")
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
    (found,) = (one for one in checked.diagnostics if one.code == "ignore-refused")
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
    assert line not in {one.span.line for one in checked.diagnostics if one.span.file.endswith("devices.yaml")}
    assert "unused-ignore" not in {one.code for one in checked.diagnostics}
    unknown = [one for one in check(PICK).diagnostics if one.code == "unknown-version"]
    assert len([one for one in checked.diagnostics if one.code == "unknown-version"]) == len(unknown) - 1
