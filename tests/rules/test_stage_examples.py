"""Every code of the spec and of its links shows an example, which is reported where it is marked and nowhere else."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from cellc.compiler.pages import STAGES, render_page
from cellc.compiler.pipeline import check
from cellc.compiler.source.read import read
from cellc.contract.diagnostics.diagnostic import CodePage
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.xacro_expansion import expand_here
from tests.cells import spec_text, written
from tests.cli.run import MINIMAL, run
from tests.rules.examples import Example, Place, diagnose_example, matches, places

_SHOWN_MARK = re.compile(r"(?:#|<!--) expect(?: at| -->|$)", re.MULTILINE)
# What nothing shows: the catalog has no such kind, the readers before it refuse so large a file, two
# hundred thousand lines take seconds, a call an hour, two builds at a time are
# no example, and the last are bugs of cellc itself.
WITHOUT = re.compile(r"controller-not-in-distro|xml-too-large|too-many-values|command-too-long|output-busy|verify-.*")


def _pages(*stages: str, session: bool = False) -> list[CodePage]:
    pages = [page for stage in stages for page in STAGES[stage] if page.example]
    return [page for page in pages if page.example.lstrip().startswith("$ ") is session]


def test_every_code_has_an_example_where_something_can_show_it() -> None:
    without = [page.code for stage in STAGES.values() for page in stage if not page.example]
    assert [code for code in without if not WITHOUT.fullmatch(code)] == []


@pytest.mark.parametrize("page", _pages(*STAGES, session=True), ids=lambda page: page.code)
def test_commands_of_an_example_lead_to_the_code(
    page: CodePage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(MINIMAL, "cell.yaml")
    shown = ""
    for command in page.example.strip().removeprefix("$ ").split("\n$ "):
        if command.startswith("cellc "):
            assert f"[{page.code}]" not in shown
            ran = run(*shlex.split(command)[1:])
            shown = ran.out + ran.err
        else:
            subprocess.run(["sh", "-c", command], check=True)
    assert f"[{page.code}]" in shown


@pytest.mark.parametrize("page", _pages("spec", "link"), ids=lambda page: page.code)
def test_example_of_a_stage_is_reported_at_its_mark_and_nowhere_else(page: CodePage, folder: Path) -> None:
    example = Example("yaml", page.example.lstrip("\n"))
    lines = enumerate(example.text.splitlines(), start=1)
    marked = [(number, mark[1]) for number, line in lines if (mark := re.search("# expect at (.+)", line))]
    expected = [Place(page.code, number, key) for number, key in marked]
    found = places(diagnose_example(example, folder), example, folder)
    assert len(found) == len(expected) > 0
    assert all(matches(one, wanted) for one, wanted in zip(found, expected, strict=True)), found


def test_marks_of_an_example_are_not_shown() -> None:
    pages = [page for stage in STAGES.values() for page in stage]
    assert [page.code for page in pages if _SHOWN_MARK.search(render_page(page))] == []


@pytest.mark.parametrize("page", _pages("source"), ids=lambda page: page.code)
def test_example_of_a_file_is_reported_at_its_mark_and_nowhere_else(page: CodePage, tmp_path: Path) -> None:
    text = page.example.lstrip("\n")
    file = tmp_path / "cell.yaml"
    file.write_text(text, encoding="utf-8")
    found = [(one.code, one.span.line) for one in read(file).diagnostics]
    assert found == [(page.code, number) for number, line in enumerate(text.splitlines(), 1) if "# expect" in line]


@pytest.mark.parametrize("page", _pages("catalog"), ids=lambda page: page.code)
def test_example_of_a_description_is_reported_at_its_mark_and_nowhere_else(page: CodePage, tmp_path: Path) -> None:
    text = page.example.lstrip("\n")
    if "xmlns:xacro" in text:
        file = tmp_path / "arm.urdf.xacro"
        file.write_text(text, encoding="utf-8")
        diagnostics = expand_here(file.as_posix(), {}, tmp_path.as_posix(), tmp_path.as_posix()).diagnostics
    else:
        diagnostics = read_urdf(text, "arm.urdf", from_user=True).diagnostics
    found = [(one.code, one.span.line) for one in diagnostics]
    assert found == [(page.code, number) for number, line in enumerate(text.splitlines(), 1) if "expect -->" in line]


@pytest.mark.parametrize("page", STAGES["ignores"], ids=lambda page: page.code)
def test_example_of_a_comment_is_reported_on_its_line(page: CodePage, tmp_path: Path) -> None:
    section, line = page.example.strip("\n").split("\n")
    text = spec_text("ur5e_pick")
    start = re.search(rf"^{section}", text, re.MULTILINE)
    assert start is not None
    after, times = re.subn(rf"^{line.partition(':')[0]}: .*$", line, text[start.end() :], count=1, flags=re.MULTILINE)
    assert times == 1
    text = text[: start.end()] + after
    number = text[: text.index(line)].count("\n") + 1
    found = check(written(tmp_path, text)).diagnostics
    assert [one.span.line for one in found if one.code == page.code] == [number]
