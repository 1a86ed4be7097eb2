"""``cellc diff``: what changed from one state of a cell to another, and what that means."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from cellc.contract.printing import refuse
from cellc.tools.cli.forms import FORM, tell
from cellc.tools.cli.limit_option import limit_option

if TYPE_CHECKING:
    from cellc.contract.review import Review, ReviewRehearsal
    from cellc.tools.review.sides import Package, Side


@click.command()
@click.argument("sides", nargs=-1, required=True, metavar="[BEFORE] AFTER", type=click.Path(path_type=str))
@FORM
@click.option("--breaking", is_flag=True, help="Fail only if a consumer outside the cell breaks.")
@click.option(
    "--rehearse", is_flag=True, help="Run the rehearsals of both sides on the mock and compare their outcomes."
)
@click.option("--all", "whole", is_flag=True, help="Print every value, finding and gate, not a screenful.")
@limit_option
def diff(sides: tuple[str, ...], output_format: str, breaking: bool, rehearse: bool, whole: bool) -> None:
    """Show what changed in a cell, between specs, generated folders or their Git revisions; exit 1 if anything did.

    With one path, compare HEAD with the work tree, as `git diff` does.

    \b
    cellc diff cells/x/cell.yaml                 HEAD and the work tree
    cellc diff main cells/x/cell.yaml            a revision and the work tree
    cellc diff main..HEAD cells/x/cell.yaml      two revisions
    cellc diff a/cell.yaml generated/a           a spec and a generated folder
    """
    if len(sides) > 2:
        raise click.UsageError(f"expected one or two of spec, folder and revision, got {len(sides)}.")
    # Comparing loads the compiler.
    from cellc.tools.review.markdown import render_markdown
    from cellc.tools.review.review import review
    from cellc.tools.review.short import render_short
    from cellc.tools.review.sides import PlantSideError, SideError, packages
    from cellc.tools.review.sides import sides as asked
    from cellc.tools.review.text import render_review

    try:
        wanted = asked(sides)
        try:
            with packages(*wanted) as ((before, _), (after, _)):
                result = review(before, after, _outcomes(before, after) if rehearse else ())
        except PlantSideError:
            result = _of_plants(*wanted, rehearse=rehearse)
    except SideError as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None
    tell(result, output_format, render_markdown, render_review if whole else render_short)
    counted = [change for change in result.changes if change.breaking or not breaking]
    if counted or (result.rehearsals_differ() and not breaking):
        raise click.exceptions.Exit(1)


def _of_plants(before: Side, after: Side, *, rehearse: bool) -> Review:
    from cellc.tools.review.plants import plant_review

    if rehearse:
        raise click.UsageError("--rehearse: not supported in a plant yet; name the spec of one of its cells.")
    return plant_review(before, after)


def _outcomes(before: Package, after: Package) -> tuple[ReviewRehearsal, ...]:
    from cellc.tools.review.rehearse import outcomes_of

    return outcomes_of(before, after)
