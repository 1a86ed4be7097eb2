"""The hooks of .pre-commit-hooks.yaml in a repository of a user, run by pre-commit itself."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import yaml

from tests.cells import ROOT
from tests.foreign_yaml import safe_load
from tests.pull_request.conftest import environment, git


def _replace(folder: Path, file: str, old: str, new: str) -> None:
    text = (folder / file).read_text(encoding="utf-8")
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1), encoding="utf-8")


def _hooked(folder: Path) -> None:
    """Configure the hooks as they are offered, from this environment instead of one that is fetched."""
    hooks = [hook | {"language": "system"} for hook in safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())]
    file = folder / ".pre-commit-config.yaml"
    file.write_text(yaml.safe_dump({"repos": [{"repo": "local", "hooks": hooks}]}), encoding="utf-8")


def _commit(folder: Path, *hook: str) -> subprocess.CompletedProcess[str]:
    """Run the hooks on everything, or one of them alone."""
    git(folder, "add", "-A")
    return _ran(folder, "pre_commit", "run", *hook)


def _ran(folder: Path, module: str, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        (sys.executable, "-m", module, *words),
        cwd=folder,
        env=environment(PRE_COMMIT_HOME=str(folder.parent / "pre_commit")),
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


def _failing(ran: subprocess.CompletedProcess[str]) -> list[str]:
    return [text for text in ("cellc", "cellc-build", "cellc-check") if f"hook id: {text}\n" in ran.stdout]


def test_generated_file_that_was_changed_alone_is_stopped_with_the_command_that_makes_it(repository: Path) -> None:
    _hooked(repository)
    _replace(repository, "generated/line/package.xml", "<version>", "<version>9")
    ran = _commit(repository, "cellc")
    assert (ran.returncode, _failing(ran)) == (1, ["cellc"]), ran.stdout + ran.stderr
    assert "run `cellc build cells/line/cell.yaml`" in ran.stdout


def test_cell_in_another_form_is_stopped_and_the_other_hook_puts_it_right(repository: Path) -> None:
    _hooked(repository)
    form = (repository / "cells/line/cell.yaml").read_text(encoding="utf-8")
    _replace(repository, "cells/line/cell.yaml", "cell: ", "cell:   ")
    ran = _commit(repository, "cellc")
    assert (ran.returncode, _failing(ran)) == (1, ["cellc"]), ran.stdout + ran.stderr
    assert "run `cellc format cells/line/cell.yaml`" in ran.stdout
    ran = _commit(repository, "cellc-build")
    assert (ran.returncode, _failing(ran)) == (1, ["cellc-build"]), ran.stdout + ran.stderr
    assert (repository / "cells/line/cell.yaml").read_text(encoding="utf-8") == form


def test_device_that_was_changed_alone_is_stopped_until_the_other_hook_builds_its_cell(repository: Path) -> None:
    _hooked(repository)
    _replace(repository, "cells/line/stage/stage.urdf", 'upper="3"', 'upper="2"')
    ran = _commit(repository, "cellc")
    assert (ran.returncode, _failing(ran)) == (1, ["cellc"]), ran.stdout + ran.stderr
    ran = _commit(repository, "cellc-build")
    assert (ran.returncode, _failing(ran)) == (1, ["cellc-build"]), ran.stdout + ran.stderr  # it changed files
    assert "generated/line: " in ran.stdout
    ran = _commit(repository)
    assert (ran.returncode, _failing(ran)) == (0, []), ran.stdout + ran.stderr


def test_misspelt_key_is_stopped_at_its_line_until_it_is_fixed(repository: Path) -> None:
    _hooked(repository)
    _replace(repository, "cells/line/cell.yaml", "update_rate", "update_rte")
    ran = _commit(repository, "cellc")
    assert (ran.returncode, _failing(ran)) == (1, ["cellc"]), ran.stdout + ran.stderr
    assert "cells/line/cell.yaml:8:3" in ran.stdout
    assert _ran(repository, "cellc", "check", "--fix", ".").returncode == 0
    ran = _commit(repository)
    assert (ran.returncode, _failing(ran)) == (0, []), ran.stdout + ran.stderr
    assert git(repository, "diff", "HEAD", "--", "cells") == ""


def test_device_of_no_cell_that_cannot_be_read_is_stopped(repository: Path) -> None:
    _hooked(repository)
    (repository / "spare").mkdir()
    (repository / "spare/device.yaml").write_text("format: [1", encoding="utf-8")
    ran = _commit(repository, "cellc")
    assert (ran.returncode, _failing(ran)) == (1, ["cellc"]), ran.stdout + ran.stderr
    assert "spare/device.yaml:1:" in ran.stdout
