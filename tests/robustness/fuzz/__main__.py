"""Replay one input, or judge thousands: ``python -m tests.robustness.fuzz --count 100000 --jobs 2 --state FOLDER``."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
from pathlib import Path

from tests.robustness.fuzz.bases import PARTS
from tests.robustness.fuzz.campaign import Campaign
from tests.robustness.fuzz.inputs import KINDS, make_input
from tests.robustness.fuzz.oracle import Sandbox
from tests.robustness.fuzz.worker import judge_alone


def main() -> int:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(prog="python -m tests.robustness.fuzz", description=__doc__)
    parser.add_argument("kind", nargs="?", choices=KINDS, help="replay one input of this kind")
    parser.add_argument("number", nargs="?", type=int, help="the number of the input to replay")
    parser.add_argument("--show", action="store_true", help="print the files of the input, and judge nothing")
    parser.add_argument("--write", metavar="FOLDER", help="write the files of the input into a folder")
    parser.add_argument("--count", type=int, help="judge so many inputs, the kinds in equal shares")
    parser.add_argument("--first", type=int, default=0, help="number of the first input of each kind")
    parser.add_argument("--kinds", default=",".join(KINDS), help="judge these kinds alone")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="processes")
    parser.add_argument("--state", metavar="FOLDER", help="keep what was done there, and go on where it ended")
    given = parser.parse_args()
    if given.count is not None:
        campaign = Campaign(tuple(given.kinds.split(",")), given.first, given.count, given.jobs, given.state)
        return campaign.run()
    if given.number is None:
        parser.error("name a kind and a number, or give --count")
    if given.show or given.write:
        _show(given.kind, given.number, given.write)
        return 0
    return _replay(given.kind, given.number)


def _show(kind: str, number: int, folder: str | None) -> None:
    shown = make_input(kind, number)
    for name, data in [*shown.files.items(), *((f"{name} (later)", data) for name, data in shown.later.items())]:
        if folder is None:
            print(f"=== {name}", data.decode("utf-8", "backslashreplace"), sep="\n")
        elif not name.endswith("(later)"):
            Path(folder, name).parent.mkdir(parents=True, exist_ok=True)
            Path(folder, name).write_bytes(data)
    if folder is not None:
        shutil.copytree(PARTS, Path(folder, "parts"), dirs_exist_ok=True)
    if shown.damage:
        print(f"=== the cache: {', '.join(shown.damage)}")


def _replay(kind: str, number: int) -> int:
    with tempfile.TemporaryDirectory() as name:
        found, took, peak = judge_alone(kind, number, Sandbox(Path(name)))
    for finding in found:
        print(f"{finding.wrong}: {finding.text}")
    print(json.dumps({"finds": len(found), "s": round(took, 3), "mb": round(peak / 2**20)}))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
