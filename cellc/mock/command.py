"""The command behind ``cellc mock`` and ``python -m cellc.mock``: run, report, and say how it went."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from time import perf_counter

from cellc.mock.cell import MockCell, load
from cellc.mock.errors import MockError
from cellc.mock.evidence.begin import begin_evidence
from cellc.mock.record import to_json_lines
from cellc.mock.result import RehearsalResult
from cellc.mock.summary import TimedResult, to_lines, to_summary_json
from cellc.mock.write_text import write_text


def run_command(
    folder: str,
    *,
    names: Sequence[str] = (),
    as_json: bool = False,
    records: str | None = None,
    evidence: str | None = None,
    seed: int = 0,
) -> int:
    """Run rehearsals of a folder and print the results.

    Args:
        names: rehearsals to run; all where there are none.
        as_json: print a JSON summary in place of lines for people.
        records: file that the attempt records are written to, as JSON lines.
        evidence: folder that bags, records, figures and a report are written to.
        seed: of everything that is drawn.

    Returns:
        0 where every rehearsal passed, 1 where one did not or there is none, 2 where the folder or a name is unusable.
    """
    try:
        if seed < 0:
            raise MockError("", f"the seed is {seed}; it must be 0 or greater")
        cell = load(Path(folder))
        chosen = tuple(dict.fromkeys(names)) or cell.rehearsals
        timed = _run(cell, chosen, seed) if evidence is None else _run_with_evidence(cell, chosen, seed, Path(evidence))
        if records is not None:
            write_text(Path(records), to_json_lines(record for each in timed for record in each.result.attempts))
    except MockError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("error: interrupted; nothing was written", file=sys.stderr)
        return 2
    if as_json:
        print(to_summary_json(cell.contract.configuration_id, timed, cell.notes))
    else:
        print("\n".join(to_lines(timed, cell.notes)))
    return 0 if timed and all(each.result.passed for each in timed) else 1


def _run(cell: MockCell, names: Sequence[str], seed: int) -> list[TimedResult]:
    return _timed(names, lambda name: cell.run(name, seed=seed))


def _run_with_evidence(cell: MockCell, names: Sequence[str], seed: int, folder: Path) -> list[TimedResult]:
    with begin_evidence(cell, folder, names, seed) as collector:
        timed = _timed(names, collector.run)
        collector.settle()
    return timed


def _timed(names: Sequence[str], run: Callable[[str], RehearsalResult]) -> list[TimedResult]:
    on_terminal = sys.stderr.isatty()
    timed: list[TimedResult] = []
    for number, name in enumerate(names, start=1):
        if on_terminal:
            print(f"\r\x1b[Krehearsal {number} of {len(names)}: {name}", end="", file=sys.stderr, flush=True)
        begun = perf_counter()
        result = run(name)
        timed.append(TimedResult(result, perf_counter() - begun))
    if on_terminal:
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)
    return timed
