"""Times one call that checks many cells: on one core and on all, with and without kept geometry.

Run it on a quiet machine: ``python benchmarks/many_cells.py [--cells 100]``. The cells are the three of ``cells/``
over and over, each with a name and a size of its table of its own, so that those that have one differ in geometry.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from cellc.contract.compute.processes import usable_cores

ROOT = Path(__file__).resolve().parents[1]
TEMPLATES = sorted((ROOT / "cells").glob("*/cell.yaml"))

_BOUND = """
import os, sys
os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: int(sys.argv.pop(1))])
from cellc.__main__ import main
if __name__ == "__main__":
    main()
"""


def write_cells(folder: Path, count: int) -> list[str]:
    """Write the cells and return their names."""
    names = []
    for number in range(count):
        template = TEMPLATES[number % len(TEMPLATES)]
        text = template.read_text(encoding="utf-8")
        text = text.replace(f"cell: {template.parent.name}\n", f"cell: cell_{number}\n")
        text = re.sub(r"box: (\d+) ", rf"box: \1.{number:03} ", text)
        (folder / f"cell_{number}.yaml").write_text(text, encoding="utf-8")
        names.append(f"cell_{number}.yaml")
    return names


def measured(files: list[str], folder: Path, cores: int, is_first: bool, runs: int) -> tuple[float, float]:
    """Check all cells in one call, once without counting.

    Args:
        is_first: whether the cache is emptied before each run.

    Returns:
        Medians of wall time and of time on all processors in s.
    """
    times, used = [], []
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"XDG_CACHE_HOME": str(folder / "cache"), "PYTHONPATH": str(ROOT)}
    environment |= {"PYTHONPYCACHEPREFIX": str(folder / "modules")}  # compiled modules, as a user has them
    for run in range(runs + 1):
        if is_first:
            shutil.rmtree(folder / "cache/cellc", ignore_errors=True)
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-c", _BOUND, str(cores), "check", *files],
            cwd=folder,
            env=environment,
            capture_output=True,
            check=False,
        )
        # Cells of one call that share a domain get findings; they are no failure here.
        if done.returncode not in (0, 1) or done.stderr:
            raise SystemExit(done.stderr.decode())
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if run == 0:
            continue
        times.append(time.perf_counter() - begin)
        used.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return statistics.median(times), statistics.median(used)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=100)
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    print(f"| {options.cells} cells | cores | median s | CPU s |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = write_cells(folder, options.cells)
        for label, is_first in (("nothing kept", True), ("geometry kept", False)):
            for cores in sorted({1, usable_cores()}):
                wall, used = measured(files, folder, cores, is_first, options.runs)
                print(f"| {label} | {cores} | {wall:.2f} | {used:.2f} |", flush=True)


if __name__ == "__main__":
    main()
