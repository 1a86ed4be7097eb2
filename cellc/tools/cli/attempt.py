"""``cellc attempt``: from the bags of an attempt to its record."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.printing import refuse, show, show_document
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.words import complete_rehearsal
from cellc.tools.cli.written import write_reports

if TYPE_CHECKING:
    from cellc.tools.attempt.record import Report


@click.command()
@click.argument("bags", nargs=-1, required=True, metavar="BAG...", type=click.Path(path_type=Path))
@click.option(
    "--package",
    metavar="FOLDER",
    type=click.Path(path_type=str),
    help="Generated folder that was recorded; `generated/NAME` by default where the bag names its cell.",
)
@click.option(
    "--task",
    metavar="NAME",
    shell_complete=complete_rehearsal,
    help="Rehearsal whose steps the task made; the one the bag is named after by default.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="Also write NAME.attempt.json, .md and .html to this folder; the page has plots.",
)
@click.option(
    "--against",
    metavar="REHEARSAL|FILE",
    shell_complete=complete_rehearsal,
    help="Compare with this: a rehearsal of the package, which is run, another bag, or a file of records.",
)
@click.option(
    "--format",
    "output_format",
    type=click.Choice(["text", "markdown", "json", "html"]),
    default="text",
    show_default=True,
    help="Output format; html is one page with plots.",
)
@limit_option
def attempt(
    bags: tuple[Path, ...],
    package: str | None,
    task: str | None,
    output: Path | None,
    against: str | None,
    output_format: str,
) -> None:
    """Read each BAG of one attempt, and print its record and the layer in which it failed.

    A BAG is a folder of rosbag2 or one of its files, MCAP or sqlite3, recorded on the cell or by the mock; parts of a
    split bag are read as one. What the bag does not show is UNKNOWN, with what would have to be recorded. Exit 1 if
    the attempt failed or its outcome is UNKNOWN.

    With --against, also say where attempt and rehearsal part, and what the bag measures of figures of the spec. A file
    of records, NAME.records.jsonl of the mock or NAME.attempt.json, has outcomes and times alone.

    \b
    cellc attempt bags/1 --package generated/bench --task pick
    cellc attempt evidence/1/pick.mcap -o attempts         writes a page with plots too
    cellc attempt bags/1 --package generated/bench --task pick --against pick
    cellc attempt bag_0.mcap bag_1.mcap --package generated/bench --format json
    """
    read = _read(bags, package, task, against, drawn=output is not None or output_format == "html")
    if output_format == "text":
        from cellc.tools.attempt.text import render_text

        show(*render_text(read.report))
    else:
        show_document(read.rendered(output_format))
    if output is not None:
        _write(read, output, bags[0])
    report = read.report
    if report.end.outcome is None or report.end.outcome.value != "succeeded":
        raise click.exceptions.Exit(1)


@dataclass(frozen=True)
class _Read:
    """A report, with what its page needs of the package."""

    report: Report
    tolerances: Mapping[str, float]

    def rendered(self, form: str) -> str:
        """Return the document of a form: json, markdown or html."""
        if form == "html":
            from cellc.tools.attempt.page import render_page

            return render_page(self.report, self.tolerances)
        from cellc.tools.attempt.record import to_json
        from cellc.tools.attempt.text import render_markdown

        return to_json(self.report) if form == "json" else render_markdown(self.report)


def _read(bags: tuple[Path, ...], package: str | None, task: str | None, against: str | None, *, drawn: bool) -> _Read:
    # Reading loads NumPy and the reader of bags.
    from cellc.mock.errors import MockError
    from cellc.mock.folder import path_tolerances, read_folder
    from cellc.tools.attempt.against import compared
    from cellc.tools.attempt.bag import BagError
    from cellc.tools.attempt.read import Drawn, cell_of, read_attempt

    try:
        named = package
        if named is None:
            cell = cell_of(bags)
            if cell is None:
                raise BagError(
                    f"{bags[0].as_posix()}: does not name its cell; name the generated folder with --package"
                )
            named = os.path.join("generated", cell)
        folder = read_folder(Path(named))
        drawing = None
        if drawn or against is not None:
            sliding = [joint.name for joint in folder.description.joints if joint.slides]
            drawing = Drawn(sliding, path_tolerances(folder.parameters))
        report = read_attempt(bags, folder.contract, folder.rehearsals, folder.watches, task, drawing)
        if against is not None and drawing is not None:
            report = compared(report, folder, against, drawing)
        return _Read(report, {} if drawing is None else drawing.tolerances)
    except (BagError, MockError) as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None


def _write(read: _Read, output: Path, bag: Path) -> None:
    """Write the record for programs and for people; a file of others is left as it is."""
    stem, cell = (bag.stem if bag.suffix else bag.resolve().name) + ".attempt", read.report.contract.cell
    marks = {"json": f'"cell": "{cell}",', "md": f"# Attempt of `{cell}`", "html": f"<title>{cell}: an attempt</title>"}
    forms = {"json": "json", "md": "markdown", "html": "html"}
    write_reports(output, {f"{stem}.{suffix}": (read.rendered(form), marks[suffix]) for suffix, form in forms.items()})
