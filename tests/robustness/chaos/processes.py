"""Places to run commands in, and the commands as forked processes that can be killed."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from cellc.tools.cli.main import run as run_here
from tests.cells import ROOT

OLD, NEW = "old", "new"
_TOLERANCE = {OLD: "0.01 rad", NEW: "0.02 rad"}
_HANG_S = 600.0

Tree = dict[str, bytes]


@dataclass
class Ended:
    """How a process ended: its exit code, negative for a signal, and what it printed."""

    code: int
    said: str


@dataclass
class Place:
    """A folder with a spec in two versions, a cache, and what a run makes."""

    root: Path

    @property
    def output(self) -> Path:
        """The folder that holds the generated folder."""
        return self.root / "generated"

    def spec(self, version: str) -> str:
        """Write a version of the spec where it is not yet; return its path from the root."""
        file = self.root / f"{version}.yaml"
        if not file.exists():
            text = (ROOT / "cells/minimal/cell.yaml").read_text()
            file.write_text(text.replace("goal_tolerance: 0.01 rad", f"goal_tolerance: {_TOLERANCE[version]}"))
        return file.name

    def build(self, version: str) -> tuple[str, ...]:
        """Return the arguments of a build of one version."""
        return ("build", self.spec(version), "-o", self.output.name)


def start(
    place: Place,
    arguments: tuple[str, ...],
    said: str = "said",
    *,
    user: int = 0,
    environment: dict[str, str] | None = None,
) -> int:
    """Begin a command in a forked process and a session of its own; return its number."""
    opened = os.open(place.root.parent / f"{place.root.name}.{said}", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    child = os.fork()
    if child:
        os.close(opened)
        return child
    code = 70
    try:
        os.setsid()
        os.dup2(opened, 1)
        os.dup2(opened, 2)
        os.environ.update({"XDG_CACHE_HOME": str(place.root / "cache"), **(environment or {})})
        os.chdir(place.root)
        if user:
            os.setgroups([])
            os.setgid(user)
            os.setuid(user)
        code = run_here(list(arguments))
        sys.stdout.flush()
        sys.stderr.flush()
    except BaseException:
        os.write(2, traceback.format_exc().encode())
    finally:
        os._exit(code)


def is_writing(place: Place) -> bool:
    """Whether a command has something temporary in a place."""
    return any(".tmp-" in name for folder in (place.root, place.output) for name in os.listdir(folder))


def finish(
    place: Place,
    child: int,
    said: str = "said",
    kill_after: float | None = None,
    once: Callable[[Place], bool] | None = None,
) -> Ended:
    """Wait for a command, and kill it after a while, which begins once something is so; one that hangs is killed."""
    begin = time.monotonic()
    ended, status = 0, 0
    while not ended:
        ended, status = os.waitpid(child, os.WNOHANG)
        if once is not None:
            begin, once = time.monotonic(), None if once(place) else once
        lasted = time.monotonic() - begin
        if not ended and lasted > (_HANG_S if kill_after is None else kill_after):
            os.kill(child, signal.SIGKILL)
            ended, status = os.waitpid(child, 0)
        time.sleep(0 if kill_after is not None else 0.001)
    file = place.root.parent / f"{place.root.name}.{said}"
    text = file.read_text(errors="replace")
    file.unlink()
    return Ended(os.waitstatus_to_exitcode(status), text)


def run(
    place: Place,
    arguments: tuple[str, ...],
    *,
    kill_after: float | None = None,
    once: Callable[[Place], bool] | None = None,
    user: int = 0,
    environment: dict[str, str] | None = None,
) -> Ended:
    """Run a command, and wait until it and everything that it started has ended."""
    child = start(place, arguments, user=user, environment=environment)
    ended = finish(place, child, kill_after=kill_after, once=once)
    begin = time.monotonic()
    while _session_of(child):
        if time.monotonic() - begin > _HANG_S:
            os.killpg(child, signal.SIGKILL)
            return Ended(71, f"processes of a killed command go on for {_HANG_S:.0f} s")
        time.sleep(0.01)
    return ended


def _session_of(leader: int) -> list[int]:
    """Return the processes that still run in a session."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split() if entry.name.isdigit() else []
        except OSError:
            continue
        if fields and fields[0] != "Z" and int(fields[3]) == leader:
            found.append(int(entry.name))
    return found


def tree(folder: Path) -> Tree:
    """Return what every file below a folder holds, hidden ones too."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and not path.is_symlink()
    }


def put(folder: Path, files: Tree) -> None:
    """Write files below a folder."""
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)


@contextmanager
def small_disk(work: Path, kib: int) -> Iterator[Path | None]:
    """Mount a disk of its own size, or yield None where that is not possible."""
    folder = work / "disk"
    folder.mkdir(exist_ok=True)
    command = ["mount", "-t", "tmpfs", "-o", f"size={kib}k", "tmpfs", str(folder)]
    if shutil.which("mount") is None or subprocess.run(command, capture_output=True, check=False).returncode:
        yield None
        return
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)
