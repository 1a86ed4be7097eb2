"""``cellc gates``: what the mock can say of the gates of a generated folder."""

from __future__ import annotations

import click

from cellc.mock.command.options import GatesOptions
from cellc.tools.cli.fleet import fan_options
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.run_options import EDITED, EVIDENCE, FOLDER, JOURNAL, JSON, PAIRS, RECORDS, SEED, options_as


@click.command()
@FOLDER
@click.option("--sweep", "runs", type=int, metavar="N", help="Also check success rates, with up to N runs of a sweep.")
@JOURNAL
@PAIRS
@RECORDS
@EVIDENCE
@JSON
@SEED
@EDITED
@fan_options
@limit_option
@options_as(GatesOptions)
def gates(options: GatesOptions) -> None:
    """Run the rehearsals and the campaign of the generated FOLDER, and check gates L6, G1 and G2 line by line.

    Lines that only a robot or a person can show stay UNKNOWN. Exit 1 if a line fails.

    \b
    cellc gates generated/bench
    cellc gates generated/bench --sweep 10000 --journal sweep.jsonl
    cellc gates generated/bench --evidence evidence/1
    """
    from cellc.mock.command.sweep import run_gates

    if options.journal is not None and options.runs is None:
        raise click.UsageError("--journal needs --sweep.")
    raise click.exceptions.Exit(run_gates(options))
