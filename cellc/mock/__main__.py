"""``python -m cellc.mock FOLDER``: runs the rehearsals of a generated folder without the compiler."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

from cellc.mock.cell import MockCell, load
from cellc.mock.errors import MockError
from cellc.mock.record import to_json_lines
from cellc.mock.summary import TimedResult, to_lines, to_summary_json


def main(arguments: Sequence[str] | None = None) -> int:
    """Run and report; return 0 where every rehearsal passed, 1 where one did not, 2 where the folder is unusable."""
    options = _parser().parse_args(arguments)
    try:
        cell = load(options.folder)
        timed = [_timed(cell, name, options.seed) for name in options.rehearsal or cell.rehearsals]
    except MockError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    if options.records is not None:
        records = to_json_lines(record for each in timed for record in each.result.attempts)
        try:
            options.records.write_text(records, encoding="utf-8", newline="\n")
        except OSError as error:
            print(f"error: {options.records.as_posix()}: cannot be written: {error.strerror}", file=sys.stderr)
            return 2
    if options.json:
        print(to_summary_json(cell.contract.configuration_id, timed, cell.notes))
    else:
        print("\n".join(to_lines(timed, cell.notes)))
    return 0 if all(each.result.passed for each in timed) else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m cellc.mock", description="Run the rehearsals of a generated folder."
    )
    parser.add_argument("folder", type=Path, help="folder that `cellc build` wrote")
    parser.add_argument("--json", action="store_true", help="print a JSON summary")
    parser.add_argument("--rehearsal", action="append", metavar="NAME", help="run this one only; may be repeated")
    parser.add_argument("--records", type=Path, metavar="FILE", help="write the attempt records as JSON lines")
    parser.add_argument("--seed", type=int, default=0, help="seed of everything drawn (default 0)")
    return parser


def _timed(cell: MockCell, name: str, seed: int) -> TimedResult:
    begun = perf_counter()
    result = cell.run(name, seed=seed)
    return TimedResult(result, perf_counter() - begun)


if __name__ == "__main__":
    sys.exit(main())
