"""``cellc explain``: what a diagnostic code means, why it matters, and how to fix it."""

from __future__ import annotations

from pathlib import Path

import click

from cellc.compiler.pages import all_pages, render_handbook, render_page
from cellc.contract.diagnostics import did_you_mean
from cellc.contract.printing import show, show_document
from cellc.tools.cli.handbook import write_pages
from cellc.tools.cli.words import complete_code


@click.command()
@click.argument("code", required=False, shell_complete=complete_code)
@click.option("--all", "everything", is_flag=True, help="Print the page of every code.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="With --all, write all pages to a folder: an index, and one file for each family.",
)
def explain(code: str | None, everything: bool, output: Path | None) -> None:
    """Explain CODE, or list all codes.

    \b
    cellc explain                              all codes, a line each
    cellc explain frame-cycle
    """
    pages = all_pages()
    if output is not None:
        if not everything:
            raise click.UsageError("--output writes the pages of all codes: give --all too")
        write_pages(output, render_handbook())
        show(f"wrote {output.as_posix()}")
    elif everything:
        show_document("\n".join(render_page(page) for page in pages.values()))
    elif code is None:
        width = max(len(known) for known in pages)
        show(*(f"{known:<{width}}  {page.severity.value:<8} {page.title}" for known, page in pages.items()))
    elif code in pages:
        show_document(render_page(pages[code]))
    else:
        raise click.UsageError(f"there is no code `{code}`: {did_you_mean(code, pages, 'codes')}")
