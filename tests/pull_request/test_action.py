"""action.yml: its steps are run by bash as GitHub runs them, and no text of a pull request is a part of a script."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.pull_request.action import run_step
from tests.pull_request.conftest import git


def test_wrong_cell_is_annotated_at_its_line_and_told_to_code_scanning(repository: Path) -> None:
    file = repository / "cells/line/cell.yaml"
    file.write_text(file.read_text().replace("100 Hz", "100"), encoding="utf-8")
    code, out, _ = run_step(repository, "Check", sarif="cellc.sarif")
    assert code == 1
    line = file.read_text().splitlines().index("  update_rate: 100") + 1
    assert re.search(rf"^::error .*file=cells/line/cell.yaml,.*line={line}", out, re.MULTILINE)
    assert '"ruleId"' in (repository / "cellc.sarif").read_text()


@pytest.mark.parametrize("name", ["cellc.sarif", "out/cellc.sarif"])
def test_findings_are_not_written_through_a_link_of_the_branch(name: str, repository: Path) -> None:
    elsewhere = repository.parent / "elsewhere"
    elsewhere.mkdir()
    if "/" in name:
        (repository / "out").symlink_to(elsewhere)
    else:
        (repository / name).symlink_to(elsewhere / "file")
    code, out, _ = run_step(repository, "Check", sarif=name)
    assert (code, "is a symbolic link" in out) == (2, True), out
    assert not list(elsewhere.iterdir())


def test_only_what_is_new_or_fails_is_annotated_against_the_base(repository: Path) -> None:
    base = git(repository, "rev-parse", "HEAD").strip()
    file = repository / "cells/line/cell.yaml"
    every = re.findall(r"^::\w+ ", run_step(repository, "Check")[1], re.MULTILINE)
    assert every
    assert run_step(repository, "Check", base=base)[1].count("::") == 0
    file.write_text(file.read_text().replace("100 Hz", "100"), encoding="utf-8")
    code, out, _ = run_step(repository, "Check", base=base)
    assert code == 1
    assert len(re.findall(r"^::error ", out, re.MULTILINE)) == 1


def test_edited_folder_is_not_held(repository: Path) -> None:
    (repository / "generated/line/package.xml").write_text("<package/>", encoding="utf-8")
    assert run_step(repository, "Hold the generated folders")[0] == 1


def test_summary_tells_what_changed_against_the_base(repository: Path) -> None:
    base = git(repository, "rev-parse", "HEAD").strip()
    file = repository / "cells/line/cell.yaml"
    file.write_text(file.read_text().replace("0.1 rad 10 mm", "0.2 rad 10 mm"), encoding="utf-8")
    shutil.copytree(repository / "cells/line", repository / "cells/new")
    git(repository, "add", "-A")
    code, out, summary = run_step(repository, "Tell what changed", base=base)
    assert code == 0, out
    assert "path tolerance" in summary.replace("_", " ")
    assert "A new cell: new" in summary
    assert (
        "\nBoth states in 3D: [line.html](https://github.com/lab/cells/actions/runs/7#artifacts), "
        f"or `cellc view SPEC --against {base}`\n"
    ) in summary
    pages = repository.parent / "runner/cellc-pages"
    assert (repository.parent / "outputs.txt").read_text(encoding="utf-8") == f"pages={pages}\n"
    assert [page.name for page in pages.iterdir()] == ["line.html"]
    assert base in (pages / "line.html").read_text(encoding="utf-8")


def test_summary_of_a_cell_that_did_not_change_names_no_page(repository: Path) -> None:
    base = git(repository, "rev-parse", "HEAD").strip()
    code, out, summary = run_step(repository, "Tell what changed", base=base)
    assert (code, "Both states" in summary) == (0, False), out
    assert not list((repository.parent / "runner/cellc-pages").iterdir())


def test_no_name_of_a_file_keeps_a_changed_cell_out_of_the_summary(repository: Path) -> None:
    base = git(repository, "rev-parse", "HEAD").strip()
    file = repository / "cells/line/cell.yaml"
    file.write_text(file.read_text().replace("0.1 rad 10 mm", "0.2 rad 10 mm"), encoding="utf-8")
    hidden = os.fsencode(repository) + b"/a\xff"  # no UTF-8: a program that reads lines of text takes it for binary
    os.mkdir(hidden)
    shutil.copy(os.fsencode(file), hidden + b"/cell.yaml")
    git(repository, "add", "-A")
    code, out, summary = run_step(repository, "Tell what changed", base=base)
    assert code == 0, out
    assert "path tolerance" in summary.replace("_", " ")
    assert "A new cell: a\n" in summary


def test_removed_cell_is_in_the_summary(repository: Path) -> None:
    base = git(repository, "rev-parse", "HEAD").strip()
    git(repository, "mv", "cells/line", "cells/other")
    code, out, summary = run_step(repository, "Tell what changed", base=base)
    assert code == 0, out
    assert summary.splitlines() == ["A removed cell: line", "A new cell: other"]


def test_base_that_was_not_fetched_is_told_and_fails_nothing(repository: Path) -> None:
    code, _, summary = run_step(repository, "Tell what changed", base="0" * 40)
    assert (code, "fetch-depth" in summary) == (0, True)


def test_clean_repository_passes_every_step_and_names_of_folders_are_no_commands(repository: Path) -> None:
    hostile = repository / "cells" / 'a $(touch pwned) `touch pwned` "; touch pwned #'
    (repository / "cells/line").rename(hostile)
    git(repository, "add", "-A")
    git(repository, "commit", "-q", "-m", "Named")
    base = git(repository, "rev-parse", "HEAD").strip()
    path = hostile.relative_to(repository).as_posix()
    for name in ("Check", "Hold the generated folders", "Run the rehearsals"):
        code, out, _ = run_step(repository, name, path=path)
        assert code == 0, out
    code, out, _ = run_step(repository, "Tell what changed", base=base)
    assert code == 0, out
    assert not list(repository.rglob("pwned"))


def test_no_expression_stands_in_a_script() -> None:
    for file in (ROOT / "action.yml", *sorted((ROOT / ".github/workflows").iterdir())):
        for script in re.findall(r"run: (?:\|\n((?:[ ]{8,}.*\n|\n)+)|(.+))", file.read_text(encoding="utf-8")):
            assert "${{" not in "".join(script), file


def test_actions_of_others_are_pinned_by_commit() -> None:
    used = [
        line
        for file in (ROOT / "action.yml", *sorted((ROOT / ".github/workflows").iterdir()))
        for line in re.findall(r"uses: (\S+)", file.read_text(encoding="utf-8"))
    ]
    assert used
    assert all(one == "./" or re.fullmatch(r"[\w-]+/[\w-]+@[0-9a-f]{40}", one) for one in used)


@pytest.mark.skipif(shutil.which("actionlint") is None, reason="actionlint is not installed")
def test_actionlint_finds_nothing() -> None:
    ran = subprocess.run(("actionlint",), cwd=ROOT, capture_output=True, text=True, check=False, timeout=60)
    assert ran.returncode == 0, ran.stdout
