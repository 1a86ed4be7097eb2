"""Every code of the spec and of its links shows an example, which is reported where it is marked and nowhere else."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.compiler.source.read import read
from cellc.contract.code_page import page_of
from cellc.contract.codes import STAGES
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.xacro_expansion import expand_here
from tests.cells import spec_text, there, written
from tests.cli.run import MINIMAL, run
from tests.rules.examples import Example, Place, diagnose_example, matches, places

# What nothing shows: the catalog has no such kind, the readers before it refuse so large a file, two
# hundred thousand lines take seconds, a call an hour, two builds at a time are
# no example, and the last are bugs of cellc itself.
WITHOUT = re.compile(r"controller-not-in-distro|xml-too-large|too-many-values|command-too-long|output-busy|verify-.*")


_FENCE = re.compile(r"```(?:yaml|xml|console)\n(.*?)```", re.DOTALL)


def _examples(*stages: str, session: bool = False) -> dict[str, str]:
    """Return by code the examples of stages that are commands of a shell, or those that are the text of a file."""
    fences = {code: _FENCE.search(page_of(code).text) for stage in stages for code in STAGES[stage]}
    texts = {code: fence[1] for code, fence in fences.items() if fence is not None}
    return {code: text for code, text in texts.items() if text.startswith("$ ") is session}


def _each(examples: dict[str, str]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(("code", "text"), examples.items(), ids=examples)


def test_every_code_has_an_example_where_something_can_show_it() -> None:
    shown = {*_examples(*STAGES), *_examples(*STAGES, session=True)}
    without = {code for codes in STAGES.values() for code in codes} - shown
    assert [code for code in sorted(without) if not WITHOUT.fullmatch(code)] == []


@_each(_examples(*STAGES, session=True))
def test_commands_of_an_example_lead_to_the_code(
    code: str, text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(MINIMAL, "cell.yaml")
    shown = ""
    for command in text.strip().removeprefix("$ ").split("\n$ "):
        if command.startswith("cellc "):
            assert f"[{code}]" not in shown
            ran = run(*shlex.split(command)[1:])
            shown = ran.out + ran.err
        else:
            subprocess.run(["sh", "-c", command], check=True)
    assert f"[{code}]" in shown


@_each(_examples("spec", "link"))
def test_example_of_a_stage_is_reported_at_its_mark_and_nowhere_else(code: str, text: str, folder: Path) -> None:
    example = Example("yaml", text)
    lines = enumerate(example.text.splitlines(), start=1)
    marked = [(number, mark[1]) for number, line in lines if (mark := re.search("# expect at (.+)", line))]
    expected = [Place(code, number, key) for number, key in marked]
    found = places(diagnose_example(example, folder), example, folder)
    assert len(found) == len(expected) > 0
    assert all(matches(one, wanted) for one, wanted in zip(found, expected, strict=True)), found


@_each(_examples("source"))
def test_example_of_a_file_is_reported_at_its_mark_and_nowhere_else(code: str, text: str, tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(text, encoding="utf-8")
    found = [(diagnostic.code, diagnostic.span.line) for diagnostic in read(file).diagnostics]
    assert found == [(code, number) for number, line in enumerate(text.splitlines(), 1) if "# expect" in line]


@_each(_examples("catalog"))
def test_example_of_a_description_is_reported_at_its_mark_and_nowhere_else(
    code: str, text: str, tmp_path: Path
) -> None:
    if "xmlns:xacro" in text:
        file = tmp_path / "arm.urdf.xacro"
        file.write_text(text, encoding="utf-8")
        diagnostics = expand_here(file.as_posix(), {}, tmp_path.as_posix(), tmp_path.as_posix()).diagnostics
    else:
        diagnostics = read_urdf(text, "arm.urdf", from_user=True).diagnostics
    found = [(diagnostic.code, diagnostic.span.line) for diagnostic in diagnostics]
    assert found == [(code, number) for number, line in enumerate(text.splitlines(), 1) if "expect -->" in line]


@_each(_examples("ignores"))
def test_example_of_a_comment_is_reported_on_its_line(code: str, text: str, tmp_path: Path) -> None:
    section, line = text.rstrip("\n").split("\n")
    spec = spec_text("ur5e_pick")
    start = there(re.search(rf"^{section}", spec, re.MULTILINE))
    after, times = re.subn(rf"^{line.partition(':')[0]}: .*$", line, spec[start.end() :], count=1, flags=re.MULTILINE)
    assert times == 1
    spec = spec[: start.end()] + after
    number = spec[: spec.index(line)].count("\n") + 1
    found = check(written(tmp_path, spec)).diagnostics
    assert [finding.span.line for finding in found if finding.code == code] == [number]
