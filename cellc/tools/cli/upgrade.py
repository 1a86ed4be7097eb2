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
    help="The distribution to go to; an older one too.",
)
@click.option("--write", is_flag=True, help="Write the new pins into the spec; nothing else of it changes.")
@FORM
@limit_option
def upgrade(spec: str, target: str, write: bool, output_format: str) -> None:
    """Tell what another distribution of ROS 2 would change in the cell of SPEC; exit 1 where anything would.

    Pins with their sources, parameters that appear, vanish or change their default, names at the ROS graph, the
    package as `cellc diff` tells it, and gates to pass again. What no matrix knows becomes UNKNOWN, with a question.

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
