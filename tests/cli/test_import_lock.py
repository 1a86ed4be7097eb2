"""A damaged lock of an import is said: what the vendor changed since then cannot be told from what a person wrote."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.run import run

_ROBOT = """<robot name="rr"><link name="base"/><link name="arm"/><joint name="turn" type="revolute">
<parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="10"/>
</joint></robot>
"""
SAID = "import.lock.json was damaged: device.yaml lacks later changes of the vendor"


@pytest.fixture
def imported(tmp_path: Path) -> Path:
    (tmp_path / "rr.urdf").write_text(_ROBOT, encoding="utf-8")
    assert run("import", str(tmp_path / "rr.urdf"), "-o", str(tmp_path / "rr")).code == 0
    return tmp_path


@pytest.mark.parametrize("lock", ["", "x", "[]", "3", '{"device": 3}', "[" * 100_000, '{"format": 1, "dev'])
def test_a_damaged_lock_is_said(lock: str, imported: Path) -> None:
    (imported / "rr/import.lock.json").write_text(lock, encoding="utf-8")
    again = run("import", str(imported / "rr.urdf"), "-o", str(imported / "rr"))
    assert again.code == 0
    assert SAID in again.out


def test_a_whole_one_and_one_of_an_older_import_are_not(imported: Path) -> None:
    again = run("import", str(imported / "rr.urdf"), "-o", str(imported / "rr"))
    (imported / "rr/import.lock.json").write_text('{"format": 1, "files": {}}', encoding="utf-8")
    older = run("import", str(imported / "rr.urdf"), "-o", str(imported / "rr"), "--force")
    assert again.code == older.code == 0
    assert "damaged" not in again.out + older.out


def test_nor_that_of_a_folder_without_a_device(imported: Path) -> None:
    (imported / "rr/import.lock.json").write_text("x", encoding="utf-8")
    (imported / "rr/device.yaml").unlink()
    again = run("import", str(imported / "rr.urdf"), "-o", str(imported / "rr"), "--force")
    assert again.code == 0
    assert "damaged" not in again.out
