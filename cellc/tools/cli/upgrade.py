"""``cellc upgrade``: what another distribution of ROS 2 would change in a cell."""

from __future__ import annotations

import click

from cellc.contract.printing import Stream, refuse, show
from cellc.contract.vocabulary import Distro
from cellc.tools.cli.forms import FORM, tell
from cellc.tools.cli.limit_option import limit_option


@click.command()
@click.argument("spec", type=click.Path(path_type=str))
@click.option(
    "--ros",
    "target",
    required=True,
    type=click.Choice([distro.value for distro in Distro]),
    help="Target distribution; may be an older one.",
)
@click.option("--write", is_flag=True, help="Write the new pins into the spec and change nothing else.")
@FORM
@limit_option
def upgrade(spec: str, target: str, write: bool, output_format: str) -> None:
    """Show what another ROS 2 distribution would change in the cell of SPEC; exit 1 if anything would change.

    Lists pins with their sources, parameters that are added, removed or change their default, names in the ROS graph,
    changes of the package as in `cellc diff`, and gates to repeat. A part that no matrix lists becomes UNKNOWN, with a
    question.

    \b
    cellc upgrade cells/bench/cell.yaml --ros kilted
    cellc upgrade cells/bench/cell.yaml --ros kilted --write
    cellc upgrade cells/bench/cell.yaml --ros humble --format markdown
    """
    # Comparing loads the compiler.
    from cellc.tools.review.moved_spec import UpgradeError
    from cellc.tools.review.sides import SideError
    from cellc.tools.review.upgrade import plan_upgrade
    from cellc.tools.review.upgrade_text import render_upgrade, upgrade_markdown

    try:
        planned = plan_upgrade(spec, Distro(target))
        for edit in planned.write() if write else ():
            show(f"{edit.file}:{edit.line}: {edit.message}", to=Stream.ERR)
    except (SideError, UpgradeError) as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None
    plan = planned.upgrade
    tell(plan, output_format, upgrade_markdown, render_upgrade)
    if plan.asks():
        raise click.exceptions.Exit(1)
