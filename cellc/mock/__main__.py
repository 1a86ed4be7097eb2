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


def _arguments() -> _Parser:
    parser = _Parser(prog="python -m cellc.mock", description="Run the rehearsals of a generated folder.")
    parser.add_argument("folder", help="folder that `cellc build` wrote")
    parser.add_argument("--campaign", action="store_true", help="run every fault at every step, and print the matrix")
    parser.add_argument("--pairs", type=int, default=0, metavar="N", help="with --campaign: runs with two faults each")
    parser.add_argument("--sweep", type=int, default=0, metavar="N", help="draw what is uncertain in up to N runs")
    parser.add_argument("--journal", metavar="FILE", help="with --sweep: keep each run here, and go on from it")
    parser.add_argument("--jobs", type=int, metavar="N", help="processes, as many as cores by default")
    parser.add_argument("--cluster", metavar="ADDRESS", help="a scheduler of Dask instead, tcp://HOST:8786")
    parser.add_argument("--list", action="store_true", help="print the runs of the campaign, and run none")
    parser.add_argument("--replay", action="append", default=[], metavar="RUN", help="run this run alone; repeatable")
    parser.add_argument("--gates", action="store_true", help="run rehearsals and campaign, and judge gates L6, G1, G2")
    parser.add_argument("--json", action="store_true", help="print a JSON summary")
    parser.add_argument(
        "--rehearsal", action="append", default=[], metavar="NAME", help="run this one only; repeatable"
    )
    parser.add_argument("--records", metavar="FILE", help="write the attempt records as JSON lines")
    parser.add_argument("--evidence", metavar="FOLDER", help="write bags, records, key figures and a report")
    parser.add_argument("--seed", type=int, default=0, help="seed of everything drawn (default 0)")
    parser.add_argument("--edited", action="store_true", help="run a folder that was edited; every result says so")
    parser.add_argument("--live", action="store_true", help="show the rehearsals in Foxglove, in real time")
    parser.add_argument("--listen", metavar="HOST:PORT", help="with --live: where Foxglove connects")
    parser.add_argument("--speed", type=float, metavar="X", help="with --live: X times as fast as real time")
    parser.add_argument(
        "--limit", action="append", default=[], metavar="NAME=VALUE", help="raise a limit of docs/limits.md; repeatable"
    )
    return parser


def main() -> int:
    """Parse the command line and run; the import is inside, so that Ctrl-C while it loads ends well too."""
    from cellc.contract.limits import LimitError, raised, use
    from cellc.mock.command.options import MockOptions, run_mock

    parser = _arguments()
    given = parser.parse_args()
    try:
        use(raised(given.limit))
    except LimitError as unknown:
        parser.error(str(unknown))
    options = MockOptions(
        folder=given.folder,
        program="python -m cellc.mock",
        rehearsals=tuple(given.rehearsal),
        campaign=given.campaign,
        list_only=given.list,
        replay=tuple(given.replay),
        gates=given.gates,
        pairs=given.pairs,
        sweep=given.sweep,
        journal=given.journal,
        jobs=given.jobs,
        cluster=given.cluster,
        as_json=given.json,
        records=given.records,
        evidence=given.evidence,
        seed=given.seed,
        edited=given.edited,
        live=given.live,
        listen=given.listen,
        speed=given.speed,
    )
    problem = options.contradiction()
    if problem:
        parser.error(problem)
    return run_mock(options)


if __name__ == "__main__":
    os.environ["PYTHONSAFEPATH"] = "1"  # of its own processes: `-c` looks in the current folder first too
    if not sys.warnoptions:  # as in `cellc.__main__`
        warnings.simplefilter("ignore")
        os.environ["PYTHONWARNINGS"] = "ignore"
    sys.exit(run_program(partial(run_to_end, main)))
