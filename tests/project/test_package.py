"""What a program calls: ``cellc.check``, ``cellc.build``, ``cellc.load_mock``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import cellc
from cellc.diagnostics import Severity
from cellc.mock import MockError
from tests.cells import ROOT
from tests.cli.run import MINIMAL, run

INVALID = ROOT / "tests/corpus/invalid/circular-mimic-of-two.yaml"


def test_check_returns_the_linked_cell_and_its_findings() -> None:
    checked = cellc.check(MINIMAL)
    assert checked.ok
    assert checked.graph is not None
    assert checked.graph.cell.name == "minimal"
    assert {found.severity for found in checked.diagnostics} <= {Severity.BLOCKER, Severity.WARNING, Severity.AUDIT}


def test_check_tells_of_a_file_that_is_not_there(tmp_path: Path) -> None:
    (found,) = cellc.check(tmp_path / "nothing.yaml").diagnostics
    assert found.code == "file-not-found"


def test_build_writes_what_the_command_writes(tmp_path: Path) -> None:
    report = cellc.build(MINIMAL, tmp_path / "ours")
    assert report.value is not None
    assert run("build", MINIMAL, "-o", (tmp_path / "theirs").as_posix()).code == 0
    theirs = {
        file.relative_to(tmp_path / "theirs/minimal") for file in (tmp_path / "theirs").rglob("*") if file.is_file()
    }
    assert {Path(path) for path in report.value.written} == theirs
    for path in theirs:
        assert (tmp_path / "ours/minimal" / path).read_bytes() == (tmp_path / "theirs/minimal" / path).read_bytes()


def test_build_of_a_cell_with_errors_writes_nothing(tmp_path: Path) -> None:
    report = cellc.build(INVALID, tmp_path / "out")
    assert report.value is None
    assert any(found.severity is Severity.ERROR for found in report.diagnostics)
    assert not (tmp_path / "out").exists()


def test_build_keeps_an_edit_unless_it_is_forced(tmp_path: Path) -> None:
    cellc.build(MINIMAL, tmp_path)
    readme = tmp_path / "minimal/README.md"
    readme.write_text("mine\n")
    refused = cellc.build(MINIMAL, tmp_path)
    assert refused.value is None
    assert "edited-by-hand" in {found.code for found in refused.diagnostics}
    forced = cellc.build(MINIMAL, tmp_path, force=True)
    assert forced.value is not None
    assert forced.value.written == ("README.md",)


def test_loaded_mock_runs_a_rehearsal(tmp_path: Path) -> None:
    assert cellc.build(MINIMAL, tmp_path).value is not None
    mock = cellc.load_mock(tmp_path / "minimal")
    result = mock.run(mock.rehearsals[0])
    assert result.outcome == result.expected


def test_mock_of_no_generated_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MockError):
        cellc.load_mock(tmp_path)


def test_importing_the_package_loads_no_stage() -> None:
    program = "import sys, cellc; print(sorted(name for name in sys.modules if name.startswith('cellc.')))"
    ran = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == "['cellc.version']"
