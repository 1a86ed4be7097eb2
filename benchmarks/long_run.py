"""Runs a rehearsal over and over in one plant for a simulated hour, and tells how much memory it holds meanwhile.

``python benchmarks/long_run.py [FOLDER] [--hours 1]``. What is reported is the size of all live Python and numpy
allocations (tracemalloc) at equal distances of simulated time: it may rise by what an attempt leaves in its record, and
by nothing else. It prints a Markdown table for ``benchmarks/README.md``.
"""

from __future__ import annotations

import argparse
import gc
import tracemalloc
from dataclasses import dataclass
from pathlib import Path

from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock import MockCell, load
from cellc.mock.plant import Plant

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True, slots=True)
class Sample:
    """Live allocations at a simulated time."""

    at_s: float
    held_bytes: int


def repeated(cell: MockCell, hours: float) -> RehearsalEntry:
    """Return the first rehearsal without faults, its steps repeated until they fill the time."""
    entry = next(entry for entry in cell.entries if not entry.faults)
    once_s = cell.run(entry.name).sim_time_s
    times = round(hours * 3600.0 / once_s) + 1
    return entry.model_copy(update={"steps": entry.steps * times, "timeout_s": 2.0 * hours * 3600.0})


def memory_over_time(cell: MockCell, entry: RehearsalEntry, every_s: float) -> tuple[list[Sample], int]:
    """Run and look at the memory now and then; return the samples and the number of attempts."""
    samples: list[Sample] = []

    def watch(plant: Plant) -> None:
        def look(index: int) -> None:
            gc.collect()
            samples.append(Sample(index * every_s, tracemalloc.get_traced_memory()[0]))

        plant.simulation.every(0, 1.0 / every_s, look)

    tracemalloc.start()
    result = cell.rehearse(entry, watch=watch)
    tracemalloc.stop()
    if not result.passed:
        raise SystemExit(f"{result.name} ended in {result.outcome}: {result.attempts[-1].fault_code}")
    return samples, len(result.attempts)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default=str(ROOT / "generated" / "ur5e_pick"))
    parser.add_argument("--hours", type=float, default=1.0)
    options = parser.parse_args()
    cell = load(Path(options.folder))
    entry = repeated(cell, options.hours)
    samples, attempts = memory_over_time(cell, entry, options.hours * 360.0)
    print("| simulated s | live allocations MB |\n|---|---|")
    for sample in samples:
        print(f"| {sample.at_s:.0f} | {sample.held_bytes / 1e6:.2f} |")
    half = samples[len(samples) // 2 :]
    grown = half[-1].held_bytes - half[0].held_bytes
    print(f"\n{attempts} attempts; in the second half {grown / (attempts / 2):.0f} bytes an attempt")


if __name__ == "__main__":
    main()
