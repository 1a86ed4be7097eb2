"""Send signals at random moments of commands, and count how they end.

    python benchmarks/signals.py --count 300 --seed 1

Counts what ended with 128 + N, what had finished before, and what the signal met before Python ran a line of cellc:
such a process dies of the signal itself, which a shell reports as 128 + N too, or of the traceback of Python's own
start. Everything else is wrong, and printed: another code, more than one line, a process that is left, a folder that is
neither the old one nor the new one.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SPECS = [str(ROOT / f"cells/{name}/cell.yaml") for name in ("minimal", "ur5e_pick")]
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGXCPU)


@dataclass(frozen=True, slots=True)
class Case:
    """A command, and the share of its undisturbed time after which the signal comes."""

    arguments: tuple[str, ...]
    number: signal.Signals
    share: float
    whole_group: bool


def main() -> None:
    """Run the cases and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        commands, folder = _commands(Path(name)), Path(name) / "out"
        lasts = {command: _duration(command) for command in commands}
        whole = _contents(folder)
        shutil.copytree(folder, Path(name) / "built")
        chance = random.Random(given.seed)
        for number in range(given.count):
            command = chance.choice(commands)
            case = Case(command, chance.choice(SIGNALS), chance.uniform(0.0, 1.1), chance.random() < 0.5)
            shutil.rmtree(folder, ignore_errors=True)
            verdict = _run(case, lasts[command])
            if any(files != whole.get(cell) for cell, files in _contents(folder).items()):
                verdict = "half-written folder"
            counts[verdict] += 1
            if verdict not in ("128 + N", "had finished", "before the first line of cellc"):
                print(f"{number}: {verdict}: {case}")
    for verdict, count in sorted(counts.items()):
        print(f"{count:6d}  {verdict}")


def _commands(folder: Path) -> list[tuple[str, ...]]:
    out = str(folder / "out")
    many = tuple(str(file) for file in sorted((ROOT / "tests/corpus/valid").glob("*.yaml"))[:40])
    mock = ("-m", "cellc.mock", str(folder / "built" / "minimal"))
    return [
        ("-m", "cellc", "build", *SPECS, "-o", out),
        ("-m", "cellc", "build", SPECS[0], "-o", out),
        ("-m", "cellc", "check", SPECS[1]),
        ("-m", "cellc", "check", *many),
        mock,
        (*mock, "--evidence", str(folder / "evidence")),
        ("-m", "cellc", "campaign", mock[-1], "--jobs", "2"),
    ]


def _duration(command: tuple[str, ...]) -> float:
    begin = time.perf_counter()
    subprocess.run([sys.executable, *command], capture_output=True, cwd=ROOT, check=False)
    return time.perf_counter() - begin


def _run(case: Case, lasts_s: float) -> str:
    """Run a case and tell how it ended."""
    started = subprocess.Popen(
        [sys.executable, *case.arguments],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    time.sleep(case.share * lasts_s)
    listened = _catches(started.pid, signal.SIGHUP)
    (os.killpg if case.whole_group else os.kill)(started.pid, case.number)
    try:
        _, output = started.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        os.killpg(started.pid, signal.SIGKILL)
        return "hangs"
    if _group(started.pid):
        os.killpg(started.pid, signal.SIGKILL)
        return "a process is left"
    return _verdict(started.returncode, output, case.number, listened)


def _verdict(code: int, output: str, number: int, listened: bool | None) -> str:
    interrupted = output.startswith("error: interrupted") and output.count("\n") == 1
    if code == 128 + number:
        return "128 + N" if interrupted else f"says {output!r}"
    if listened is None or (code in (0, 1) and "Traceback" not in output):
        return "had finished"
    if not listened:  # the signal's own end, or whatever Python's start makes of it
        return "before the first line of cellc"
    return f"ended with {code}: {output[-300:]!r}"


def _catches(process: int, number: int) -> bool | None:
    """Whether a process has a handler for a signal; None where it has ended (Linux: proc(5), SigCgt)."""
    try:
        status = Path(f"/proc/{process}/status").read_text()
    except OSError:
        return None
    if "\nState:\tZ" in status:
        return None
    caught = int(status.partition("SigCgt:")[2].split()[0], 16)
    ignored = int(status.partition("SigIgn:")[2].split()[0], 16)
    return bool((caught | ignored) >> (number - 1) & 1)


def _group(leader: int) -> list[int]:
    """Return the processes of a group that have not ended; the tracker of multiprocessing has a second for it."""
    for _ in range(20):
        left = [int(entry.name) for entry in Path("/proc").iterdir() if entry.name.isdigit() and _is_in(entry, leader)]
        if not left:
            return []
        time.sleep(0.05)
    return left


def _is_in(entry: Path, leader: int) -> bool:
    try:
        state, _, group = (entry / "stat").read_text().rpartition(")")[2].split()[:3]
    except (OSError, ValueError):
        return False
    return int(group) == leader and state != "Z"


def _contents(folder: Path) -> dict[str, dict[str, bytes]]:
    """Return the files of each folder of a cell; one of something temporary is a cell of no known name."""
    cells = sorted(folder.iterdir()) if folder.is_dir() else []
    return {cell.name: {str(file): file.read_bytes() for file in cell.rglob("*") if file.is_file()} for cell in cells}


if __name__ == "__main__":
    main()
