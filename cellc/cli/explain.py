"""``cellc explain``: what a diagnostic code means, why it matters, and how to mend it."""

from __future__ import annotations

from pathlib import Path

import click

from cellc.diagnostics import did_you_mean
from cellc.report.pages import all_pages, render_handbook, render_page
from cellc.store.swap import write_whole


@click.command()
@click.argument("code", required=False)
@click.option("--all", "everything", is_flag=True, help="Print the page of every code.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="With --all, write all pages to a folder: an index, and one file for each family.",
)
def explain(code: str | None, everything: bool, output: Path | None) -> None:
    """Explain CODE, or list all codes."""
    pages = all_pages()
    if output is not None:
        if not everything:
            raise click.UsageError("--output writes the pages of all codes: give --all too")
        for name, text in render_handbook().items():
            write_whole(output / name, text)
        click.echo(f"wrote {output.as_posix()}")
    elif everything:
        click.echo("\n".join(render_page(page) for page in pages.values()), nl=False)
    elif code is None:
        width = max(len(known) for known in pages)
        for known, page in pages.items():
            click.echo(f"{known:<{width}}  {page.severity.value:<8} {page.title}")
    elif code in pages:
        click.echo(render_page(pages[code]), nl=False)
    else:
        raise click.UsageError(f"there is no code `{code}`: {did_you_mean(code, pages, 'codes')}")
