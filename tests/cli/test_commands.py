"""The commands as a user meets them: exit codes, output, and no traceback whatever is given."""

from __future__ import annotations

import errno
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import click
import pytest

from cellc.compiler.pages import all_codes
from cellc.compiler.pipeline import check
from cellc.mock.command.campaign import pace
from cellc.mock.command.options import Live, RehearsalOptions
from cellc.tools.cli.main import cellc
from tests.cells import ROOT
from tests.cli.run import MINIMAL, PICK, run


def test_check_of_a_cell_with_blockers_is_good_and_tells_them() -> None:
    ran = run("check", PICK)
    assert ran.code == 0
    assert "blocker[unknown-version]: `revision` of `arm` is UNKNOWN" in ran.out
    assert "cell.yaml:29:15" in ran.out


def test_blockers_fail_a_check_that_asks_for_it() -> None:
    assert run("check", PICK, "--fail-on", "blocker").code == 1


def test_build_sums_blockers_and_names_the_commands_that_tell_more(tmp_path: Path) -> None:
    ran = run("build", MINIMAL, "-o", str(tmp_path))
    assert ran.code == 0
    assert "blocker[" not in ran.out
    assert "not cleared for hardware: 3 controller-without-client, 3 unknown-version, 1 missing-approval" in ran.out
    assert f"`cellc check {MINIMAL}` lists them, `cellc audit {MINIMAL}` names the person who can answer" in ran.out


def test_build_that_an_error_stops_lists_its_blockers_too(tmp_path: Path) -> None:
    spec = tmp_path / "cell.yaml"
    spec.write_text(Path(MINIMAL).read_text(encoding="utf-8").replace("ros: jazzy", "ros: jazzzy"), encoding="utf-8")
    ran = run("build", str(spec), "-o", str(tmp_path / "out"))
    assert ran.code == 1
    assert "error[" in ran.out
    assert "not cleared" not in ran.out


def test_check_of_several_cells_reports_each() -> None:
    ran = run("check", PICK, MINIMAL)
    assert PICK in ran.out
    assert MINIMAL in ran.out


def test_check_as_json_is_one_object() -> None:
    told = json.loads(run("check", PICK, "--format", "json").out)
    assert told["format"] == 1
    assert told["summary"]["error"] == 0
    assert {finding["severity"] for finding in told["diagnostics"]} == {"audit", "blocker"}


@pytest.mark.parametrize("command", ["check", "build", "mock", "show"])
def test_command_without_its_argument_is_a_usage_error(command: str) -> None:
    ran = run(command)
    assert ran.code == 2
    assert "Usage" in ran.err


def test_unknown_command_is_a_usage_error() -> None:
    assert run("bild").code == 2


def test_missing_file_is_a_finding_not_a_traceback(tmp_path: Path) -> None:
    ran = run("check", (tmp_path / "cell.yaml").as_posix())
    assert ran.code == 1
    assert "file-not-found" in ran.out


def test_show_tells_the_value_and_the_line_it_is_written_on() -> None:
    ran = run("show", PICK, "controllers.arm_trajectory.goal_time_s")
    assert ran.code == 0
    assert ran.out.split() == ["controllers.arm_trajectory.goal_time_s", "1", "#", f"{PICK}:{_line('goal_time: 1 s')}"]


def test_show_tells_that_a_tightened_limit_comes_from_spec_and_catalog() -> None:
    out = run("show", PICK, "devices.arm.joints.arm_elbow_joint.velocity").out
    # Half of pi rad/s (robots.md: UR5e, velocity limits).
    assert "1.57079633" in out
    assert "of catalog devices/ur5e" in out


def test_show_of_a_misspelt_path_names_the_nearest() -> None:
    ran = run("show", PICK, "devices.arn")
    assert ran.code == 2
    assert "`arm`" in ran.err


def test_explain_prints_the_page_of_a_code() -> None:
    ran = run("explain", "reversed-limits")
    assert ran.code == 0
    assert ran.out.startswith("# reversed-limits (error)")


def test_explain_of_an_unknown_code_names_the_nearest() -> None:
    ran = run("explain", "reversed-limit")
    assert ran.code == 2
    assert "`reversed-limits`" in ran.err


def test_all_pages_are_printed_one_after_the_other() -> None:
    ran = run("explain", "--all")
    pages = [
        line.removeprefix("# ").partition(" ")[0]
        for line in ran.out.splitlines()
        if re.fullmatch(r"# [a-z0-9-]+ \(.*\)", line)
    ]
    assert (ran.code, pages) == (0, list(all_codes()))


