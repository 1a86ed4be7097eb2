"""Every command, with good and with bad input, where README's first command alone was run."""

from __future__ import annotations

import shlex
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.run import Ran
from tests.installed.install import Install, first_command

SPEC, BUILT = "cells/bench/cell.yaml", "generated/bench"
EVIDENCE = "error: `--evidence` needs the package `mcap`, which is not installed; install it with `"
LIVE = "error: `--live` needs the package `foxglove`, which is not installed; install it with `"
BAGS = "error: bag.mcap: no such file or folder"
CLUSTER = "error: `--cluster` needs the package `d"
NO_SPEC = "error[file-not-found]: there is no file `nothing.yaml`"

CALLS = (
    ("init bench arm=ur5e", 0, "wrote cells/bench/cell.yaml"),
    ("init other arm=nothing_such", 2, "Error: the catalog has no model `nothing_such`"),
    (f"check {SPEC}", 0, f"12 blockers, 1 warning in {SPEC}"),
    ("check nothing.yaml", 1, NO_SPEC),
    (f"check {SPEC} --cluster tcp://127.0.0.1:1", 2, CLUSTER),
    (f"build {SPEC}", 0, f"{BUILT}: "),
    ("build nothing.yaml", 1, NO_SPEC),
    (f"build {SPEC} --cluster tcp://127.0.0.1:1", 2, CLUSTER),
    (f"hook {SPEC}", 0, "1 cell up to date"),
    ("hook nothing.yaml", 1, NO_SPEC),
    (f"mock {BUILT}", 0, "passed  ready: succeeded"),
    ("mock nothing", 2, "error: nothing: no such folder; name one that `cellc build` wrote"),
    (f"mock {BUILT} --evidence evidence", 2, EVIDENCE),
    (f"campaign {BUILT} --evidence evidence", 2, EVIDENCE),
    (f"gates {BUILT} --evidence evidence", 2, EVIDENCE),
    (f"mock {BUILT} --live", 2, LIVE),
    (f"campaign {BUILT} --cluster tcp://127.0.0.1:1", 2, CLUSTER),
    (f"sweep {BUILT} --cluster tcp://127.0.0.1:1", 2, CLUSTER),
    (f"campaign {BUILT} --list", 0, "ready/cancel"),
    ("campaign nothing", 2, "error: nothing: no such folder"),
    ("sweep --help", 0, "Maximum number of runs of each rehearsal."),
    ("gates --help", 0, "Run the rehearsals and the campaign"),
    (f"sweep {BUILT}", 2, "the folder has no `config/uncertainty.json`"),
    (f"replay {BUILT} skip_cycles@1", 0, "passed  ready/skip_cycles@1"),
    (f"replay {BUILT} nothing", 2, "there is no run `nothing`"),
    ("gates nothing", 2, "error: nothing: no such folder"),
    ("mock cells --matrix ros=jazzy --cluster tcp://127.0.0.1:1", 2, CLUSTER),
    (f"attempt bag.mcap --package {BUILT}", 2, BAGS),
    (f"view {BUILT} --bag bag.mcap", 2, BAGS),
    ("attempt --help", 0, "print its record and the layer"),
    (f"evidence {BUILT} --package {BUILT}", 1, "14 gates: 0 complete"),
    ("evidence nothing", 2, "error: nothing: no such folder"),
    ("evidence --help", 0, "Nothing is signed"),
    (f"audit {SPEC}", 0, "Cell bench."),
    ("audit nothing.yaml", 1, NO_SPEC),
    ("catalog ur5e", 0, "# `ur5e`"),
    ("catalog nothing_such", 1, "error: no device of the catalog meets all of these"),
    (f"compare {SPEC} {SPEC}", 0, "bench"),
    (f"compare {SPEC} nothing.yaml", 1, NO_SPEC),
    ("completion bash", 0, "complete -o nosort"),
    ("completion tcsh", 2, "'tcsh' is not one of 'bash', 'zsh', 'fish'"),
    ("diagnose robot does not move", 0, "look at"),
    ("diagnose --log cells", 0, "no known symptom"),
    ("diagnose --log nothing", 2, "error: nothing: no such file or folder"),
    ("diagnose xyzzy", 1, "UNKNOWN: no known symptom fits"),
    (f"diff {SPEC} {BUILT}", 0, "no change"),
    (f"diff {BUILT} nothing", 2, "there is no file or folder `nothing`"),
    ("explain missing-unit", 0, "# missing-unit"),
    ("explain zero-axis", 0, "# zero-axis (error)"),
    ("explain missing-unitt", 2, "did you mean `missing-unit`"),
    (f"format {SPEC}", 0, "1 file is in canonical form"),
    ("format my_arm.urdf", 1, "error[not-yaml]"),
    ("import my_arm.urdf -o my_robot", 0, "wrote my_robot"),
    ("import cells -o other_robot", 1, "refused: `cells` holds no URDF or xacro file"),
    ("lsp --help", 0, "Run the language server"),
    ("lsp", 2, "error: `cellc lsp` needs the package `lsprotocol`, which is not installed; install it with `"),
    ("schema device", 0, '"title": "Device"'),
    ("schema nothing", 2, "there is no schema `nothing`"),
    (f"show {SPEC} devices.arm.model", 0, "devices.arm.model  ur5e"),
    (f"show {SPEC} devices.leg", 2, "there is no `leg` in `devices`"),
    (f"upgrade {SPEC} --ros jazzy", 0, "bench: jazzy to jazzy"),
    (f"upgrade {SPEC} --ros galactic", 2, "'galactic' is not one of"),
    (f"view {SPEC}", 0, "wrote bench.html"),
    (f"view {BUILT} -o folder.html", 0, "wrote folder.html"),
    ("view my_arm.urdf -o robot.html", 0, "wrote robot.html"),
    ("view nothing.yaml", 2, "error: nothing.yaml: there is no such file or folder"),
    ("watch nothing.yaml", 2, "Error: there is no file or folder `nothing.yaml`"),
    ("watch --help", 0, "until Ctrl-C"),
)
"""Words of the call, exit code, and what one line of the answer has."""


