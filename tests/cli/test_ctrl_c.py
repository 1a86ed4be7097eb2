"""Ctrl-C at many moments of real processes: no traceback, whole files or none, nothing temporary left.

A moment is told by what the process does, not by the clock: when it imports a module, or calls a function for the
n-th time. So a busy machine changes nothing.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.refused import everything_below
from tests.cli.run import MINIMAL, PICK, run

pytestmark = pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is sent as a POSIX signal")

_START = """
import os, signal, sys
from importlib import import_module

moment, *arguments = sys.argv[1:]
module, _, call = moment.partition(":")

def press():
    print("pressed", file=sys.stderr)
    os.kill(os.getpid(), signal.SIGINT)

def press_on_call(holder, name, number):
    original = getattr(holder, name)
    left = [number]
    def called(*given, **options):
        left[0] -= 1
        if left[0] == 0:
            press()
        return original(*given, **options)
    setattr(holder, name, called)

def press_on_import(event, given):
    if event == "import" and given[0] == module:
        press()

if call:
    path, _, number = call.partition("*")
    *parents, name = path.split(".")
    holder = import_module(module)
    for parent in parents:
        holder = getattr(holder, parent)
    press_on_call(holder, name, int(number or 1))
else:
    sys.addaudithook(press_on_import)
sys.argv = ["cellc", *arguments]
from cellc.__main__ import main
main()
"""


def _assert_interrupted(moment: str, arguments: list[str], code: int = 1) -> None:
    """Press Ctrl-C at the moment of a command and hold that it ends well, with all its processes."""
    # Standard error is read to its end: no process that shares it is left.
    ran = subprocess.run(
        [sys.executable, "-c", _START, moment, *arguments], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert ran.stderr.startswith("pressed\n"), ran.stderr
    assert ran.returncode == code, ran.stderr
    assert "Traceback" not in ran.stderr
    assert "interrupted" in ran.stderr


@pytest.mark.parametrize(
    "moment",
    [
        "pydantic",
        "cellc.link.link",
        "cellc.rules.run",
        "cellc.spec.parse:parse",
        "cellc.verify.verify:verify",
        "cellc.store.swap:Swap.make_folder",
        "cellc.store.swap:Swap.put",
        "cellc.store.swap:Swap.put*7",
        "cellc.store.swap:Swap.settle",
    ],
)
def test_interrupted_build_leaves_nothing(moment: str, tmp_path: Path) -> None:
    _assert_interrupted(moment, ["build", PICK, "-o", str(tmp_path / "out")])
    assert everything_below(tmp_path) == []


@pytest.mark.parametrize("moment", ["cellc.store.swap:Swap.put*2", "cellc.store.swap:Swap.settle"])
def test_interrupted_build_leaves_the_former_folder(moment: str, tmp_path: Path) -> None:
    output = tmp_path / "out"
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    edited = tmp_path / "cell.yaml"
    edited.write_text(Path(MINIMAL).read_text().replace("goal_tolerance: 0.01 rad", "goal_tolerance: 0.02 rad"))
    _assert_interrupted(moment, ["build", str(edited), "-o", str(output)])
    assert run("build", "--check", MINIMAL, "-o", output.as_posix()).code == 0
    assert [name for name in everything_below(tmp_path) if "tmp-" in name] == []


@pytest.mark.parametrize(
    "moment",
    ["cellc.rules.shared_domain:shared_domains", "cellc.rules.shared_domain:shared_domains*20"],
)
def test_interrupted_check_of_many_cells_ends_its_workers(moment: str) -> None:
    cells = [file.as_posix() for file in sorted((ROOT / "tests/corpus/valid").glob("*.yaml"))]
    _assert_interrupted(moment, ["check", *cells])


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("built")
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    return output / "minimal"


@pytest.mark.parametrize(
    ("moment", "code"),
    [
        ("cellc.mock.folder", 1),
        ("cellc.mock.folder:read_folder", 2),
        ("cellc.mock.command.rehearsals:write_records", 2),
    ],
)
def test_interrupted_mock_leaves_no_records(moment: str, code: int, built: Path, tmp_path: Path) -> None:
    _assert_interrupted(moment, ["mock", str(built), "--records", str(tmp_path / "records.jsonl")], code)
    assert everything_below(tmp_path) == []
