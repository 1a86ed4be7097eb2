"""The campaign on the command line: matrix, JSON, replay, and a clean end on Ctrl-C."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import quote

import pytest

from cellc.mock.task.context import TaskContext
from tests.cells import ROOT
from tests.cli.refused import assert_refused, process
from tests.cli.run import run


@pytest.mark.usefixtures("few_faults")
def test_matrix_names_every_fault_and_step(folders: dict[str, Path]) -> None:
    ran = run("campaign", str(folders["minimal"]), "--jobs", "1")
    assert ran.code == 0, ran.out
    lines = ran.out.splitlines()
    assert lines[0] == "ready: 1 move aside, 2 grip close gripper, 3 move ready, 4 grip open gripper"
    assert lines[1].split() == ["fault", "1", "2", "3", "4"]
    stop = next(line for line in lines if line.startswith("protective_stop:arm"))
    assert stop.split() == ["protective_stop:arm", "stop", "stop", "stop", "stop"]
    assert lines[-1].startswith("passed: ")


@pytest.mark.usefixtures("few_faults")
def test_json_names_every_run_with_its_bound_digest_and_replay(folders: dict[str, Path], tmp_path: Path) -> None:
    folder = str(folders["minimal"])
    records = tmp_path / "all.jsonl"
    ran = run("campaign", folder, "--json", "--jobs", "2", "--records", str(records))
    assert ran.code == 0, ran.err
    told = json.loads(ran.out)
    assert told["passed"] is True
    assert told["seed"] == 0
    attempts = [json.loads(line) for line in records.read_text(encoding="utf-8").splitlines()]
    assert {attempt["rehearsal"] for attempt in attempts} == {run["id"] for run in told["runs"]}
    one = told["runs"][-1]
    command = shlex.split(one["replay"])
    assert command[:2] == ["cellc", "replay"]
    again = json.loads(run(*command[1:], "--json").out)
    assert [(again["runs"][0][key]) for key in ("id", "outcome", "digest")] == [
        one[key] for key in ("id", "outcome", "digest")
    ]


def test_list_prints_what_replay_takes(folders: dict[str, Path]) -> None:
    folder = str(folders["minimal"])
    names = run("campaign", folder, "--list", "--pairs", "2").out.splitlines()
    assert "ready/skip_cycles@1" in names
    assert sum("+" in name for name in names) == 2
    ran = run("replay", folder, names[-1], "skip_cycles@2")
    assert [line.split(":")[0] for line in ran.out.splitlines() if line.startswith("passed")] == [
        f"passed  {names[-1].split(':')[0]}",
        "passed  ready/skip_cycles@2",
    ]


def test_unknown_run_names_the_nearest(folders: dict[str, Path]) -> None:
    ran = run("replay", str(folders["minimal"]), "ready/skip_cycle@1")
    assert_refused(ran, "the nearest are `ready/skip_cycles@1`")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--jobs", "0"], "'--jobs': 0 is not in the range"),
        (["--jobs", "2", "--cluster", "tcp://127.0.0.1:1"], "--jobs cannot be combined with --cluster"),
        (["--pairs", "-1"], "the number of pairs is -1; it must be 0 or greater"),
        (["--seed", "-1"], "the seed is -1; it must be 0 or greater"),
        (["--rehearsal", "ready"], "No such option"),
        (["--list", "--evidence", "nowhere"], "--evidence cannot be combined with --list"),
        (["--list", "--records", "all.jsonl"], "--records cannot be combined with --list"),
    ],
)
def test_unusable_options_are_refused(folders: dict[str, Path], arguments: list[str], words: str) -> None:
    assert_refused(run("campaign", str(folders["minimal"]), *arguments), words)


@pytest.mark.parametrize("command", [("mock",), ("replay", "skip_cycles@1")])
def test_commands_of_the_mock_load_nothing_of_the_compiler(folders: dict[str, Path], command: tuple[str, ...]) -> None:
    arguments = [command[0], str(folders["minimal"]), *command[1:]]
    script = (
        f"import sys; from cellc.tools.cli.main import run; code = run({arguments!r}); "
        "print(code, [name for name in sys.modules if name.startswith('cellc.compiler')])"
    )
    ran = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "0 []"


def test_ctrl_c_ends_all_processes_with_one_line(folders: dict[str, Path]) -> None:
    command = [sys.executable, "-m", "cellc", "campaign", str(folders["fr3_hand"]), "--jobs", "2"]
    child = subprocess.Popen(
        command,
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # so that the signal reaches the workers too, as from a terminal
    )
    deadline = time.monotonic() + 120
    while len(_group(child.pid)) < 3 and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(child.pid, signal.SIGINT)
    out, err = child.communicate(timeout=120)
    assert child.returncode == 130, err
    assert (out, err) == ("", "error: interrupted; nothing was left half-written\n")
    while _group(child.pid) and time.monotonic() < deadline:
        time.sleep(0.05)  # the tracker of multiprocessing ends when it sees that its parent is gone
    assert _group(child.pid) == []


def _group(leader: int) -> list[int]:
    """Return the processes of a process group that are still there."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[2]) == leader and fields[0] != "Z":
            found.append(int(entry.name))
    return found


