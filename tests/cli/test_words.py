"""What a shell completes, asked as its script asks."""

from __future__ import annotations

import json
import shlex
import subprocess
from pathlib import Path

import click
import pytest
from click.shell_completion import ShellComplete

from cellc.compiler.catalog.load import device_names
from cellc.compiler.pages import all_codes
from cellc.tools.cli.main import cellc
from tests.cells import generated
from tests.cli.run import run


def _completed(arguments: list[str], incomplete: str) -> list[str]:
    command: click.Command = cellc
    return [
        item.value
        for item in ShellComplete(command, {}, "cellc", "_CELLC_COMPLETE").get_completions(arguments, incomplete)
    ]


def test_codes_are_completed() -> None:
    assert _completed(["explain"], "unread-") == [code for code in all_codes() if code.startswith("unread-")]


def test_the_last_code_of_several_is_completed() -> None:
    assert "missing-unit,unread-topic" in _completed(["check", "--select"], "missing-unit,unread-t")


@pytest.mark.parametrize(("command", "begun"), [(["init", "bench"], "arm="), (["catalog"], "")])
def test_models_are_completed(command: list[str], begun: str) -> None:
    assert set(_completed(command, begun)) == {f"{begun}{name}" for name in device_names()}


def test_rehearsals_of_the_folder_are_completed() -> None:
    assert _completed(["mock", generated("minimal").as_posix(), "--rehearsal"], "") == ["ready"]


@pytest.mark.parametrize("option", ["--task", "--against"])
def test_rehearsals_of_the_package_of_a_bag_are_completed(option: str) -> None:
    package = generated("minimal").as_posix()
    assert _completed(["attempt", "bag.mcap", "--package", package, option], "") == ["ready"]
    assert _completed(["view", package, "--bag", "bag.mcap", option], "") == ["ready"]


def test_the_rehearsal_of_a_run_is_completed_first_where_a_campaign_disturbs_several(tmp_path: Path) -> None:
    told = json.loads((generated("ur5e_pick") / "rehearsals.json").read_text(encoding="utf-8"))
    plain = next(rehearsal for rehearsal in told["rehearsals"] if rehearsal["name"] == "pick_and_place")
    told["rehearsals"].append({**plain, "name": "place"})
    (tmp_path / "rehearsals.json").write_text(json.dumps(told), encoding="utf-8")
    # Of the others each has faults of its own, or the bring-up of the real target.
    assert _completed(["replay", tmp_path.as_posix()], "") == ["pick_and_place/", "place/"]


def test_runs_of_the_only_rehearsal_are_those_of_the_list() -> None:
    folder = generated("minimal").as_posix()
    listed = run("campaign", folder, "--list").out.split()
    assert _completed(["replay", folder], "") == listed
    some = listed[3][: listed[3].index(":") + 1]
    assert _completed(["replay", folder], some) == [entry for entry in listed if entry.startswith(some)]


def test_runs_of_a_journal_are_completed_and_those_that_failed_come_first(tmp_path: Path) -> None:
    journal = tmp_path / "runs.jsonl"
    runs = ["{}", *(json.dumps({"number": number, "passed": number != 11}) for number in (1, 10, 11))]
    journal.write_text("\n".join(runs), encoding="utf-8")
    arguments = ["replay", generated("minimal").as_posix(), "--journal", str(journal)]
    assert _completed(arguments, "sweep:1") == ["sweep:11", "sweep:1", "sweep:10"]
    journal.write_text("[", encoding="utf-8")
    assert _completed(arguments, "sweep:") == []


# As readline 8.2 of bash 5.2 hands over a word with its breaks, which was looked at in a terminal.
_READLINE = [
    ("cellc replay out a/delay:arm@", ["a/delay", ":", "arm", "@"], "a/delay:arm@1", "1"),
    ("cellc replay 'my out' a/del", ["a/del"], "a/delay:arm@1", "a/delay:arm@1"),
    ("cellc init bench arm=", ["arm", "="], "arm=ur5e", "ur5e"),
    ("cellc check --select missing-unit,un", ["missing-unit,un"], "missing-unit,unread", "missing-unit,unread"),
    ("cellc mock ", [""], "generated", "generated"),
]


@pytest.mark.parametrize(("line", "last", "answer", "put_in"), _READLINE)
def test_bash_asks_about_whole_words_and_puts_in_what_is_missing(
    line: str, last: list[str], answer: str, put_in: str
) -> None:
    asked = line.rpartition(" ")[2]
    words = [*shlex.split(line[: len(line) - len(asked)], posix=False), *last]
    script = f"""{run("completion", "bash").out}
cellc() {{ printf 'plain,%s\\n' {shlex.quote(answer)}; echo "plain,$COMP_WORDS|$COMP_CWORD"; }}
COMP_LINE={shlex.quote(line)} COMP_POINT={len(line)} COMP_CWORD={len(words) - 1}
COMP_WORDS=({" ".join(map(shlex.quote, words))})
_cellc_completion cellc
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    told = subprocess.run(["bash", "--norc", "-c", script], capture_output=True, text=True, check=True)
    number = len(words) - len(last)
    assert told.stdout.splitlines() == [put_in, f"{line}|{number}"]


def test_folder_that_cannot_be_read_has_nothing_to_complete(tmp_path: Path) -> None:
    (tmp_path / "rehearsals.json").write_text("[", encoding="utf-8")
    assert _completed(["mock", tmp_path.as_posix(), "--rehearsal"], "") == []
    assert _completed(["mock", (tmp_path / "nowhere").as_posix(), "--rehearsal"], "") == []
