"""Every robot of a folder or of a list through import, check, build and mock: one row each, and how many moved.

    nice python -m benchmarks.any_robot FOLDER|LIST [-o FOLDER] [PART-OF-A-NAME …]

A folder holds URDF and xacro files somewhere below, such as `share/example-robot-data/robots` of the PyPI package
`example-robot-data`. A list has a line `NAME | FILE | NAME:=VALUE …` for each robot, its files relative to the list;
lines that begin with `#` are left out. What was made of the robots stays in `-o FOLDER`. Each command is a process of
its own, with a bound of time; two robots are done at a time.
"""

from __future__ import annotations

import argparse
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

from cellc.contract.printing import show
from cellc.tools.importing.source import descriptions_in

_WITHIN_S = 1200.0
_STEPS = ("import", "build", "mock")


@dataclass(frozen=True, slots=True)
class Robot:
    """A description to try, with the arguments of its xacro."""

    name: str
    file: Path
    arguments: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Row:
    """How far a robot got, in how many seconds, what it was imported as, and the first line of why no farther."""

    robot: str
    outcome: str
    seconds: float
    kind: str
    why: str


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robots", type=Path)
    parser.add_argument("parts", nargs="*")
    parser.add_argument("-o", "--output", type=Path)
    given = parser.parse_args()
    robots = [robot for robot in _robots(given.robots.resolve()) if not given.parts or _named(robot, given.parts)]
    with tempfile.TemporaryDirectory() as place, ThreadPoolExecutor(2) as pool:
        rows = []
        for row in pool.map(partial(_through, given.output or Path(place)), robots):
            rows.append(row)
            show(f"| {row.robot} | {row.kind} | {row.outcome} | {row.seconds:.0f} s | {row.why} |")
    show(", ".join(f"{count} {outcome}" for outcome, count in Counter(row.outcome for row in rows).most_common()))


def _robots(place: Path) -> Iterator[Robot]:
    if place.is_dir():
        yield from (Robot(file.stem, file) for file in descriptions_in(place))
        return
    for line in place.read_text(encoding="utf-8").splitlines():
        name, _, rest = line.partition("|")
        file, _, arguments = rest.partition("|")
        if file and not name.startswith("#"):
            yield Robot(name.strip(), place.parent / file.strip(), tuple(arguments.split()))


def _named(robot: Robot, parts: list[str]) -> bool:
    return any(part in robot.name or part in str(robot.file) for part in parts)


def _through(place: Path, robot: Robot) -> Row:
    begun = time.monotonic()
    folder = place / re.sub(r"\W", "_", "_".join((robot.name, *robot.file.parts[-3:])))
    folder.mkdir(parents=True)
    kind, outcome, why = "", "moves", ""
    for step, ended in zip(_STEPS, _runs(folder, robot), strict=False):
        output = ended.stdout + ended.stderr
        (folder / f"{step}.txt").write_text(output, encoding="utf-8")
        told = re.search(r"^kind: (\w+)", output, re.MULTILINE)
        kind = told[1] if told else kind
        if ended.returncode:
            outcome = next((word for word in ("Traceback", "bug of cellc") if word in output), f"no {step}")
            why = _reason(output)
            break
    return Row(robot.name, outcome, time.monotonic() - begun, kind, why)


def _runs(folder: Path, robot: Robot) -> Iterator[subprocess.CompletedProcess[str]]:
    for arguments in (
        ("import", str(robot.file), *robot.arguments, "--cell", "-o", "robot"),
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
