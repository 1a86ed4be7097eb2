"""``cellc explain``: what a diagnostic code means, why it matters, and how to fix it."""

from __future__ import annotations

from pathlib import Path

import click

from cellc.compiler.pages import all_codes, render_handbook, render_page
from cellc.contract.code_page import meant_code, page_of
from cellc.contract.diagnostics.wording import aligned
from cellc.contract.printing import show
from cellc.tools.cli.handbook import write_pages
from cellc.tools.cli.words import complete_code
from cellc.tools.report.terminal_form import show_markdown


@click.command()
@click.argument("code", required=False, shell_complete=complete_code)
@click.option("--all", "everything", is_flag=True, help="Print the page of every code.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="With --all, write all pages to a folder: an index, and one file for each code.",
)
def explain(code: str | None, everything: bool, output: Path | None) -> None:
    """Explain CODE, or list all codes.

    \b
    cellc explain                              all codes, a line each
    cellc explain frame-cycle
    """
    codes = all_codes()
    if output is not None:
        if not everything:
            raise click.UsageError("--output writes the pages of all codes; add --all")
        write_pages(output, render_handbook())
        show(f"wrote {output.as_posix()}")
    elif everything:
        show_markdown("\n".join(render_page(page_of(known)) for known in codes))
    elif code is None:
        show(*aligned((known, severity.value, page_of(known).title) for known, severity in codes.items()))
    elif code in codes:
        show_markdown(render_page(page_of(code)))
    else:
        raise click.UsageError(f"there is no code `{code}`: {meant_code(code, codes, 'codes')}")
