"""The mark of the program changes with every file of it and with what it runs on."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from cellc.cache.program import program_mark


@pytest.fixture(name="package")
def package_fixture(tmp_path: Path) -> Path:
    package = tmp_path / "package"
    (package / "rules").mkdir(parents=True)
    (package / "rules/rule.py").write_text("LIMIT = 1\n")
    (package / "device.yaml").write_text("limit: 1\n")
    return package


def _rewritten_in_the_same_instant(package: Path) -> None:
    file = package / "rules/rule.py"
    before = file.stat()
    file.write_text("LIMIT = 2\n")
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))


CHANGES: dict[str, Callable[[Path], object]] = {
    "code": lambda package: (package / "rules/rule.py").write_text("LIMIT = 22\n"),
    "code of the same size and time of modification": _rewritten_in_the_same_instant,
    "data": lambda package: (package / "device.yaml").write_text("limit: 10\n"),
    "a new file": lambda package: (package / "rules/more.py").write_text(""),
    "a lost file": lambda package: (package / "device.yaml").unlink(),
    "another name": lambda package: (package / "device.yaml").rename(package / "devices.yaml"),
    "another folder": lambda package: (package / "rules").rename(package / "rule"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_every_change_of_the_package_shows(change: str, package: Path) -> None:
    before = program_mark(package, [])
    CHANGES[change](package)
    assert program_mark(package, []) not in (before, None)


def test_compiled_code_does_not_count(package: Path) -> None:
    before = program_mark(package, [])
    (package / "rules/__pycache__").mkdir()
    (package / "rules/__pycache__/rule.cpython-311.pyc").write_bytes(b"")
    assert program_mark(package, []) == before


def test_versions_of_libraries_count(package: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    (site / "library-1.0.dist-info").mkdir(parents=True)
    marks = [program_mark(package, []), program_mark(package, [str(site)])]
    (site / "library-1.0.dist-info").rename(site / "library-1.1.dist-info")
    marks.append(program_mark(package, [str(site)]))
    assert len(set(marks)) == 3
    (site / "something.py").write_text("")
    assert program_mark(package, [str(site)]) == marks[-1]


def test_two_installations_are_two_programs(package: Path, tmp_path: Path) -> None:
    other = Path(shutil.copytree(package, tmp_path / "other"))
    assert program_mark(package, []) != program_mark(other, [])


def test_a_package_in_an_archive_has_no_mark(tmp_path: Path) -> None:
    (tmp_path / "archive.zip").write_bytes(b"")
    assert program_mark(tmp_path / "archive.zip/cellc", []) is None


def test_the_mark_of_this_program_is_the_same_twice() -> None:
    assert program_mark() == program_mark() is not None
