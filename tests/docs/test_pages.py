"""Every page says what happens, and states what must."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.docs.pages import PAGES, RefusedError, blocks, commands, rerun, rerun_page

RUN_ELSEWHERE = {"docs/rules/": "tests/rules/test_stage_examples.py runs the blocks of its pages"}


@pytest.mark.parametrize("name", sorted(PAGES))
def test_every_command_of_a_page_prints_what_the_page_shows(name: str, tmp_path: Path) -> None:
    # Written by `python -m tests.docs.pages`.
    assert rerun_page(name, tmp_path) == (ROOT / name).read_text(encoding="utf-8")


def test_every_page_with_a_command_is_run() -> None:
    listed = subprocess.run(
        ["git", "ls-files", "*.md", ":!generated", ":!tests"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    texts = {name: (ROOT / name).read_text(encoding="utf-8") for name in listed.stdout.split()}
    with_commands = {name for name, text in texts.items() if re.search(r"^ *```(console|sh|bash)", text, re.MULTILINE)}
    assert {name for name in with_commands if not name.startswith(tuple(RUN_ELSEWHERE))} <= {*PAGES}
    assert not [name for name, text in texts.items() if re.search(r"^ *(```|~~~)text\n *\$ ", text, re.MULTILINE)]


@pytest.mark.parametrize("name", sorted(PAGES))
def test_every_fence_of_commands_is_read(name: str) -> None:
    page = (ROOT / name).read_text(encoding="utf-8")
    found = list(blocks(page))
    assert len(found) == len(re.findall(r"```(?:console|sh|bash)", page))
    for block in found:
        assert commands(block)


@pytest.mark.parametrize(
    ("stated", "command", "said"),
    [
        ("", "cellc explain missing-unit", "1 commands have 0 statements"),
        ("exit 0: bench\nexit 0: more", "cellc explain missing-unit", "1 commands have 2 statements"),
        ("exit 0: no such", "cellc check nothing.yaml", "it ended with 1, and `exit 0` is stated"),
        ("exit 1: no such code", "cellc mock nothing", "it ended with 2, and `exit 1` is stated"),
        ("exit 0: passed", "cellc explain missing-unit", "it did not print `passed`"),
        ("exit 0: nothing", "cellc explain missing-unit", "it printed something, and `nothing` is stated"),
        ("exit 2: error", "cellc mock nothing", "it printed `no such`, which is not stated"),
        ("exit 2: ls", "ls nothing", "it printed `no such`, which is not stated"),
        ("exit 0: end", "printf 'Traceback (most recent call last)\\nend\\n'", "it printed `traceback`, which is not"),
        ("exit 0: a", "echo 'this is a bug of cellc'", "it printed `bug of cellc`, which is not stated"),
        ("exit 0: 1", "false | wc -l", "it ended with 1, and `exit 0` is stated"),
        ("exit 1: 1 error", "cellc check cell.yaml --select QOS", "2 errors are hidden by `--select` or `--ignore`"),
        ("not run: it takes long", "cellc mock generated --no-such-option", "No such option"),
        ("not run: it takes long", "cellc dance", "there is no command `dance`"),
    ],
)
def test_a_block_that_shows_something_else_than_it_states_is_refused(
    stated: str, command: str, said: str, tmp_path: Path
) -> None:
    if "cell.yaml" in command:
        PAGES["README.md"](tmp_path)
    lines = "".join(f"<!-- {line} -->\n" for line in stated.splitlines())
    with pytest.raises(RefusedError, match=re.escape(said)):
        rerun(f"{lines}```console\n$ {command}\n```\n", tmp_path)


def test_a_block_that_shows_what_it_states_is_written(tmp_path: Path) -> None:
    stated = "<!-- exit 2: no such folder -->\n<!-- exit 0: 2 -->\n"
    page = rerun(f"{stated}```console\n$ cellc mock nothing\n$ echo $((1 + 1))\n```\n", tmp_path)
    assert page.startswith(f"{stated}```console\n$ cellc mock nothing\nerror: nothing: no such folder;")
    assert page.endswith("\n$ echo $((1 + 1))\n2\n```\n")


def test_tutorial_has_ten_steps() -> None:
    steps = re.findall(r"^## Step (\d+): ", (ROOT / "docs/tutorial.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert steps == [str(number) for number in range(1, 11)]
