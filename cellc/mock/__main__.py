"""``python -m cellc.mock FOLDER``: runs the rehearsals of a generated folder without the compiler."""

from __future__ import annotations

import sys

if __name__ == "__main__" and not (sys.flags.isolated or getattr(sys.flags, "safe_path", False)):
    sys.path.pop(0)  # the current folder, as in `cellc.__main__`

import argparse
import os
import warnings
from functools import partial
from typing import NoReturn

from cellc.contract.printing import Stream, run_to_end, show
from cellc.contract.signals import run_program


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Say what is wrong with the call; what the user wrote stays on its line."""
        usage = self.format_usage().rstrip("\n").split("\n")
        show(*usage, f"{self.prog}: error: {message}", to=Stream.ERR)
        raise SystemExit(2)


def _path(text: str) -> str:
    if not text:
        raise argparse.ArgumentTypeError("cannot be written: its path is empty")
    return text


def _arguments() -> _Parser:
    parser = _Parser(prog="python -m cellc.mock", description="Run the rehearsals of a generated folder.")
    parser.add_argument("folder", help="folder that `cellc build` wrote")
    parser.add_argument("--json", action="store_true", help="print a JSON summary")
    parser.add_argument(
        "--rehearsal", action="append", default=[], metavar="NAME", help="run this one only; repeatable"
    )
    parser.add_argument("--records", metavar="FILE", type=_path, help="write the attempt records as JSON lines")
    parser.add_argument("--evidence", metavar="FOLDER", type=_path, help="write bags, records, figures and a report")
    parser.add_argument("--seed", type=int, default=0, help="seed of everything drawn (default 0)")
    parser.add_argument("--edited", action="store_true", help="run a folder that was edited; every result says so")
    parser.add_argument(
        "--limit", action="append", default=[], metavar="NAME=VALUE", help="raise a limit of docs/limits.md; repeatable"
    )
    return parser


def main() -> int:
    """Parse the command line and run; the import is inside, so that Ctrl-C while it loads ends well too."""
    from cellc.contract.limits import LimitError, raised, use

    parser = _arguments()
    given = parser.parse_args()
    try:
        use(raised(given.limit))
    except LimitError as unknown:
        parser.error(str(unknown))
    from cellc.mock.command.options import RehearsalOptions
    from cellc.mock.command.rehearsals import run_rehearsals

    return run_rehearsals(
        RehearsalOptions(
            given.folder,
            given.seed,
            given.edited,
            given.json,
            given.evidence,
            rehearsals=tuple(given.rehearsal),
            records=given.records,
        )
    )


if __name__ == "__main__":
    os.environ["PYTHONSAFEPATH"] = "1"  # of its own processes: `-c` looks in the current folder first too
    if not sys.warnoptions:  # as in `cellc.__main__`
        warnings.simplefilter("ignore")
        os.environ["PYTHONWARNINGS"] = "ignore"
    sys.exit(run_program(partial(run_to_end, main)))
