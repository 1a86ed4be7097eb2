"""``cellc mock``: execute the rehearsals of a generated folder, and nothing but that folder."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import click

from cellc.contract.compute.fan import USUAL
from cellc.mock.command.options import RehearsalOptions
from cellc.tools.cli.fleet import MATRIX, FleetOptions, fan_options, named_by, read_matrix, refuse_for_many
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.run_options import (
    AGAINST,
    EDITED,
    EVIDENCE,
    FILM,
    FOLDERS,
    IMAGES,
    JSON,
    PHYSICS,
    RECORDS,
    REHEARSALS,
    SEED,
    STAGE,
    live_options,
    options_as,
    ros_options,
)

_NOW = {
    "--gates": "cellc gates FOLDER",
    "--replay": "cellc replay FOLDER RUN",
    "--sweep": "cellc sweep FOLDER --runs N",
    "--journal": "cellc sweep FOLDER --journal FILE",
    "--list": "cellc campaign FOLDER --list",
    "--pairs": "cellc campaign FOLDER --pairs N",
    "--campaign": "cellc campaign FOLDER",
}
"""Options that were commands of their own, those first that decide where several are given: what to type now."""


class _Mock(click.Command):
    """A command that names the one that an option of former versions has become."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        given = [word.partition("=")[0] for word in args]
        try:
            return super().parse_args(ctx, args)
        except click.NoSuchOption:
            for option, now in _NOW.items():
                if option in given:
                    raise click.ClickException(f"`cellc mock` has no {option} any more: use `{now}`") from None
            raise


def _refuse_mixed(options: RehearsalOptions) -> None:
    if options.against and not options.physics:
        raise click.UsageError("--against needs --physics.")
    if options.against and (options.evidence or options.records or options.live or options.among):
        raise click.UsageError("--against cannot be combined with --evidence, --records, --live or --ros.")
    if options.film and (options.against or options.evidence or options.live or options.among):
        raise click.UsageError("--film cannot be combined with --against, --evidence, --live or --ros.")


@click.command(cls=_Mock)
@FOLDERS
@REHEARSALS
@RECORDS
@EVIDENCE
@IMAGES
@PHYSICS
@AGAINST
@FILM
@JSON
@SEED
@STAGE
@EDITED
@live_options
@ros_options
@MATRIX
@fan_options
@limit_option
@options_as(RehearsalOptions)
def mock(options: RehearsalOptions, folders: tuple[str, ...], matrix: tuple[str, ...]) -> None:
    """Run the rehearsals of the generated FOLDER on the mock; exit 1 if one does not end as expected.

    Several folders, or a folder of folders, give one table. With --matrix name cells instead; each is built with each
    version tuple for this call.

    \b
    cellc mock generated/bench                 every rehearsal
    cellc mock generated/bench --rehearsal pick --evidence evidence/1
    cellc mock generated/bench --live          in Foxglove
    cellc mock cells --matrix ros=humble,jazzy
    """
    fleet, named = FleetOptions(read_matrix(matrix), options.fan, options.as_json), named_by(folders, matrix)
    if named.table:
        refuse_for_many(options)
        from cellc.mock.command.fleet import rehearse_all
        from cellc.tools.cli.rows import tell_executed

        tell_executed(named.paths, fleet, partial(rehearse_all, options=options), edited=options.edited)
        return
    if options.fan != USUAL:
        raise click.UsageError(f"{'--jobs' if options.fan.cluster is None else '--cluster'} needs several folders.")
    _refuse_mixed(options)
    from cellc.mock.command.rehearsals import run_rehearsals

    raise click.exceptions.Exit(run_rehearsals(replace(options, folder=named.paths[0])))
