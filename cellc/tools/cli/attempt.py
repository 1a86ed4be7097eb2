"""``cellc attempt``: from the bags of an attempt to its record."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.errors import reason_of
from cellc.contract.printing import refuse, show, show_document
from cellc.tools.cli.forms import FORM
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.words import complete_rehearsal

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
    help="Also write NAME.attempt.json and NAME.attempt.md to this folder.",
)
@FORM
@limit_option
def attempt(
    bags: tuple[Path, ...], package: str | None, task: str | None, output: Path | None, output_format: str
) -> None:
    """Read each BAG of one attempt, and print its record and the layer in which it failed.

    A BAG is a folder of rosbag2 or one of its files, MCAP or sqlite3, recorded on the cell or by the mock; parts of a
    split bag are read as one. What the bag does not show is UNKNOWN, with what would have to be recorded. Exit 1 if
    the attempt failed or its outcome is UNKNOWN.

    \b
    cellc attempt bags/1 --package generated/bench --task pick
    cellc attempt evidence/1/pick.mcap -o attempts
    cellc attempt bag_0.mcap bag_1.mcap --package generated/bench --format json
    """
    report = _read(bags, package, task)
    _tell(report, output_format)
    if output is not None:
        _write(report, output, bags[0])
    if report.end.outcome is None or report.end.outcome.value != "succeeded":
        raise click.exceptions.Exit(1)


def _read(bags: tuple[Path, ...], package: str | None, task: str | None) -> Report:
    # Reading loads NumPy and the reader of bags.
    from cellc.mock.errors import MockError
    from cellc.mock.folder import read_folder
    from cellc.tools.attempt.bag import BagError
    from cellc.tools.attempt.read import cell_of, read_attempt

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
        return read_attempt(bags, folder.contract, folder.rehearsals, folder.watches, task)
    except (BagError, MockError) as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None


def _tell(report: Report, output_format: str) -> None:
    from cellc.tools.attempt.record import to_json
    from cellc.tools.attempt.text import render_markdown, render_text

    if output_format == "json":
        show_document(to_json(report))
    elif output_format == "markdown":
        show_document(render_markdown(report))
    else:
        show(*render_text(report))


def _write(report: Report, output: Path, bag: Path) -> None:
    """Write the record for programs and for people; a file of others is left as it is."""
    from cellc.contract.store.swap import make_folder, replace_whole
    from cellc.tools.attempt.record import to_json
    from cellc.tools.attempt.text import render_markdown

    stem = (bag.stem if bag.suffix else bag.resolve().name) + ".attempt"
    texts = {f"{stem}.json": to_json(report), f"{stem}.md": render_markdown(report)}
    try:
        make_folder(output)
        for name, text in texts.items():
            _hold_own(output / name, text)
        for name, text in texts.items():
            replace_whole(output / name, text.encode())
    except OSError as error:
        refuse(f"{output.as_posix()}: cannot be written: {reason_of(error)}")
        raise click.exceptions.Exit(2) from None


def _hold_own(place: Path, text: str) -> None:
    """Refuse to replace what this command did not write."""
    from cellc.contract.store.regular_file import open_regular

    head = text[:12].encode()
    try:
        with open_regular(place) as stream:
            found = stream.read(len(head))
    except FileNotFoundError:
        return
    if found != head:
        refuse(f"{place.as_posix()}: is no file of this command; move it away, or name another folder")
        raise click.exceptions.Exit(2)
