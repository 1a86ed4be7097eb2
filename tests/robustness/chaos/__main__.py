"""Kill, fill, forbid and damage while cellc writes, and count what is left: prints a table.

    nice python -m tests.robustness.chaos --kills 400 --full 100 --rounds 50

Every run is a process of its own, forked from this one so that it spends its time in the command and not in imports.
Held after each: generated folders, records and evidence are as they were or as they shall be, or the next run heals
them; that one ends well, its result equals one made in an empty place, nothing temporary is left of either, and a file
that a person put into the folder is untouched. What is refused is refused with exit code 1 or 2 and a message.

On Linux, for root: it mounts a small tmpfs as the full disk, and takes another user where a folder is forbidden.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tests.robustness.chaos.scenarios import Chaos


def main() -> int:
    """Print the table; end with 1 where something did not hold."""
    parser = argparse.ArgumentParser(prog="python -m tests.robustness.chaos", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    for name, number in (("kills", 400), ("full", 100), ("forbidden", 30), ("rounds", 50), ("damages", 60)):
        parser.add_argument(f"--{name}", type=int, default=number)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="cellc-chaos-") as work:
        Path(work).chmod(0o755)
        chaos = Chaos(Path(work), chosen.seed)
        chaos.kills(chosen.kills)
        chaos.full(chosen.full)
        chaos.forbidden(chosen.forbidden)
        chaos.writers(chosen.rounds)
        chaos.cache(chosen.damages)
    print(chaos.table.show())
    print(f"{len(chaos.table.broken)} times something did not hold")
    return int(bool(chaos.table.broken))


if __name__ == "__main__":
    sys.exit(main())
