"""``cellc mock``: execute the rehearsals of a generated folder, and nothing but that folder."""

from __future__ import annotations

import os

import click

from cellc.tools.cli.fleet import CLUSTER, MATRIX, Fan, FleetOptions, read_matrix
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.words import complete_rehearsal, complete_run


@click.command()
@click.argument("folders", nargs=-1, required=True, metavar="FOLDER...", type=click.Path(path_type=str))
@MATRIX
@click.option(
    "--rehearsal",
    "names",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_rehearsal,
    help="Run only this one; may be given several times.",
)
@click.option("--campaign", is_flag=True, help="Run every fault at every step, and print the matrix.")
@click.option("--pairs", default=0, metavar="N", help="With --campaign: N runs more, with two faults each.")
@click.option("--sweep", default=0, metavar="N", help="Draw what is uncertain in up to N runs: how many succeed?")
@click.option(
    "--journal",
    type=click.Path(path_type=str, dir_okay=False),
    help="With --sweep: keep each run in this file, and go on from it. With --replay: the sweep that a run is of.",
)
@click.option("--jobs", type=int, metavar="N", help="Processes of campaign and sweep; as many as cores by default.")
@CLUSTER
@click.option("--list", "list_only", is_flag=True, help="Print the runs of the campaign, and run none.")
@click.option(
    "--replay",
    "replayed",
    multiple=True,
    metavar="RUN",
    shell_complete=complete_run,
    help="One run alone, of the campaign or `sweep:NUMBER`; repeatable.",
)
@click.option("--gates", is_flag=True, help="Run rehearsals and campaign, and judge gates L6, G1, G2 by them.")
@click.option("--json", "as_json", is_flag=True, help="Write the results as JSON.")
@click.option("--records", type=click.Path(path_type=str, dir_okay=False), help="Write attempt records as JSON lines.")
@click.option(
    "--evidence", type=click.Path(path_type=str, file_okay=False), help="Write bags, records, key figures and a report."
)
@click.option("--seed", default=0, show_default=True, help="Seed of planning, of seeded faults and of pairs.")
@click.option("--edited", is_flag=True, help="Run a folder that was edited; every result says so, no gate is signed.")
@click.option("--live", is_flag=True, help="Show the rehearsals in Foxglove, in real time.")
@click.option("--listen", metavar="HOST:PORT", help="With --live: where Foxglove connects; 127.0.0.1:8765 by default.")
@click.option("--speed", type=float, metavar="X", help="With --live: X times as fast as real time.")
@limit_option
def mock(
    folders: tuple[str, ...],
    matrix: tuple[str, ...],
    names: tuple[str, ...],
    campaign: bool,
    pairs: int,
    sweep: int,
    journal: str | None,
    jobs: int | None,
    cluster: str | None,
    list_only: bool,
    replayed: tuple[str, ...],
    gates: bool,
    as_json: bool,
    records: str | None,
    evidence: str | None,
    seed: int,
    edited: bool,
    live: bool,
    listen: str | None,
    speed: float | None,
) -> None:
    """Execute the rehearsals of the generated FOLDER; exit 1 where one does not end as it should.

    Several folders, or one of several, give one table of rehearsals and sweeps. With --matrix cells are named instead,
    and each is built with each tuple for the time of the call.

    \b
    cellc mock generated/bench                 every rehearsal
    cellc mock generated/bench --rehearsal pick --evidence evidence/1
    cellc mock generated/bench --campaign      every fault at every step
    cellc mock generated/bench --live          in Foxglove
    cellc mock cells --matrix ros=humble,jazzy --sweep 200
    """
    from cellc.mock.command.options import MockOptions, run_mock

    tuples, (folder, several) = read_matrix(matrix), _meant(folders)
    options = MockOptions(
        folder=folder,
        rehearsals=names,
        campaign=campaign,
        list_only=list_only,
        replay=replayed,
        gates=gates,
        pairs=pairs,
        sweep=sweep,
        journal=journal,
        jobs=jobs,
        cluster=cluster,
        as_json=as_json,
        records=records,
        evidence=evidence,
        seed=seed,
        edited=edited,
        live=live,
        listen=listen,
        speed=speed,
        many=bool(matrix) or several is not None,
    )
    problem = options.contradiction()
    if problem:
        raise click.UsageError(f"{problem}.")
    if not options.many:
        raise click.exceptions.Exit(run_mock(options))
    from cellc.tools.cli.mock_fleet import rehearse_cells, rehearse_folders

    fleet = FleetOptions(tuples, Fan(jobs, cluster), as_json)
    if matrix:
        rehearse_cells(folders, fleet, options)
    else:
        rehearse_folders(several or (), fleet, options)


def _meant(folders: tuple[str, ...]) -> tuple[str, tuple[str, ...] | None]:
    """Return the first folder that is meant, and all of them where a table is; a pattern means what it matches."""
    if len(folders) == 1 and os.path.exists(os.path.join(folders[0], "contract.json")):
        return folders[0], None  # what looks for others loads for longer than a folder is read
    from cellc.tools.cli.batch import matched, several_folders

    return next(matched(folders)), several_folders(folders)
