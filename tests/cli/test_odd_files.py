"""Every file that a command reads may be a pipe, a device or anything else: it says so, and waits for nothing."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from tests.cli.run import run
from tests.foreign.test_import import ARM, _robot
from tests.robustness.fuzz.bases import PARTS, TINY

_PATIENCE_S = 300.0
"""Far above what a command takes on a busy machine: what takes longer waits for somebody."""


def _socket(place: Path) -> None:
    # A path of a socket is short: it is made by a name of its folder.
    with socket.socket(socket.AF_UNIX) as one:
        os.chdir(place.parent)
        one.bind(place.name)


def _huge(place: Path) -> None:
    with place.open("wb") as file:
        file.truncate(8 << 30)


_ALIASES = "# ros__parameters\na0: &a0 {x: 1}\n" + "".join(
    f"a{n}: &a{n} {{<<: [{', '.join([f'*a{n - 1}'] * 9)}]}}\n" for n in range(1, 10)
)
KINDS: dict[str, Callable[[Path], object]] = {
    "a pipe": os.mkfifo,
    "a folder": os.mkdir,
    "a socket": _socket,
    "a device": lambda place: place.symlink_to("/dev/zero"),
    "8 GB": _huge,
    "a link to itself": lambda place: place.symlink_to(place.name),
    "Latin-1": lambda place: place.write_bytes(b"# Gr\xfc\xdfe\n"),
    "no end of marks": lambda place: place.write_text("<mesh <robot <license " * 15_000, encoding="utf-8"),
    "aliases of aliases": lambda place: place.write_text(_ALIASES, encoding="utf-8"),
}
_SPEC = ("cell.yaml", "part.yaml", "device/device.yaml", "device/device.urdf")
_GENERATED = ("contract.json", "manifest.json", "rehearsals.json", "config/controllers.yaml", "urdf/fuzzed.mock.urdf")
_IMPORTED = (
    "robot.urdf",
    "robot.srdf",
    "controllers.yaml",
    "package.xml",
    "a.stl",
    "out/device.yaml",
    "out/robot.urdf",
)
CASES: tuple[tuple[tuple[str, ...], tuple[tuple[str, ...], ...]], ...] = (
    (
        _SPEC,
        (
            ("check", "cell.yaml"),
            ("build", "cell.yaml"),
            ("audit", "cell.yaml"),
            ("show", "cell.yaml"),
            ("format", "cell.yaml"),
            ("diff", "cell.yaml", "sound.yaml"),
            ("view", "cell.yaml", "-o", "page.html"),
            ("upgrade", "cell.yaml"),
        ),
    ),
    (("device/device.urdf",), (("check", "device/device.urdf"), ("import", "device/device.urdf", "-o", "other"))),
    (
        tuple(f"generated/fuzzed/{name}" for name in _GENERATED),
        (
            ("mock", "generated/fuzzed"),
            ("view", "generated/fuzzed", "-o", "page.html"),
            ("diff", "generated/fuzzed", "sound.yaml"),
            ("build", "cell.yaml"),
        ),
    ),
    (
        (*_IMPORTED, "out/import.lock.json"),
        (("import", "robot.urdf", "-o", "out", "--cell"), ("import", "--check", "out")),
    ),
    (("robot.srdf",), (("import", "robot.urdf", "-o", "out", "--srdf", "robot.srdf"),)),
    (("controllers.yaml",), (("import", "robot.urdf", "-o", "out", "--controllers", "controllers.yaml"),)),
    (("symptom.log",), (("diagnose", "--file", "symptom.log"), ("diagnose", "symptom.log", "cell.yaml"))),
)


@pytest.fixture(name="sound", scope="module")
def sound_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a cell, its generated folder, a robot to import, and what an import left."""
    folder = tmp_path_factory.mktemp("sound")
    shutil.copytree(PARTS, folder / "parts")
    shutil.copytree(PARTS / "stage", folder / "device")
    urdf = next((folder / "device").glob("*.urdf"))
    urdf.rename(folder / "device/device.urdf")
    facts = (folder / "device/device.yaml").read_text(encoding="utf-8").replace(urdf.name, "device.urdf")
    (folder / "device/device.yaml").write_text(facts, encoding="utf-8")
    spec = TINY[1].replace("./parts/stage", "./device")
    (folder / "cell.yaml").write_text(f"include: [part.yaml]\n{spec}", encoding="utf-8")
    (folder / "part.yaml").write_text("summary: of two files\n", encoding="utf-8")
    (folder / "sound.yaml").write_text(TINY[1], encoding="utf-8")
    mesh = '<collision><geometry><mesh filename="a.stl"/></geometry></collision>'
    (folder / "robot.urdf").write_text(_robot(*ARM).replace('<link name="a">', f'<link name="a">{mesh}'))
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n"
    (folder / "a.stl").write_text(f"solid a\n{facet}endsolid a\n", encoding="utf-8")
    (folder / "robot.srdf").write_text('<robot name="Odd-Arm"/>', encoding="utf-8")
    told = "controller: {ros__parameters: {joints: [j1, j2], constraints: {goal_time: 1.0}}}\n"
    (folder / "controllers.yaml").write_text(told, encoding="utf-8")
    (folder / "package.xml").write_text("<package><name>odd</name><license>BSD</license></package>", encoding="utf-8")
    (folder / "symptom.log").write_text("the arm stops with a tolerance violation\n", encoding="utf-8")
    before = os.getcwd()
    os.chdir(folder)
    try:
        assert run("build", "cell.yaml").code == 0
        assert run("import", "robot.urdf", "-o", "out").code == 0
    finally:
        os.chdir(before)
    return folder


def _cases() -> Iterator[tuple[str, str, Sequence[Sequence[str]]]]:
    """Yield a pipe for every file, and each other kind for a few, with one command; or the whole table."""
    whole = bool(os.environ.get("CELLC_WHOLE_TABLE"))
    number = 0
    for files, commands in CASES:
        for file in files:
            number += 1
            for place, kind in enumerate(KINDS):
                if whole or place == 0 or number % 7 == place % 7:
                    yield file, kind, commands if whole else (commands[(number + place) % len(commands)],)


@pytest.mark.parametrize(("file", "kind", "commands"), list(_cases()))
def test_no_command_waits_or_crashes_for_what_stands_in_the_place_of_a_file(
    file: str,
    kind: str,
    commands: Sequence[Sequence[str]],
    sound: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder = tmp_path / "here"
    shutil.copytree(sound, folder)
    place = folder / file
    place.unlink()
    monkeypatch.chdir(folder)
    KINDS[kind](place)
    for arguments in commands:
        code, said = _ended(folder, arguments, tmp_path / "said")
        assert code in (0, 1, 2), f"{arguments}: {code}\n{said}"
        assert "Traceback" not in said
        assert "bug of cellc" not in said
        assert said.strip()


def _ended(folder: Path, arguments: Sequence[str], answer: Path) -> tuple[int, str]:
    """Run a command in a fork of this process; one that waits is killed."""
    child = os.fork()
    if child == 0:
        try:
            os.chdir(folder)
            ran = run(*arguments)
            answer.write_text(f"{ran.out}{ran.err}", encoding="utf-8", errors="replace")
            os._exit(ran.code)
        finally:
            os._exit(99)
    until = time.monotonic() + _PATIENCE_S
    while time.monotonic() < until:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status), answer.read_text(encoding="utf-8") if answer.exists() else ""
        time.sleep(0.005)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return 98, "it waits"
