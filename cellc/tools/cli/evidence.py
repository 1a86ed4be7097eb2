"""``cellc evidence``: what a folder of evidence says of the gates, for those who sign."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.printing import refuse, show, show_document
from cellc.contract.vocabulary import NETWORK_GATES, PROMOTION_GATES, GateCode
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.written import write_reports

if TYPE_CHECKING:
    from cellc.tools.evidence.report import Report


@click.command()
@click.argument("folders", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--package",
    metavar="FOLDER",
    type=click.Path(path_type=str),
    help="Generated folder whose gates it is; `generated/NAME` by default where the evidence names one cell.",
)
@click.option(
    "--gate",
    "gates",
    multiple=True,
    type=click.Choice([*PROMOTION_GATES, *NETWORK_GATES]),
    help="Gate that is asked for; repeat it for several. All of the package by default.",
)
@click.option(
    "--format",
    "output_format",
    type=click.Choice(["text", "json", "html"]),
    default="text",
    show_default=True,
    help="Output format; the page prints on A4.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="Also write CELL.evidence.json and CELL.evidence.html to this folder.",
)
@limit_option
def evidence(
    folders: tuple[Path, ...], package: str | None, gates: tuple[str, ...], output_format: str, output: Path | None
) -> None:
    """List for every gate the evidence in each DIR, what is missing, and who signs.

    DIR is the folder of one attempt, `$E` of the checklists; folders below it may be of other computers. Where an
    attempt repeats gates, name the earlier attempts before it: of each gate, the last one counts. Evidence of another
    cell, configuration or host is refused. Reports of several hosts are joined. Nothing is signed. Exit 0 if all that
    is asked for is there and passed, after the gates before it, else 1.

    \b
    cellc evidence evidence/attempt-001
    cellc evidence evidence/attempt-001 evidence/attempt-002
    cellc evidence evidence/attempt-001 --gate G3 --gate L4 --package generated/bench
    cellc evidence evidence/attempt-001 --format html > handover.html
    """
    report = _read(folders, package, tuple(map(GateCode, gates)))
    _tell(report, output_format)
    if output is not None:
        _write(report, output)
    if not report.complete:
        raise click.exceptions.Exit(1)


def _read(folders: tuple[Path, ...], package: str | None, gates: tuple[GateCode, ...]) -> Report:
    from cellc.mock.errors import MockError
    from cellc.tools.evidence.folder import EvidenceError
    from cellc.tools.evidence.read import cell_of, report_of

    try:
        named = os.path.join("generated", cell_of(folders)) if package is None else package
        return report_of(folders, Path(named), gates)
    except (EvidenceError, MockError) as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None


def _tell(report: Report, output_format: str) -> None:
    from cellc.tools.evidence.page import to_html
    from cellc.tools.evidence.report import to_json
    from cellc.tools.evidence.text import render_text

    if output_format == "text":
        show(*render_text(report))
    else:
        show_document(to_json(report) if output_format == "json" else to_html(report))


def _write(report: Report, output: Path) -> None:
    """Write the report for programs and the page for people; a file of others is left as it is."""
    from cellc.tools.evidence.page import to_html
    from cellc.tools.evidence.report import to_json

    stem = f"{report.cell}.evidence"
    texts = {
        f"{stem}.json": (to_json(report), f'"cell": "{report.cell}",'),
        f"{stem}.html": (to_html(report), f"<title>{report.cell}: evidence of the gates</title>"),
    }
    write_reports(output, texts)
