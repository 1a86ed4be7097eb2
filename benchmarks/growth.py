"""Says with which power of its size the time and the memory of a check and of a build grow, for each kind of cell.

``python -m benchmarks.growth [KIND ...] [--runs 3]``. A hall has one kind of thing, of three sizes: once, twice and
four times as many. What every cell costs drops out of the differences: the power is
``log2((four - two) / (two - one))``, 1 where twice the things take twice as much. Each size is read in a child
that begins with all modules loaded; the least processor time of some runs counts, and the peak of its memory.
Prints rows of a Markdown table for ``benchmarks/README.md``.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from benchmarks.plant import plant
from cellc.compiler.pipeline import check, emit_cell
from cellc.contract.diagnostics import Severity
from tests.rules.halls import HALLS

SIZES: dict[str, int] = {"of_groups": 6, "of_arms": 15, "plant": 3}
"""How many things the smallest of the three cells has, where that is not `USUAL`: motions take long to find."""
USUAL = 60


def _stations(size: int) -> str:
    return json.dumps(plant(size))


KINDS: dict[str, Callable[[int], str]] = {kind.__name__: kind for kind in HALLS} | {"plant": _stations}


def measured(file: Path) -> tuple[float, float, float]:
    """Check and emit a cell in a child; return the seconds of processor time of each, and the peak in MB."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        begun = time.process_time()
        checked = check(file)
        between = time.process_time()
        emitted = emit_cell(checked)
        ended = time.process_time()
        assert emitted.value is not None, [found.message for found in checked if found.severity is Severity.ERROR][:3]
        os.write(writing, json.dumps([between - begun, ended - between]).encode())
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as answer:
        text = answer.read()
    _, status, used = os.wait4(child, 0)
    if status:
        raise SystemExit(f"{file}: a child ended with {os.waitstatus_to_exitcode(status)}")
    checking, emitting = json.loads(text)
    return checking, emitting, used.ru_maxrss / 1024


def power(one: float, two: float, four: float) -> float:
    """Return the power of what is added; 0 where nothing that can be measured is."""
    first, then = two - one, four - two
    return math.log2(then / first) if min(first, then) > 0 else 0.0


def row(kind: str, folder: Path, runs: int) -> str:
    """Return a row of the table."""
    first = SIZES.get(kind, USUAL)
    sizes = (first, 2 * first, 4 * first)
    figures = [_least(KINDS[kind](size), folder / "cell.yaml", runs) for size in sizes]
    checks, emits, peaks = zip(*figures, strict=True)
    columns = [kind, str(sizes[-1])]
    columns += [f"{checks[-1]:.2f}", f"{power(*checks):.2f}", f"{emits[-1]:.2f}", f"{power(*emits):.2f}"]
    return f"| {' | '.join([*columns, f'{peaks[-1]:.0f}', f'{power(*peaks):.2f}'])} |"


def _least(text: str, file: Path, runs: int) -> Sequence[float]:
    file.write_text(text, encoding="utf-8")
    return [min(column) for column in zip(*(measured(file) for _ in range(runs)), strict=True)]


def _rows(kinds: Sequence[str], runs: int) -> Iterator[str]:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "cell.yaml").write_text(KINDS["of_groups"](1), encoding="utf-8")
        emit_cell(check(folder / "cell.yaml"))  # loads what is loaded once
        yield from map(partial(row, folder=folder, runs=runs), kinds)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", choices=[[], *KINDS], help="all of them by default")
    parser.add_argument("--runs", type=int, default=3)
    asked = parser.parse_args()
    print("| cell | things | check, s | power | emit, s | power | peak, MB | power |")
    print("|---|---|---|---|---|---|---|---|")
    for line in _rows(asked.kinds or list(KINDS), asked.runs):
        print(line, flush=True)


if __name__ == "__main__":
    main()
