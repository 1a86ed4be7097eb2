"""``python -m cellc.mock FOLDER``: runs the rehearsals of a generated folder without the compiler."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys


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
    # Imported here, so that Ctrl-C while the planning libraries load ends without a traceback too.
    from cellc.mock.command import run_command

    return run_command(
        options.folder, names=options.rehearsal, as_json=options.json, records=options.records, seed=options.seed
    )


def _discard_output() -> None:
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    try:
        code = main()
        sys.stdout.flush()
    except BrokenPipeError:  # who read the output has seen enough, as `head` does
        _discard_output()
        code = 1
    except OSError as problem:
        _discard_output()
        print(f"error: {(problem.strerror or 'unknown reason').lower()}", file=sys.stderr)
        code = 1
    except KeyboardInterrupt:
        print("error: interrupted; no records were written", file=sys.stderr)
        code = 2
    sys.exit(code)
