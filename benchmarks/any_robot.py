"""Every robot of a folder through import, check, build and mock: one row each, and how many moved.

    nice python -m benchmarks.any_robot FOLDER [PART-OF-A-NAME …]

FOLDER holds URDF files somewhere below, such as `share/example-robot-data/robots` of the PyPI package
`example-robot-data`. Each command is a process of its own, with a bound of time; two robots are done at a time.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from cellc.printing import show

_WITHIN_S = 1200.0
_STEPS = ("import", "build", "mock")


@dataclass(frozen=True, slots=True)
class Row:
    """How far a robot came, in how many seconds, and the first line of why no farther."""

    robot: str
    outcome: str
    seconds: float
    why: str


def main() -> None:
    """Print the table."""
    folder, parts = Path(sys.argv[1]).resolve(), sys.argv[2:]
    files = [file for file in sorted(folder.rglob("*.urdf")) if not parts or any(part in str(file) for part in parts)]
    with tempfile.TemporaryDirectory() as place, ThreadPoolExecutor(2) as pool:
        rows = []
        for row in pool.map(partial(_through, Path(place)), files):
            rows.append(row)
            show(f"| {row.robot} | {row.outcome} | {row.seconds:.0f} s | {row.why} |")
    show(", ".join(f"{count} {outcome}" for outcome, count in Counter(row.outcome for row in rows).most_common()))


def _through(place: Path, file: Path) -> Row:
    begun, name = time.monotonic(), file.stem
    folder = place / re.sub(r"\W", "_", "_".join(file.parts[-3:]))
    folder.mkdir()
    for step, ended in zip(_STEPS, _runs(folder, file), strict=False):
        output = ended.stdout + ended.stderr
        if ended.returncode:
            outcome = next((word for word in ("Traceback", "bug of cellc") if word in output), f"no {step}")
            return Row(name, outcome, time.monotonic() - begun, _reason(output))
    return Row(name, "moves", time.monotonic() - begun, "")


def _runs(folder: Path, file: Path) -> Iterator[subprocess.CompletedProcess[str]]:
    for arguments in (
        ("import", str(file), "--cell", "-o", "robot"),
        ("build", "cell.yaml"),
        ("mock", "generated/robot_cell"),
    ):
        command = [sys.executable, "-m", "cellc", *arguments]
        try:
            yield subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=_WITHIN_S, check=False)
        except subprocess.TimeoutExpired:
            yield subprocess.CompletedProcess(command, 1, "", f"takes longer than {_WITHIN_S:g} s")


def _reason(output: str) -> str:
    told = re.compile(r"error|refused|FAILED|\s+reason|usage|Error|takes")
    lines = [line for line in output.splitlines() if told.match(line)]
    codes = sorted({match[1] for line in lines if (match := re.match(r"error\[([\w-]+)\]", line))})
    return f"{' '.join(codes)}: {' '.join(lines)[:200]}"


if __name__ == "__main__":
    main()
