"""``cellc audit``: what the people who approve a cell read, without writing anything."""

from __future__ import annotations

import click

from cellc.compiler.pipeline import check
from cellc.tools.cli.findings import linked
from cellc.tools.cli.limit_option import limit_option


@click.command()
@click.argument("file", type=click.Path(path_type=str))
@limit_option
def audit(file: str) -> None:
    """Print the audit of the cell in FILE, as `cellc build` writes it to audit.md.

    It has the version tuple with the known compatibility of each part, the expected nodes and interfaces, every command
    path, and the blockers as questions to their owner or supplier.

    \b
    cellc audit cells/bench/cell.yaml
    """
    graph = linked(check(file))
    from cellc.compiler.deploy.deployment import plan_deployment
    from cellc.compiler.emit.audit.audit import emit
    from cellc.tools.report.terminal_form import show_markdown

    for artifact in emit(graph, plan_deployment(graph)):
        show_markdown(artifact.text)
