"""``cellc check``: read, link and check cells; nothing is written but what ``--fix`` mends."""

from __future__ import annotations

import click

from cellc.cli.answers import answers
from cellc.cli.findings import FAIL_ON, FORMAT, finish, number_hidden, show_findings
from cellc.cli.fixing import FIX, fix_file
from cellc.cli.selecting import IGNORE, SELECT, read_selection, selected
from cellc.report.progress import progress


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=str))
@FIX
@SELECT
@IGNORE
@FORMAT
@FAIL_ON
def check(
    files: tuple[str, ...],
    fix: bool,
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    output_format: str,
    fail_on: str,
) -> None:
    """Check each cell in FILES and point at what is wrong."""
    wanted = read_selection(select, ignore)
    found = []
    with progress("checking") as update:
        for file in files if fix else ():
            update(file)
            fix_file(file)
        computed = answers("check", files)
        for file in files:
            update(file)
            found.append(next(computed).findings)
    shown = [selected(one, wanted) for one in found]
    show_findings(shown, output_format, hidden=number_hidden(found, shown))
    finish(shown, fail_on)