@pytest.fixture(scope="module", name="folder")
def folder_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("newcomer")


@pytest.fixture(scope="module", name="ran")
def ran_fixture(readme_install: Install, folder: Path) -> dict[str, Ran]:
    shutil.copy(ROOT / "tests/corpus/valid/parts/lift/lift.urdf", folder / "my_arm.urdf")
    answers = readme_install.calls([shlex.split(words) for words, _, _ in CALLS], folder)
    return {words: answer for (words, _, _), answer in zip(CALLS, answers, strict=True)}


def test_first_command_of_readme_installs_builds_and_rehearses(readme_install: Install) -> None:
    told = readme_install.told
    assert told.code == 0, told.err
    assert "passed  pick_and_place: succeeded" in told.out


@pytest.mark.parametrize(("words", "code", "said"), CALLS, ids=[words for words, _, _ in CALLS])
def test_command_answers_without_any_extra(words: str, code: int, said: str, ran: dict[str, Ran]) -> None:
    answer = ran[words]
    text = answer.out + answer.err
    assert answer.code == code, text
    assert sum(said in line for line in text.splitlines()) == 1 or code == 0
    assert said in text
    assert "Traceback" not in text
    assert "bug of cellc" not in text


def test_every_command_stands_in_the_table(readme_install: Install) -> None:
    for command in readme_install.commands():
        codes = [code for words, code, _ in CALLS if f"{words} ".startswith(f"{command} ")]
        assert 0 in codes, f"{command} has no good call"
        assert {1, 2} & set(codes), f"{command} has no bad call"


def test_what_a_missing_package_asks_for_is_the_interpreter_of_cellc(
    readme_install: Install, ran: dict[str, Ran]
) -> None:
    for words, _, said in CALLS:
        if "needs the package" in said:
            (line,) = ran[words].err.splitlines()
            assert f"`{readme_install.python} -m pip install '" in line


@pytest.mark.usefixtures("ran")
@pytest.mark.parametrize("page", ["bench.html", "folder.html"])
def test_page_of_view_plays_the_rehearsals(page: str, folder: Path) -> None:
    text = (folder / page).read_text(encoding="utf-8")
    assert "ready: succeeded" in text or '"ready"' in text


def test_watch_checks_until_it_is_interrupted(readme_install: Install, tmp_path: Path) -> None:
    assert readme_install.calls([["init", "bench", "arm=ur5e"]], tmp_path)[0].code == 0
    command = [str(readme_install.python.with_name("cellc")), "watch", SPEC]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as watch:
        assert watch.stdout is not None
        text = ""
        for line in watch.stdout:
            text += line
            if " blockers, " in line:  # the last line of a check, whatever it counts
                break
        watch.send_signal(signal.SIGINT)
        text += watch.stdout.read()
    assert watch.returncode == 130, text
    assert "12 blockers, 1 warning" in text
    assert "Traceback" not in text


def test_first_command_needs_nothing_but_python() -> None:
    assert first_command().startswith("python3 -m venv .venv && .venv/bin/pip install -q . && ")
