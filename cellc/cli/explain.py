"""``cellc explain``: what a diagnostic code means, why it matters, and how to mend it."""

from __future__ import annotations

import click

from cellc.diagnostics import did_you_mean
from cellc.report.pages import all_pages, render_page


@click.command()
@click.argument("code", required=False)
@click.option("--all", "everything", is_flag=True, help="Print the page of every code.")
def explain(code: str | None, everything: bool) -> None:
    """Explain CODE, or list all codes."""
    pages = all_pages()
    if everything:
        click.echo("\n".join(render_page(page) for page in pages.values()), nl=False)
    elif code is None:
        width = max(len(known) for known in pages)
        for known, page in pages.items():
            click.echo(f"{known:<{width}}  {page.severity.value:<8} {page.title}")
    elif code in pages:
        click.echo(render_page(pages[code]), nl=False)
    else:
        raise click.UsageError(f"there is no code `{code}`: {did_you_mean(code, pages, 'codes')}")
