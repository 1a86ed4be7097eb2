"""Every command tells what it is at on the terminal once two seconds have passed, and leaves nothing there."""

from __future__ import annotations

import io
import shutil
import sys
from collections.abc import Callable
from itertools import count, islice
from pathlib import Path

import pytest

from cellc.contract import printing
from cellc.mock.campaign.plan import CampaignPlan
from cellc.tools.cli import main
from tests.attempt.hand_made import arrived
from tests.cells import ROOT, generated
from tests.cli.run import MINIMAL
from tests.printing.test_streams import seen

QUICK = {"completion": ("bash",), "explain": (), "init": ("bench", "arm=ur5e"), "schema": ()}
"""Commands that read nothing of a user's, and have no stage."""
LONG: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "audit": (("cell.yaml",), ("audit: reading", "audit: linking", "audit: rules")),
    "attempt": (("bag", "--package", "drawn"), ("attempt: reading bag",)),
    "build": (("cell.yaml",), ("1 of 1, cell.yaml, linking", "writing artifacts", "reading back with other parsers")),
    "catalog": (("--all", "-o", "pages"), ("catalog: drawing the pages",)),
    "check": (
        ("cell.yaml", "my_robot"),
        ("1 of 2, cell.yaml, rules", "2 of 2, my_robot/device.yaml", "reading the device"),
    ),
    "compare": (("cell.yaml", "cell.yaml"), ("compare: linking",)),
    "diagnose": (("no goal", "cell.yaml"), ("diagnose: linking",)),
    "diff": (("cell.yaml", "minimal"), ("comparing: cell.yaml, linking", "comparing: minimal")),
    "evidence": (("bag", "--package", "drawn"), ("evidence: reading bag",)),
    "format": (("cell.yaml",), ("format: cell.yaml",)),
    "hook": (("cell.yaml",), ("hook: cell.yaml", "1 of 1, cell.yaml, linking", "reading back with other parsers")),
    "import": (("lift.urdf",), ("import: reading the robot", "import: copying meshes", "import: rules")),
    "campaign": (("minimal", "--jobs", "1"), ("campaign: reading minimal", "campaign: run 1 of ")),
    "gates": (("minimal", "--jobs", "1"), ("gates: reading minimal", "campaign: run 1 of ")),
    "mock": (("minimal",), ("mock: reading minimal", "mock: rehearsal 1 of 1, ready")),
    "replay": (("minimal", "skip_cycles@1"), ("replay: reading minimal", "campaign: run 1 of 1")),
    "show": (("cell.yaml", "cell"), ("show: linking",)),
    "sweep": (("drawn", "--runs", "2", "--jobs", "1"), ("sweep: reading drawn", "sweep: run 1 of at most 2")),
    "upgrade": (("cell.yaml", "--ros", "kilted"), ("upgrade: linking", "upgrade: rules")),
    "view": (("minimal",), ("view: reading minimal", "view: rehearsal ready")),
    "view --bag": (
        ("drawn", "--bag", "bag", "-o", "x.html"),
        ("view: reading drawn", "view: reading bag", "view: posing "),
    ),
}


class Terminal(io.StringIO):
    """Standard error of a person who watches."""

    def isatty(self) -> bool:
        return True


Told = Callable[..., tuple[int, str]]


@pytest.fixture
def told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Told:
    """Run a command on which every look at the clock takes three seconds; its exit code, and what the terminal got."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    whole = CampaignPlan.singles
    monkeypatch.setattr(
        CampaignPlan, "singles", lambda plan: islice(whole(plan), 3)
    )  # as many as the terminal is told of
    shutil.copy(MINIMAL, "cell.yaml")
    shutil.copy(ROOT / "tests/corpus/valid/parts/lift/lift.urdf", ".")
    shutil.copytree(ROOT / "tests/corpus/invalid/base/demo_arm", "my_robot")
    shutil.copytree(generated("minimal"), "minimal")
    shutil.copytree(generated("ur5e_pick"), "drawn")
    arrived().write(tmp_path / "bag")

    def run(*arguments: str) -> tuple[int, str]:
        seconds, terminal = count(0.0, 3.0), Terminal()
        monkeypatch.setattr(printing, "_clock", lambda: next(seconds))
        monkeypatch.setattr(printing, "_LOOK_S", 3600.0)  # nobody else looks at the clock
        monkeypatch.setattr(sys, "stdout", io.StringIO())
        monkeypatch.setattr(sys, "stderr", terminal)
        return main.run(arguments), terminal.getvalue()

    return run


def test_every_command_is_tried() -> None:
    assert {*QUICK, *(call.split()[0] for call in LONG), *main._WAITING} == set(main._COMMANDS)


@pytest.mark.parametrize("command", LONG)
def test_a_long_command_names_its_stages_and_leaves_nothing(told: Told, command: str) -> None:
    arguments, stages = LONG[command]
    code, written = told(command.split()[0], *arguments)
    assert code in (0, 1), written
    for stage in stages:
        assert stage in written
    assert not any(stage in seen(written) for stage in stages)


@pytest.mark.parametrize("command", QUICK)
def test_a_quick_command_tells_nothing(told: Told, command: str) -> None:
    assert told(command, *QUICK[command]) == (0, "")


def test_no_command_tells_a_pipe(told: Told, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Terminal, "isatty", lambda _: False)
    assert told("check", "cell.yaml") == (0, "")
