"""``cellc replay``: one run of a campaign or of a sweep again, bit for bit."""

from __future__ import annotations

import click

from cellc.mock.command.options import ReplayOptions
from cellc.mock.sweep.names import SWEPT
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.run_options import (
    EDITED,
    EVIDENCE,
    FOLDER,
    JSON,
    PHYSICS,
    RECORDS,
    SEED,
    options_as,
    ros_options,
)
from cellc.tools.cli.words import complete_rehearsal, complete_run


@click.command()
@FOLDER
@click.argument("runs", nargs=-1, required=True, metavar="RUN...", shell_complete=complete_run)
@click.option("--rehearsal", metavar="NAME", shell_complete=complete_rehearsal, help="Rehearsal of a sweep run.")
@click.option(
    "--journal", type=click.Path(path_type=str, dir_okay=False), help="Journal of the sweep; any other is refused."
)
@RECORDS
@EVIDENCE
@PHYSICS
@JSON
@SEED
@EDITED
@ros_options
@limit_option
@options_as(ReplayOptions)
def replay(options: ReplayOptions) -> None:
    """Repeat each RUN of the generated FOLDER: a run of its campaign, or `sweep:NUMBER`; exit 1 if one fails.

    `cellc campaign --list` prints the runs of a campaign. A failed run is printed with its replay command.

    \b
    cellc replay generated/bench 'pick/stick:arm_elbow_joint@3'
    cellc replay generated/bench sweep:17 --evidence evidence/17
    """
    swept = [run.startswith(SWEPT) for run in options.runs]
    if any(swept) and not all(swept):
        raise click.UsageError("runs of a sweep cannot be combined with runs of the campaign.")
    of_sweep = {"--rehearsal": options.rehearsal, "--journal": options.journal}
    needless = next((option for option, given in of_sweep.items() if given is not None and not swept[0]), "")
    if needless:
        raise click.UsageError(f"{needless} needs a run of a sweep, `{SWEPT}NUMBER`.")
    if options.records is not None and swept[0]:
        raise click.UsageError("--records cannot be combined with a run of a sweep.")
    if swept[0] and options.among is not None:
        raise click.UsageError("--ros cannot be combined with a run of a sweep.")
    if swept[0]:
        from cellc.mock.command.sweep import replay_swept

        raise click.exceptions.Exit(replay_swept(options))
    from cellc.mock.command.campaign import replay_runs

    raise click.exceptions.Exit(replay_runs(options))