@pytest.mark.usefixtures("few_faults")
def test_failing_run_is_told_with_the_command_that_replays_it(
    folders: dict[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(TaskContext, "check_cell", lambda self: None)
    ran = run("campaign", str(folders["minimal"]), "--jobs", "1", "--seed", "7")
    assert ran.code == 1
    lines = ran.out.splitlines()
    failed = lines.index("FAILED  ready/protective_stop:arm@4: succeeded")
    assert lines[failed + 1] == "        expected: protective_stop"
    folder = shlex.quote(str(folders["minimal"]))
    assert lines[failed + 2] == f"        replay: cellc replay {folder} ready/protective_stop:arm@4 --seed 7"
    assert lines[-1].startswith("FAILED: ")
    matrix = next(line for line in lines if line.startswith("protective_stop:arm"))
    assert "!" in matrix


def test_replayed_run_leaves_its_evidence(folders: dict[str, Path], tmp_path: Path) -> None:
    name = "ready/protective_stop:arm@2"
    ran = run("replay", str(folders["minimal"]), name, name, "--evidence", str(tmp_path / "kept"))
    assert ran.code == 0, ran.err
    written = sorted(path.name for path in (tmp_path / "kept").iterdir())
    stem = quote(name, safe="")
    assert {f"{stem}.mcap", f"{stem}.records.jsonl", "report.html"} <= set(written)
    lines = (tmp_path / "kept" / f"{stem}.records.jsonl").read_text(encoding="utf-8").splitlines()
    assert json.loads(lines[-1])["outcome"] == "protective_stop"


def test_folder_whose_rehearsals_all_have_faults_has_no_campaign(folders: dict[str, Path], tmp_path: Path) -> None:
    folder = Path(shutil.copytree(folders["minimal"], tmp_path / "minimal"))
    rehearsals = json.loads((folder / "rehearsals.json").read_text(encoding="utf-8"))
    fault = {"kind": "skip_cycles", "target": "", "at_s": 0.0, "cycles": 1}
    rehearsals["rehearsals"] = [{**entry, "faults": [fault]} for entry in rehearsals["rehearsals"]]
    (folder / "rehearsals.json").write_text(json.dumps(rehearsals), encoding="utf-8")
    assert_refused(run("campaign", str(folder), "--edited"), "has no rehearsal without faults to run a campaign over")


@pytest.mark.usefixtures("few_faults")
@pytest.mark.parametrize("command", ["campaign", "gates"])
def test_report_shows_the_matrix_and_judges_gates_by_it(command: str, folders: dict[str, Path], tmp_path: Path) -> None:
    ran = run(command, str(folders["minimal"]), "--jobs", "1", "--evidence", str(tmp_path / "kept"))
    assert ran.code == 0, ran.err
    page = (tmp_path / "kept" / "report.html").read_text(encoding="utf-8")
    unwrapped = page.replace("<wbr>", "").replace("</wbr>", "").replace("<span>", "").replace("</span>", "")
    row = unwrapped.partition("<td>protective_stop:arm</td>")[2].partition("</tr>")[0]
    assert row.count(">stop<") == 4
    assert "ready/protective_stop:arm@2: protective_stop" in row
    line = page.partition("Every fault at every step ends in a named outcome within its bound")[2]
    assert "runs of the campaign" in line[:200]
    assert (tmp_path / "kept" / "ready.mcap").is_file()


@pytest.mark.parametrize(
    ("options", "now"),
    [
        (("--gates", "--sweep", "9"), "cellc gates FOLDER"),
        (("--gates",), "cellc gates FOLDER"),
        (("--replay", "x"), "cellc replay FOLDER RUN"),
        (("--sweep=9", "--evidence", "kept"), "cellc sweep FOLDER --runs N"),
        (("--journal", "x"), "cellc sweep FOLDER --journal FILE"),
        (("--campaign", "--list"), "cellc campaign FOLDER --list"),
        (("--seed", "7", "--campaign"), "cellc campaign FOLDER"),
        (("--campaign", "--pairs", "2"), "cellc campaign FOLDER --pairs N"),
    ],
)
def test_an_old_spelling_ends_with_one_line_that_names_the_command(options: tuple[str, ...], now: str) -> None:
    ran = run("mock", "nowhere", *options)
    assert (ran.code, ran.out, len(ran.err.splitlines())) == (2, "", 1)
    assert ran.err.endswith(f" any more: use `{now}`\n"), ran.err


@pytest.mark.parametrize("option", ["--evidence", "--records"])
def test_an_empty_path_is_refused_by_both_front_ends(folders: dict[str, Path], option: str) -> None:
    folder = str(folders["minimal"])
    assert_refused(run("mock", folder, option, ""), f"{option} cannot be written: its path is empty")
    alone = process(folder, option, "", module="cellc.mock")
    assert (alone.code, f"argument {option}: cannot be written: its path is empty" in alone.err) == (2, True)


@pytest.mark.parametrize("option", ["--jobs", "--cluster"])
def test_one_folder_needs_nobody_else(option: str) -> None:
    assert_refused(run("mock", "nowhere", option, "2"), f"{option} needs several folders")


def test_package_of_the_mock_loads_nothing_before_the_command_can_be_interrupted() -> None:
    script = (
        "import sys, cellc.mock; print('numpy' in sys.modules, 'pinocchio' in sys.modules, cellc.mock.load.__name__)"
    )
    ran = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert ran.stdout.split() == ["False", "False", "load"]


def test_closed_output_is_no_traceback(folders: dict[str, Path]) -> None:
    command = f'exec "{sys.executable}" -m cellc.mock "{folders["minimal"]}" >&-'
    ran = subprocess.run(["sh", "-c", command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")
