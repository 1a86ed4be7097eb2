"""``python -m cellc.mock FOLDER``: runs the rehearsals of a generated folder without the compiler."""

from __future__ import annotations

import argparse
import os
import sys

from cellc.mock.command import run_command


def main() -> int:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(
        prog="python -m cellc.mock", description="Run the rehearsals of a generated folder."
    )
    parser.add_argument("folder", help="folder that `cellc build` wrote")
    parser.add_argument("--json", action="store_true", help="print a JSON summary")
    parser.add_argument(
        "--rehearsal", action="append", default=[], metavar="NAME", help="run this one only; repeatable"
    )
    parser.add_argument("--records", metavar="FILE", help="write the attempt records as JSON lines")
    parser.add_argument("--seed", type=int, default=0, help="seed of everything drawn (default 0)")
    options = parser.parse_args()
    return run_command(
        options.folder, names=options.rehearsal, as_json=options.json, records=options.records, seed=options.seed
    )


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BrokenPipeError:  # who read the output has seen enough, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
