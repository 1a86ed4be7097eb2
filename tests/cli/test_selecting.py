"""Leaving findings out of the report, and never out of what stops a build."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.run import PICK, run


def codes(*arguments: str) -> set[str]:
    told = json.loads(run("check", PICK, "--format", "json", *arguments).out)
    return {finding["code"] for finding in told["diagnostics"]}


@pytest.fixture
def faulty(tmp_path: Path) -> str:
    """A cell with one error: the stop is given to a node of the cell."""
    text = Path(PICK).read_text(encoding="utf-8").replace("authority: safety_plc", "authority: task")
    (tmp_path / "cell.yaml").write_text(text, encoding="utf-8")
    return (tmp_path / "cell.yaml").as_posix()


@pytest.mark.parametrize("name", ["VER", "versions", "unknown-version,missing-rollback"])
def test_family_its_folder_and_its_codes_select_the_same(name: str) -> None:
    assert codes("--select", name) == {"unknown-version", "missing-rollback"}


def test_ignored_code_is_left_out_and_wins_over_a_selected_family() -> None:
    assert codes("--select", "VER", "--ignore", "unknown-version") == {"missing-rollback"}


def test_options_may_be_given_several_times() -> None:
    assert codes("--ignore", "unknown-version", "--ignore", "missing-rollback") & {"unknown-version"} == set()


def test_person_is_told_that_something_is_hidden() -> None:
    ran = run("check", PICK, "--ignore", "VER")
    assert "hidden by --select or --ignore" in ran.out


def test_misspelt_family_is_a_usage_error_with_the_nearest() -> None:
    ran = run("check", PICK, "--select", "version")
    assert ran.code == 2
    assert "`versions`" in ran.err


def test_check_may_leave_an_error_out(faulty: str) -> None:
    assert run("check", faulty).code == 1
    assert run("check", faulty, "--ignore", "SAF").code == 0


def test_build_shows_and_obeys_an_error_that_is_left_out(faulty: str, tmp_path: Path) -> None:
    ran = run("build", faulty, "-o", (tmp_path / "out").as_posix(), "--ignore", "SAF", "--select", "QOS")
    assert ran.code == 1
    assert "error[stop-authority-in-the-cell]" in ran.out
    assert not (tmp_path / "out").exists()


def test_formats_for_programs_are_offered() -> None:
    assert json.loads(run("check", PICK, "--format", "sarif").out)["version"] == "2.1.0"
    assert run("check", PICK, "--format", "github").out.startswith("::warning file=")
