"""`cellc mock FOLDER --evidence DIR` as a user meets it."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from cellc.contract.extras import MissingExtraError
from cellc.mock.command.options import RehearsalOptions
from cellc.mock.command.rehearsals import run_rehearsals


def evidence_of(built_folder: Path, tmp_path: Path, *rehearsals: str) -> int:
    return run_rehearsals(RehearsalOptions(str(built_folder), rehearsals=rehearsals, evidence=str(tmp_path / "out")))


def test_one_rehearsal_has_its_evidence_and_the_exit_code_of_its_outcome(
    built_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert evidence_of(built_folder, tmp_path, "canceled") == 0
    assert "passed  canceled" in capsys.readouterr().out
    assert (tmp_path / "out" / "report.html").is_file()


def test_same_rehearsal_twice_is_one(built_folder: Path, tmp_path: Path) -> None:
    assert evidence_of(built_folder, tmp_path, "canceled", "canceled") == 0


def test_unknown_rehearsal_leaves_nothing(
    built_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert evidence_of(built_folder, tmp_path, "missing") == 2
    assert "has no rehearsal `missing`" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_missing_package_is_told_with_what_to_install(
    built_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    loading = ("mcap", "cellc.mock.command.evidence", "cellc.mock.evidence.bag")
    for name in [name for name in sys.modules if name.startswith(loading)]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "mcap", None)
    with pytest.raises(MissingExtraError, match=re.escape("-m pip install 'mcap>=1.1'`")):
        evidence_of(built_folder, tmp_path, "canceled")
    assert list(tmp_path.iterdir()) == []


def test_runs_without_evidence_load_nothing_of_it(built_folder: Path) -> None:
    import subprocess

    code = (
        "import sys; from cellc.mock.command.options import RehearsalOptions; "
        "from cellc.mock.command.rehearsals import run_rehearsals; "
        f"run_rehearsals(RehearsalOptions({str(built_folder)!r}, rehearsals=('canceled',)))"
    )
    told = "; print([name for name in sys.modules if name.split('.')[0] == 'mcap' or 'report_page' in name])"
    ran = subprocess.run([sys.executable, "-c", code + told], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "[]"
