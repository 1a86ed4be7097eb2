"""Runs the pages as a reader would: edits are made, commands run, and each block states what must come out.

Above a block of `console` or `sh` stands one comment for each of its commands:

    <!-- exit 1: 1 error in cell.yaml -->     its exit code, and a text that it must print
    <!-- exit 0: nothing -->                  it must print nothing
    <!-- not run: REASON -->                  nobody runs it here, and why; its options must exist

`python -m tests.docs.pages` writes what is printed now into the pages, or into those that are named. It refuses what a
block does not state: another exit code, an output without its text, and an error that no block expects.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import click
import pytest

from cellc.tools.cli.main import cellc
from tests.cells import ROOT
from tests.cli.run import Ran
from tests.cli.run import run as run_command

_BLOCK = re.compile(
    r"^(?P<stated>(?:<!-- (?:exit \d+|not run): [^\n]* -->\n)*)```(?P<kind>console|sh|diff)\n(?P<text>.*?)^```",
    re.DOTALL | re.MULTILINE,
)
_STATED = re.compile(r"<!-- (?:exit (?P<code>\d+)|not run): (?P<claim>.*) -->")
_TIMES = re.compile(r"in \d+\.\d+ s( \(\d+ x real time\))?")
_SHELL = re.compile(r"[<>;&$`]")
_COMMENT = re.compile(r" +# .*")
_SELECTS = ("--select", "--ignore")
_NEVER = ("traceback", "no such", "cannot access", "bug of cellc", "command not found")
"""What no output has unless the block claims it."""


class RefusedError(AssertionError):
    """A page shows what its blocks do not state."""


@dataclass(frozen=True, slots=True)
class Command:
    """One command of a block with what it must come to; the exit code is None where it is not run."""

    text: str
    code: int | None
    claim: str


def rerun(page: str, folder: Path) -> str:
    """Return the page with the output that its commands print in a folder; a measured time is left as it was.

    Raises:
        RefusedError: a command comes to something that its block does not state.
    """

    def run(match: re.Match[str]) -> str:
        if match["kind"] == "diff":
            _edit(folder, match["text"])
            return match[0]
        shown = [(command, _shown(command, folder)) for command in commands(match)]
        if match["kind"] == "sh":
            return match[0]
        printed = "".join(f"$ {command.text}\n{output}" for command, output in shown)
        same = _TIMES.sub("", printed) == _TIMES.sub("", match["text"])
        return match[0] if same else f"{match['stated']}```console\n{printed}```"

    return _BLOCK.sub(run, page)


def blocks(page: str) -> Iterator[re.Match[str]]:
    """Yield the blocks of a page that have commands."""
    return (match for match in _BLOCK.finditer(page) if match["kind"] != "diff")


def commands(block: re.Match[str]) -> list[Command]:
    """Return the commands of a block, each with what is stated of it.

    Raises:
        RefusedError: there are more commands than statements, or fewer.
    """
    lines = block["text"].splitlines()
    if block["kind"] == "console":
        texts = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    else:
        texts = [_COMMENT.sub("", line) for line in lines if line and not line.startswith("#")]
    stated = list(_STATED.finditer(block["stated"]))
    if len(stated) != len(texts):
        raise RefusedError(f"{len(texts)} commands have {len(stated)} statements above their block:\n{block['text']}")
    return [
        Command(text, None if said["code"] is None else int(said["code"]), said["claim"])
        for text, said in zip(texts, stated, strict=True)
    ]


def _shown(command: Command, folder: Path) -> str:
    if command.code is None:
        _hold_options(command.text)
        return ""
    ran = _ran(command.text, folder)
    output = ran.out + ran.err
    problem = _problem(command, ran.code, output)
    if not problem and any(option in command.text for option in _SELECTS):
        problem = _hidden(command.text, output, folder)
    if problem:
        raise RefusedError(f"$ {command.text}\n{output}{problem}")
    return output


def _problem(command: Command, code: int, output: str) -> str:
    """Return how the output differs from what is stated."""
    if code != command.code:
        return f"it ended with {code}, and `exit {command.code}` is stated"
    if command.claim == "nothing":
        return "it printed something, and `nothing` is stated" if output else ""
    if command.claim not in output:
        return f"it did not print `{command.claim}`"
    never = [text for text in _NEVER if text in output.lower() and text not in command.claim.lower()]
    return f"it printed `{never[0]}`, which is not stated" if never else ""


def _hidden(text: str, output: str, folder: Path) -> str:
    """Return that errors are left out of what a page shows."""
    words = re.sub(rf" (?:{'|'.join(_SELECTS)}) \S+", "", text)
    every = _ran(words, folder).out
    hidden = every.count("\nerror[") - output.count("\nerror[")
    return f"{hidden} errors are hidden by `--select` or `--ignore`" if hidden else ""


def _hold_options(text: str) -> None:
    """Refuse a command that is not run where cellc does not take its words."""
    if not text.startswith("cellc ") or _SHELL.search(text):
        return
    name, *words = shlex.split(text)[1:]
    found = cellc.get_command(click.Context(cellc), name)
    if found is None:
        raise RefusedError(f"$ {text}\nthere is no command `{name}`")
    try:
        found.make_context(name, words)
    except click.ClickException as problem:
        raise RefusedError(f"$ {text}\n{problem.format_message()}") from None


def _edit(folder: Path, diff: str) -> None:
    """Make an edit: what is unchanged or taken out must stand in the file once."""
    head, *lines = diff.splitlines(keepends=True)
    file = folder / head.removeprefix("--- ").strip()
    before = "".join(line[1:] for line in lines if line[0] in " -")
    after = "".join(line[1:] for line in lines if line[0] in " +")
    text = file.read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{before!r} stands {text.count(before)} times in {file.name}"
    file.write_text(text.replace(before, after), encoding="utf-8")


def _ran(command: str, folder: Path) -> Ran:
    """Run a command: `cellc` in this process, what its output is piped through, and everything else, by a shell."""
    program, pipe, rest = command.partition(" | ")
    if not program.startswith("cellc ") or _SHELL.search(program):
        return _shell(command, folder, "")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        ran = run_command(*shlex.split(program)[1:])
    if not pipe:
        return ran
    piped = _shell(rest, folder, ran.out)
    return Ran(piped.code or ran.code, piped.out, ran.err + piped.err)


def _shell(command: str, folder: Path, text: str) -> Ran:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", command],
        cwd=folder,
        env=os.environ | {"LC_ALL": "C.UTF-8", "PATH": path},
        input=text,
        capture_output=True,
        text=True,
        check=False,
    )
    return Ran(done.returncode, done.stdout, done.stderr)


def _empty(folder: Path) -> None:
    assert not any(folder.iterdir())


def _with_a_robot(folder: Path) -> None:
    shutil.copy(ROOT / "tests/corpus/valid/parts/lift/lift.urdf", folder / "my_arm.urdf")


def _with_a_bench(folder: Path) -> None:
    assert _ran("cellc init bench arm=ur5e", folder).code == 0


def _with_the_cells(folder: Path) -> None:
    """Give what a clone has, and a copy of a cell in which three lines were changed for the worse."""
    for name in ("cells", "generated"):
        shutil.copytree(ROOT / name, folder / name)
    text = (folder / "cells/ur5e_pick/cell.yaml").read_text(encoding="utf-8")
    for before, after in _WORSE:
        assert text.count(before) == 1, before
        text = text.replace(before, after)
    (folder / "cell.yaml").write_text(text, encoding="utf-8")


_WORSE = (
    ("    max_age: 100 ms\n", "    max_age: 20 ms\n"),
    (
        "from: {perception: {reliability: reliable, depth: 1}}",
        "from: {perception: {reliability: best_effort, depth: 1}}",
    ),
    ("home: {manipulator: 0 -90 90 -90 -90 0 deg}", "home: {manipulator: 0 -90 190 -90 -90 0 deg}"),
)


def _with_history(folder: Path) -> None:
    """Give a repository with two commits on a branch of `main`, of which the last one slows the arm."""
    for name in ("cells/ur5e_pick", "generated/ur5e_pick"):
        shutil.copytree(ROOT / name, folder / name)
    commit = "git add -A && git -c user.name=a -c user.email=a@example.org commit -qm"
    spec = "cells/ur5e_pick/cell.yaml"
    for line in (
        f"git init -qb main && {commit} first && git switch -qc slower",
        f"sed -i 's/velocity: 50 %/velocity: 40 %/' {spec} && {commit} slower",
        f"sed -i 's/acceleration: 50 %/acceleration: 40 %/' {spec}",
    ):
        done = _shell(line, folder, "")
        assert done.code == 0, done.err


def _with_a_plant(folder: Path) -> None:
    shutil.copytree(ROOT / "tests" / "plant" / "hall", folder / "hall")


PAGES: dict[str, Callable[[Path], None]] = {
    "CONTRIBUTING.md": _empty,
    "README.md": _with_the_cells,
    "docs/editor.md": _with_a_bench,
    "docs/index.md": _empty,
    "docs/mock.md": _with_the_cells,
    "docs/own_robot.md": _with_a_robot,
    "docs/plant.md": _with_a_plant,
    "docs/review.md": _with_history,
    "docs/tutorial.md": _empty,
}
"""Each page with what its reader's folder has."""


def rerun_page(name: str, folder: Path) -> str:
    """Return a page with the output that its commands print, in a folder as its reader has it."""
    PAGES[name](folder)
    return rerun((ROOT / name).read_text(encoding="utf-8"), folder)


if __name__ == "__main__":
    for shown in sys.argv[1:] or PAGES:
        with tempfile.TemporaryDirectory() as place:
            (ROOT / shown).write_text(rerun_page(shown, Path(place)), encoding="utf-8")
