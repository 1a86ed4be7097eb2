"""``cellc sweep``: how often rehearsals of a generated folder succeed, where not everything is known exactly."""

from __future__ import annotations

from functools import partial

import click

from cellc.contract.compute.fan import Fan
from cellc.tools.cli.fleet import MATRIX, FleetOptions, fan_options, read_matrix
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.many_folders import named_by, refuse_for_many, tell_table
from cellc.tools.cli.run_options import EDITED, EVIDENCE, FOLDERS, JOURNAL, JSON, REHEARSALS, SEED


@click.command()
@FOLDERS
@click.option("--runs", default=1000, show_default=True, metavar="N", help="Runs of each rehearsal, at most.")
@REHEARSALS
@JOURNAL
@EVIDENCE
@JSON
@SEED
@EDITED
@MATRIX
@fan_options
@limit_option
def sweep(
    folders: tuple[str, ...],
    runs: int,
    rehearsals: tuple[str, ...],
    journal: str | None,
    evidence: str | None,
    as_json: bool,
    seed: int,
    edited: bool,
    matrix: tuple[str, ...],
    fan: Fan,
) -> None:
    """Draw what is uncertain in the generated FOLDER, and print how often its rehearsals succeed.

    Rehearsals are those with an expected rate, or the first. It ends as soon as the verdict is certain; exit 1 where a
    rate does not hold, or N runs do not decide it. Several folders, or one of several, give one table. With --matrix
    cells are named instead, and each is built with each tuple for the time of the call.

    \b
    cellc sweep generated/bench --runs 10000 --journal sweep.jsonl
    cellc sweep generated/bench --rehearsal pick
    cellc sweep cells --matrix ros=humble,jazzy
    """
    from cellc.mock.command.options import SweepOptions

    tuples, named = read_matrix(matrix), named_by(folders, matrix)
    options = SweepOptions(named.paths[0], seed, edited, as_json, evidence, fan, runs, rehearsals, journal)
    if not named.table:
        from cellc.mock.command.sweep import run_sweep

        raise click.exceptions.Exit(run_sweep(options))
    from cellc.mock.command.fleet import sweep_all

    about_one = {"--rehearsal": bool(rehearsals), "--journal": journal is not None, "--evidence": evidence is not None}
    refuse_for_many(about_one)
    fleet = FleetOptions(tuples, fan, as_json)
    tell_table(named.paths, fleet, partial(sweep_all, options=options), edited=edited)
