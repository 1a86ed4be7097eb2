"""Many cells in one table: a row for each cell with each version tuple."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import Diagnostic, Findings
from cellc.contract.diagnostics.wording import aligned
from cellc.contract.fleet import FleetRow, FleetSweep
from cellc.contract.printing import Line, Style, Styled
from cellc.tools.report.text_report import render_text

_COUNTED = {Severity.ERROR: "errors", Severity.BLOCKER: "blockers", Severity.WARNING: "warnings"}
_NONE = "-"


def fleet_lines(rows: Sequence[FleetRow]) -> Iterator[Line]:
    """Yield the table, and below it why there is no result of a row, and which rehearsals failed."""
    parts = tuple(dict.fromkeys(part for row in rows for part in row.versions))
    labels = [row.label for row in rows]
    names = [row.cell if row.cell and labels.count(row.label) == 1 else row.source for row in rows]
    table = [("cell", *parts, *_COUNTED.values(), "rehearsals", "sweep")]
    table += [(name, *_columns(row, parts)) for name, row in zip(names, rows, strict=True)]
    shown = [place for place in range(len(table[0])) if any(row[place] != _NONE for row in table[1:])]
    lines = aligned([row[place] for place in shown] for row in table)
    verdicts = ["", *("passed" if row.passed else "FAILED" for row in rows)]
    if all(row.rehearsals is None and row.sweeps is None for row in rows):
        yield ""  # findings stand above
    for verdict, line in zip(verdicts, lines, strict=True):
        style = {"passed": Style.GREEN, "FAILED": Style.RED}.get(verdict, Style.BOLD)
        yield (Styled(verdict.ljust(6), style), f"  {line}")
    for row in rows:
        failed = [
            f"`{rehearsal.name}` ended as {rehearsal.outcome}"
            for rehearsal in row.rehearsals or ()
            if not rehearsal.passed
        ]
        if row.problem or failed:
            yield f"{row.label}: {row.problem or ', '.join(failed)}"
    passed = sum(row.passed for row in rows)
    yield f"{passed} of {len(rows)} passed"


def _columns(row: FleetRow, parts: Sequence[str]) -> Iterator[str]:
    yield from (row.versions.get(part, _NONE) for part in parts)
    counted = Counter(finding.severity for finding in row.findings or ())
    yield from (_NONE if row.findings is None else str(counted[severity.value]) for severity in _COUNTED)
    ended = row.rehearsals
    yield _NONE if ended is None else f"{sum(rehearsal.passed for rehearsal in ended)} of {len(ended)}"
    yield ", ".join(map(_swept, row.sweeps or ())) or _NONE


def _swept(sweep: FleetSweep) -> str:
    verdict = "" if sweep.verdict is None else f" {sweep.verdict}"
    return f"{sweep.rehearsal} {sweep.succeeded} of {sweep.runs}{verdict}"


def render_combined(found: Sequence[tuple[str, Findings]], *, sum_blockers: bool = False) -> Iterator[Line]:
    """Yield the findings of one cell with several tuples, each once, under the tuples that have it.

    Args:
        found: name of each tuple, with what is found for it.
        sum_blockers: leave blockers to the table.
    """
    having: dict[Diagnostic, list[int]] = {}
    for number, (_, findings) in enumerate(found):
        for diagnostic in findings.diagnostics:
            if diagnostic.severity is Severity.BLOCKER and sum_blockers:
                continue
            having.setdefault(diagnostic, []).append(number)
    groups: dict[tuple[int, ...], list[Diagnostic]] = {}
    for diagnostic, numbers in having.items():
        groups.setdefault(tuple(dict.fromkeys(numbers)), []).append(diagnostic)
    for those, diagnostics in sorted(groups.items(), key=lambda group: (-len(group[0]), group[0])):
        every = 1 < len(found) == len(those)
        names = "every tuple" if every else "; ".join(found[number][0] for number in those)
        yield (Styled(f"{found[0][1].file} with {names}", Style.BOLD),)
        yield from render_text(diagnostics, found[those[0]][1].texts)
        yield ""
