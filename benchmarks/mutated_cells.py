"""Checks thousands of randomly changed cells: counts tracebacks, and tells the slowest check.

``python benchmarks/mutated_cells.py [--count 2000] [--first 0]``; the changes are those of ``tests/robustness``.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from cellc.compiler.pipeline import check  # noqa: E402  the checkout comes before what is installed
from tests.robustness.mutations import mutated  # noqa: E402


def main() -> None:
    """Print the figures, and the first lines of each traceback with its seed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="seed of the first change")
    options = parser.parse_args()
    texts = [file.read_text(encoding="utf-8") for file in sorted((ROOT / "cells").glob("*/cell.yaml"))]
    failed = clean = 0
    slowest = 0.0
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "cell.yaml"
        for seed in range(options.first, options.first + options.count):
            file.write_bytes(mutated(texts[seed % len(texts)], seed).encode("utf-8", "surrogatepass"))
            begin = time.perf_counter()
            try:
                clean += not check(file).diagnostics
            except Exception:  # a traceback is what is looked for
                failed += 1
                print(f"seed {seed}:", *traceback.format_exc().splitlines()[-4:], sep="\n  ", flush=True)
            slowest = max(slowest, time.perf_counter() - begin)
    print(f"{options.count} changed cells: {failed} tracebacks, {clean} without finding, slowest {slowest:.2f} s")


if __name__ == "__main__":
    main()
