"""Two commands run every test, and each module has tests that are near."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.nearest import FOLDERS, nearest

_INI = '[tool.pytest.ini_options]\ntestpaths = ["tests"]\nlong_tests = ["tests/test_slow.py", "tests/apart"]\n'


@pytest.mark.parametrize(
    ("asked", "ran"),
    [
        (("-n", "1"), {"quick"}),
        (("--long", "-n", "1"), {"slow", "apart"}),
        (("--all", "-n", "1"), {"quick", "slow", "apart"}),
        (("tests",), {"quick", "slow", "apart"}),
        (("tests/apart",), {"apart"}),
    ],
    ids=["suite", "long", "all", "folder", "named"],
)
def test_long_tests_wait_for_their_command(asked: tuple[str, ...], ran: set[str], tmp_path: Path) -> None:
    (tmp_path / "tests" / "apart").mkdir(parents=True)
    for name in ("quick", "slow", "apart/apart"):
        test = f"def test_that_runs():\n    open({str(tmp_path / Path(name).name)!r}, 'w')\n"
        (tmp_path / "tests" / Path(name).parent / f"test_{Path(name).name}.py").write_text(test, encoding="utf-8")
    (tmp_path / "pyproject.toml").write_text(_INI, encoding="utf-8")
    shutil.copy(ROOT / "tests" / "conftest.py", tmp_path / "tests")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *asked]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert {file.name for file in tmp_path.iterdir()} & {"quick", "slow", "apart"} == ran


def test_of_many_cases_a_session_runs_a_share_and_of_few_all(tmp_path: Path) -> None:
    (tmp_path / "tests").mkdir()
    many = "@pytest.mark.parametrize('n', range(30))\ndef test_many(n):\n    print('many', n)\n"
    few = "@pytest.mark.parametrize('n', range(4))\ndef test_few(n):\n    print('few', n)\n"
    (tmp_path / "tests" / "test_both.py").write_text(f"import pytest\n\n{many}\n{few}", encoding="utf-8")
    (tmp_path / "pyproject.toml").write_text(_INI, encoding="utf-8")
    shutil.copy(ROOT / "tests" / "conftest.py", tmp_path / "tests")
    command = [sys.executable, "-m", "pytest", "-q", "-s", "-p", "no:cacheprovider"]
    said = [
        subprocess.run([*command, *share], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
        for share in ((), ("--share", "3"), ("--share", "3"))
    ]
    ran = [set(re.findall(r"(?:many|few) \d+", each)) for each in said]
    assert [len({each for each in ran[at] if "many" in each}) for at in (0, 1)] == [30, 10]
    assert [len({each for each in ran[at] if "few" in each}) for at in (0, 1)] == [4, 4]
    assert ran[1] == ran[2] < ran[0]
    assert "20 deselected" in said[1]


def test_long_tests_are_there(pytestconfig: pytest.Config) -> None:
    assert [path for path in pytestconfig.getini("long_tests") if not (ROOT / path).exists()] == []


def test_each_module_has_tests_that_are_near() -> None:
    files = [file.relative_to(ROOT).as_posix() for file in (ROOT / "cellc").rglob("*.py") if file.stat().st_size]
    assert {file for file in files for near in nearest(file) if not (ROOT / near).exists()} == set()
    sources = [file.partition("/")[2] for file in files]
    rooms = {name for file in sources for name in (*file.split("/"), file.partition("/")[2])}
    assert FOLDERS.keys() - rooms == set()


@pytest.mark.parametrize(
    ("module", "tests"),
    [
        ("cellc/mock/campaign/run.py", ["tests/mock/campaign"]),
        ("cellc/compiler/spec/parse.py", ["tests/spec"]),
        ("cellc/tools/cli/diff.py", ["tests/review"]),
    ],
)
def test_nearest_tests_are_those_of_the_room(module: str, tests: list[str]) -> None:
    assert nearest(module) == tests
