"""``cellc campaign``: every fault at every step of the rehearsals of a generated folder."""

from __future__ import annotations

import click

from cellc.mock.command.options import CampaignOptions
from cellc.tools.cli.fleet import fan_options
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.run_options import (
    EDITED,
    EVIDENCE,
    FOLDER,
    JSON,
    PAIRS,
    PHYSICS,
    RECORDS,
    SEED,
    options_as,
    ros_options,
)


@click.command()
@FOLDER
@PAIRS
@click.option("--list", "list_only", is_flag=True, help="Print the names of the runs and stop.")
@RECORDS
@EVIDENCE
@PHYSICS
@JSON
@SEED
@EDITED
@ros_options
@fan_options
@limit_option
@options_as(CampaignOptions)
def campaign(options: CampaignOptions, list_only: bool) -> None:
    """Inject every fault at every step of the rehearsals in the generated FOLDER, and print the matrix.

    A run fails if its outcome is not allowed for the fault, if it comes after its bound, or if a joint exceeds a limit.
    Exit 1 if a run fails. `cellc replay` repeats one run.

    \b
    cellc campaign generated/bench                 fault by step, over all cores
    cellc campaign generated/bench --pairs 500     and 500 runs with two faults
    cellc campaign generated/bench --list          names of the runs
    cellc campaign generated/bench --physics       with masses, drives and contacts
    cellc campaign generated/bench --evidence evidence/1
    cellc campaign generated/bench --ros --without perception --lockstep --launch COMMAND --jobs 2
    """
    from cellc.mock.command.campaign import list_runs, run_campaign

    kept = {"--evidence": options.evidence, "--records": options.records}
    written = next((option for option, path in kept.items() if path is not None), "")
    if options.among is not None and options.fan.cluster is not None:
        raise click.UsageError("--ros cannot be combined with --cluster: the nodes are started on this computer.")
    if list_only and written:
        raise click.UsageError(f"{written} cannot be combined with --list.")
    raise click.exceptions.Exit(list_runs(options) if list_only else run_campaign(options))
