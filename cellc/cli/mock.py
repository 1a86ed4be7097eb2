"""``cellc mock``: execute the rehearsals of a generated folder, and nothing but that folder."""

from __future__ import annotations

import click


@click.command()
@click.argument("folder", type=click.Path(path_type=str))
@click.option(
    "--rehearsal", "names", multiple=True, metavar="NAME", help="Run only this one; may be given several times."
)
@click.option("--json", "as_json", is_flag=True, help="Write the results as JSON.")
@click.option("--records", type=click.Path(path_type=str, dir_okay=False), help="Write attempt records as JSON lines.")
@click.option("--seed", default=0, show_default=True, help="Seed of planning and of seeded faults.")
def mock(folder: str, names: tuple[str, ...], as_json: bool, records: str | None, seed: int) -> None:
    """Execute the rehearsals of the generated FOLDER; exit 1 where one does not end as it should."""
    # Planning libraries load only for this command.
    from cellc.mock.command import run_command

    raise click.exceptions.Exit(run_command(folder, names=names, as_json=as_json, records=records, seed=seed))
