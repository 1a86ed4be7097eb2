"""``cellc sweep``: how often rehearsals of a generated folder succeed, where not everything is known exactly."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import click

from cellc.mock.command.options import SweepOptions
from cellc.tools.cli.fleet import MATRIX, FleetOptions, fan_options, named_by, read_matrix, refuse_for_many
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.run_options import (
    EDITED,
    EVIDENCE,
    FOLDERS,
    JOURNAL,
    JSON,
    PHYSICS,
    REHEARSALS,
    SEED,
    options_as,
)


@click.command()
@FOLDERS
@click.option("--runs", default=1000, show_default=True, metavar="N", help="Maximum number of runs of each rehearsal.")
@REHEARSALS
@JOURNAL
@EVIDENCE
@PHYSICS
@JSON
@SEED
@EDITED
@MATRIX
@fan_options
@limit_option
@options_as(SweepOptions)
def sweep(options: SweepOptions, folders: tuple[str, ...], matrix: tuple[str, ...]) -> None:
    """Draw the uncertain quantities of the generated FOLDER at random, and print how often its rehearsals succeed.

    Sweeps the rehearsals with an expected success rate, or the first one. Stops as soon as the verdict is certain. Exit
    1 if a rate does not hold, or if N runs do not decide it. Several folders, or a folder of folders, give one table.
    With --matrix name cells instead; each is built with each version tuple for this call.

    \b
    cellc sweep generated/bench --runs 10000 --journal sweep.jsonl
    cellc sweep generated/bench --rehearsal pick
    cellc sweep generated/bench --physics      masses, friction and payloads are drawn too
    cellc sweep cells --matrix ros=humble,jazzy
    """
    fleet, named = FleetOptions(read_matrix(matrix), options.fan, options.as_json), named_by(folders, matrix)
    if not named.table:
        from cellc.mock.command.sweep import run_sweep

        raise click.exceptions.Exit(run_sweep(replace(options, folder=named.paths[0])))
    refuse_for_many(options)
    from cellc.mock.command.fleet import sweep_all
    from cellc.tools.cli.rows import tell_executed

    tell_executed(named.paths, fleet, partial(sweep_all, options=options), edited=options.edited)
