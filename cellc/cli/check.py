"""``cellc check``: read, link and check cells; nothing is written."""

from __future__ import annotations

import click

from cellc.cli.findings import FAIL_ON, FORMAT, finish, show_findings
from cellc.pipeline import check as check_cell
from cellc.report.progress import progress


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=str))
@FORMAT
@FAIL_ON
def check(files: tuple[str, ...], output_format: str, fail_on: str) -> None:
    """Check each cell in FILES and point at what is wrong."""
    checked = []
    with progress("checking") as update:
        for file in files:
            update(file)
            checked.append(check_cell(file))
    show_findings(checked, output_format)
    finish(checked, fail_on)
