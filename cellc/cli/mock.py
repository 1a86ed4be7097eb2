"""``cellc mock``: execute the rehearsals of a generated folder, and nothing but that folder."""

from __future__ import annotations

import click


@click.command()
@click.argument("folder", type=click.Path(path_type=str))
@click.option(
    "--rehearsal", "names", multiple=True, metavar="NAME", help="Run only this one; may be given several times."
)
@click.option("--campaign", is_flag=True, help="Run every fault at every step, and print the matrix.")
@click.option("--pairs", default=0, metavar="N", help="With --campaign: N runs more, with two faults each.")
@click.option("--jobs", type=int, metavar="N", help="With --campaign: processes; as many as cores by default.")
@click.option("--list", "list_only", is_flag=True, help="Print the runs of the campaign, and run none.")
@click.option(
    "--replay", "replayed", multiple=True, metavar="RUN", help="Run one run of the campaign alone; repeatable."
)
@click.option("--gates", is_flag=True, help="Run rehearsals and campaign, and judge gates L6, G1, G2 by them.")
@click.option("--json", "as_json", is_flag=True, help="Write the results as JSON.")
@click.option("--records", type=click.Path(path_type=str, dir_okay=False), help="Write attempt records as JSON lines.")
@click.option(
    "--evidence", type=click.Path(path_type=str, file_okay=False), help="Write bags, records, key figures and a report."
)
@click.option("--seed", default=0, show_default=True, help="Seed of planning, of seeded faults and of pairs.")
def mock(
    folder: str,
    names: tuple[str, ...],
    campaign: bool,
    pairs: int,
    jobs: int | None,
    list_only: bool,
    replayed: tuple[str, ...],
    gates: bool,
    as_json: bool,
    records: str | None,
    evidence: str | None,
    seed: int,
) -> None:
    """Execute the rehearsals of the generated FOLDER; exit 1 where one does not end as it should."""
    # Planning libraries load only for this command.
    from cellc.mock.command.campaign import CampaignOptions, list_runs, replay_runs, run_campaign
    from cellc.mock.command.gates import run_gates
    from cellc.mock.command.options import contradiction
    from cellc.mock.command.rehearsals import run_command

    problem = contradiction(
        rehearsals=bool(names),
        modes={"--campaign": campaign, "--list": list_only, "--replay": bool(replayed), "--gates": gates},
        pairs=pairs != 0,
        jobs=jobs is not None,
        paths={"--evidence": evidence, "--records": records},
    )
    if problem:
        raise click.UsageError(f"{problem}.")
    options = CampaignOptions(seed=seed, jobs=jobs, pairs=pairs, as_json=as_json, records=records, evidence=evidence)
    if list_only:
        code = list_runs(folder, options)
    elif replayed:
        code = replay_runs(folder, replayed, options)
    elif gates:
        code = run_gates(folder, options)
    elif campaign:
        code = run_campaign(folder, options)
    else:
        code = run_command(folder, names=names, as_json=as_json, records=records, evidence=evidence, seed=seed)
    raise click.exceptions.Exit(code)
