"""``cellc compare``: cells beside each other, before one is chosen or a trajectory goes from one to the other."""

from __future__ import annotations

import click

from cellc.compiler.pipeline import check
from cellc.contract.printing import columns, show, show_document
from cellc.tools.cli.findings import show_findings
from cellc.tools.cli.limit_option import limit_option


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE FILE...", type=click.Path(path_type=str))
@click.option(
    "--format",
    "output_format",
    type=click.Choice(["text", "markdown"]),
    default="text",
    show_default=True,
    help="Output format.",
)
@limit_option
def compare(files: tuple[str, ...], output_format: str) -> None:
    """Compare the cells in FILES: the motion contract of each, and who has which duty.

    The same trajectory meets different contracts on two robots: who starts commands, who has the deadline, which stop
    counts, which versions belong together, and what no mock shows. Findings are those of `cellc check`.

    \b
    cellc compare cells/bench/cell.yaml cells/line/cell.yaml
    cellc compare ros2/cell.yaml sdk/cell.yaml --format markdown > choice.md
    """
    if len(files) < 2:
        raise click.UsageError("expected two cells or more, got one.")
    checked = [check(file) for file in files]
    graphs = [item.graph for item in checked if item.graph is not None]
    if len(graphs) < len(checked):
        show_findings([item.findings for item in checked if item.graph is None], "text")
        raise click.exceptions.Exit(1)
    from cellc.tools.report.comparison import compare as compared
    from cellc.tools.report.comparison_text import comparison_markdown, render_comparison

    names = [graph.cell.name for graph in graphs]
    # Two states of one cell have one name, and their files tell them apart.
    labels = names if len(set(names)) == len(names) else files
    comparison = compared({label: graph.cell for label, graph in zip(labels, graphs, strict=True)})
    if output_format == "markdown":
        show_document(comparison_markdown(comparison))
    else:
        show(*render_comparison(comparison, columns()))
