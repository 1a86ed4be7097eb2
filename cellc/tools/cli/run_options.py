"""The options that commands of the mock share."""

from __future__ import annotations

import click

from cellc.tools.cli.words import complete_rehearsal


def _refuse_empty(_context: click.Context, parameter: click.Parameter, path: str | None) -> str | None:
    if path == "":
        raise click.UsageError(f"{parameter.opts[0]} cannot be written: its path is empty.")
    return path


FOLDER = click.argument("folder", type=click.Path(path_type=str))
FOLDERS = click.argument("folders", nargs=-1, required=True, metavar="FOLDER...", type=click.Path(path_type=str))
REHEARSALS = click.option(
    "--rehearsal",
    "rehearsals",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_rehearsal,
    help="This one only; repeatable.",
)
PAIRS = click.option("--pairs", default=0, metavar="N", help="N runs more, with two faults each.")
JOURNAL = click.option(
    "--journal", type=click.Path(path_type=str, dir_okay=False), help="Keep each run here, and go on from it."
)
JSON = click.option("--json", "as_json", is_flag=True, help="Write the results as JSON.")
RECORDS = click.option(
    "--records",
    type=click.Path(path_type=str, dir_okay=False),
    callback=_refuse_empty,
    help="Write attempt records as JSON lines.",
)
EVIDENCE = click.option(
    "--evidence",
    type=click.Path(path_type=str, file_okay=False),
    callback=_refuse_empty,
    help="Write bags, records, key figures and a report.",
)
SEED = click.option("--seed", default=0, show_default=True, help="Seed of everything that is drawn.")
EDITED = click.option(
    "--edited", is_flag=True, help="Run a folder that was edited; every result says so, no gate is signed."
)
