"""Signals at many moments of real processes: no traceback, whole files or none, nothing temporary left.

A moment is told by what the process does, not by the clock: when it imports a module, or calls a function for the
n-th time. So a busy machine changes nothing.
"""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.refused import everything_below
from tests.cli.run import MINIMAL, run

MANY = [file.as_posix() for file in sorted((ROOT / "tests/corpus/valid").glob("*.yaml"))[:8]]
_START = """
import os, signal, sys
from importlib import import_module

moments, number, group, *arguments = sys.argv[1:]

def press(kill=os.kill, number=int(number), me=0 if group else os.getpid(), tell=os.write):
    tell(2, b"pressed\\n")
    kill(me, number)  # 0 is the whole group of processes

def press_on_call(holder, name, number):
    original = getattr(holder, name)
    left = [number]
    def called(*given, **options):
        left[0] -= 1
        if left[0] == 0:
            press()
        return original(*given, **options)
    setattr(holder, name, called)

def press_on_import(module):
    sys.addaudithook(lambda event, given: press() if event == "import" and given[0] == module else None)

class AtTheEnd:
    def __del__(self, press=press):
        press()

for moment in moments.split(","):
    module, _, call = moment.partition(":")
    if moment == "end":
        sys.modules["json"] = AtTheEnd()  # is let go with the modules, when Python has given back its handlers
    elif call:
        path, _, times = call.partition("*")
        *parents, name = path.split(".")
        holder = import_module(module)
        for parent in parents:
            holder = getattr(holder, parent)
        press_on_call(holder, name, int(times or 1))
    else:
        press_on_import(module)
sys.argv = ["cellc", *arguments]
from cellc.__main__ import main
main()
"""


def _assert_interrupted(
    moments: str, arguments: list[str], number: signal.Signals = signal.SIGINT, *, group: bool = False
) -> None:
    """Send a signal at moments of a command and hold that it ends as shells expect, with all its processes."""
    ran = _signalled(moments, arguments, number, group=group)
    name = "" if number == signal.SIGINT else f" by {number.name}"
    pressed = "pressed\n" * (moments.count(",") + 1)
    assert ran.stderr == f"{pressed}error: interrupted{name}; nothing was left half-written\n"
    assert ran.returncode == 128 + number


def _signalled(
    moments: str, arguments: list[str], number: int, *, group: bool = False
) -> subprocess.CompletedProcess[str]:
    # Standard error is read to its end: no process that shares it is left.
    command = [sys.executable, "-c", _START, moments, str(int(number)), "group" if group else "", *arguments]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, start_new_session=group)


@pytest.fixture(autouse=True)
def _cache_of_the_test(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Remember nothing: a build that another test has kept is given again without the moments of this file."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))


@pytest.mark.parametrize(
    ("moment", "number"),
    [
        ("pydantic", signal.SIGINT),
        ("cellc.compiler.rules.run", signal.SIGTERM),
        ("cellc.compiler.spec.parse:parse", signal.SIGINT),
        ("cellc.compiler.verify:verify", signal.SIGHUP),
        ("cellc.contract.store.swap:Swap.make_folder", signal.SIGXCPU),
        ("cellc.contract.store.swap:Swap.put", signal.SIGTERM),
        ("cellc.contract.store.swap:Swap.settle", signal.SIGINT),
    ],
)
def test_build_that_a_signal_asks_to_end_leaves_nothing(moment: str, number: signal.Signals, tmp_path: Path) -> None:
    _assert_interrupted(moment, ["build", MINIMAL, "-o", str(tmp_path / "out")], number)
    assert everything_below(tmp_path) == []


@pytest.mark.parametrize("moment", ["cellc.contract.store.swap:Swap.put*2", "cellc.contract.store.swap:Swap.settle"])
def test_interrupted_build_leaves_the_former_folder(moment: str, tmp_path: Path) -> None:
    output = tmp_path / "out"
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    edited = tmp_path / "cell.yaml"
    edited.write_text(Path(MINIMAL).read_text().replace("goal_tolerance: 0.01 rad", "goal_tolerance: 0.02 rad"))
    _assert_interrupted(moment, ["build", str(edited), "-o", str(output)])
    assert run("build", "--check", MINIMAL, "-o", output.as_posix()).code == 0
    assert [name for name in everything_below(tmp_path) if "tmp-" in name] == []


def test_signals_that_follow_cut_no_cleaning_short(tmp_path: Path) -> None:
    swap = "cellc.contract.store.swap:Swap"
    moments = f"{swap}.put*7,{swap}.undo,cellc.compiler.output.write:discard"
    _assert_interrupted(moments, ["build", MINIMAL, "-o", str(tmp_path / "out")])
    assert everything_below(tmp_path) == []


def test_signal_that_meets_a_finished_command_changes_nothing() -> None:
    ran = _signalled("end", ["explain", "frame-cycle"], signal.SIGINT)
    assert (ran.returncode, ran.stderr) == (0, "pressed\n")
    assert ran.stdout.startswith("# frame-cycle")


@pytest.mark.parametrize(
    "moment",
    ["cellc.compiler.rules.shared_domain:shared_domains", "cellc.compiler.rules.shared_domain:shared_domains*5"],
)
def test_interrupted_check_of_many_cells_ends_its_workers(moment: str) -> None:
    _assert_interrupted(moment, ["check", *MANY])


def test_signal_to_the_whole_group_is_told_in_one_line_too() -> None:
    moment = "cellc.compiler.rules.shared_domain:shared_domains"
    _assert_interrupted(moment, ["check", *MANY], signal.SIGHUP, group=True)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("built")
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    return output / "minimal"


@pytest.mark.parametrize(
    "moment",
    ["cellc.mock.folder", "cellc.mock.folder:read_folder", "cellc.mock.command.rehearsals:write_records"],
)
def test_interrupted_mock_leaves_no_records(moment: str, built: Path, tmp_path: Path) -> None:
    _assert_interrupted(moment, ["mock", str(built), "--records", str(tmp_path / "records.jsonl")])
    assert everything_below(tmp_path) == []