def test_document_of_all_codes_is_replaced_as_a_whole_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_source: object, _target: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    document = tmp_path / "README.md"
    document.write_text("# Every code of cellc\n\nthe old one")
    monkeypatch.setattr("cellc.contract.store.swap.os.replace", full)
    ran = run("explain", "--all", "-o", tmp_path.as_posix())
    assert (ran.code, ran.err) == (70, f"error: {document.as_posix()}: no space left on device\n")
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [
        ("README.md", "# Every code of cellc\n\nthe old one")
    ]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_script_names_the_command(shell: str) -> None:
    assert "_CELLC_COMPLETE" in run("completion", shell).out


def test_init_writes_a_cell_that_passes_and_refuses_to_replace_it(tmp_path: Path) -> None:
    file = (tmp_path / "cell.yaml").as_posix()
    assert run("init", "bench", "ur5e", "robotiq_2f_85", "realsense_d435i", "-o", file).code == 0
    assert run("check", file).code == 0
    again = run("init", "bench", "ur5e", "-o", file)
    assert again.code == 2
    assert "exists" in again.err


def test_init_of_an_unknown_model_names_the_nearest(tmp_path: Path) -> None:
    ran = run("init", "bench", "ur5", "-o", (tmp_path / "cell.yaml").as_posix())
    assert ran.code == 2
    assert "`ur5e`" in ran.err


def test_schema_prints_the_committed_schema() -> None:
    assert run("schema").out == (ROOT / "schemas/cell.schema.json").read_text()


def _line(text: str) -> int:
    lines = Path(PICK).read_text().splitlines()
    return next(number for number, line in enumerate(lines, 1) if text in line)


def test_python_without_docstrings_is_refused_as_the_help_stands_in_them() -> None:
    command = [sys.executable, "-OO", "-B", "-m", "cellc", "check", MINIMAL]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout) == (2, "")
    assert ran.stderr.startswith("error: `python -OO` drops the docstrings")


def test_program_without_docstrings_has_the_same_findings() -> None:
    command = [sys.executable, "-OO", "-B", "-c", f"import cellc; print(cellc.check({MINIMAL!r}).diagnostics)"]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout) == (0, f"{check(MINIMAL).diagnostics}\n")


@pytest.mark.parametrize("name", cellc.list_commands(click.Context(cellc)))
def test_help_shows_a_call_that_the_command_takes(name: str) -> None:
    examples = re.findall(rf"^ +cellc {name}\b.*", run(name, "--help").out, re.MULTILINE)
    assert examples
    command = cellc.get_command(click.Context(cellc), name)
    assert command is not None
    for example in examples:
        # What it does stands behind two blanks, where it goes behind an arrow.
        call = re.split(r" {2,}| > ", example.strip())[0]
        command.make_context(name, shlex.split(call)[2:])


@pytest.mark.parametrize(
    ("done", "seconds", "told"),
    [
        (50, 10.0, "run 50 of 200, 1 failed, 5 a second, 30 s left"),
        (50, 100.0, "run 50 of 200, 1 failed, 0 a second, 5 min left"),
        (200, 0.0, "run 200 of 200, 1 failed, 200000 a second, 0 s left"),
    ],
)
def test_progress_of_many_runs_has_their_rate_and_what_is_left(done: int, seconds: float, told: str) -> None:
    assert pace(f"{done} of 200", 200, done, 1, seconds) == told


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--live --evidence x", "--live cannot be combined with --evidence."),
        ("--speed 2", "--speed needs --live."),
        ("--listen 127.0.0.1:1", "--listen needs --live."),
        ("--live --speed 0", "--speed must be greater than 0, got 0.0."),
        ("--live --speed nan", "--speed must be greater than 0, got nan."),
    ],
)
def test_options_of_a_view_that_do_not_go_together_are_told(options: str, said: str) -> None:
    ran = run("mock", "nowhere", *options.split())
    assert (ran.code, said in ran.err) == (2, True), ran.err


@pytest.mark.parametrize(
    ("options", "live"),
    [
        ("", None),
        ("--live", Live("127.0.0.1:8765", 1.0)),  # the port of Foxglove's own servers, in real time
        ("--live --speed 2.5", Live("127.0.0.1:8765", 2.5)),
        ("--live --listen 127.0.0.1:1", Live("127.0.0.1:1", 1.0)),
    ],
)
def test_options_of_a_view_have_defaults(options: str, live: Live | None, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[RehearsalOptions] = []

    def noted(given: RehearsalOptions) -> int:
        asked.append(given)
        return 0

    monkeypatch.setattr("cellc.mock.command.rehearsals.run_rehearsals", noted)
    assert run("mock", "nowhere", *options.split()).code == 0
    assert [options.live for options in asked] == [live]
