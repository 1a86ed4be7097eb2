"""``cellc mock``: execute the rehearsals of a generated folder, and nothing but that folder."""

from __future__ import annotations

from functools import partial

import click

from cellc.contract.compute.fan import USUAL, Fan
from cellc.tools.cli.fleet import MATRIX, FleetOptions, fan_options, read_matrix
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.many_folders import named_by, refuse_for_many, tell_table
from cellc.tools.cli.run_options import EDITED, EVIDENCE, FOLDERS, JSON, RECORDS, REHEARSALS, SEED

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


@click.command(cls=_Mock)
@FOLDERS
@REHEARSALS
@RECORDS
@EVIDENCE
@JSON
@SEED
@EDITED
@click.option("--live", is_flag=True, help="Show the rehearsals in Foxglove, in real time.")
@click.option("--listen", metavar="HOST:PORT", help="With --live: where Foxglove connects; 127.0.0.1:8765 by default.")
@click.option("--speed", type=float, metavar="X", help="With --live: X times as fast as real time.")
@MATRIX
@fan_options
@limit_option
def mock(
    folders: tuple[str, ...],
    rehearsals: tuple[str, ...],
    records: str | None,
    evidence: str | None,
    as_json: bool,
    seed: int,
    edited: bool,
    live: bool,
    listen: str | None,
    speed: float | None,
    matrix: tuple[str, ...],
    fan: Fan,
) -> None:
    """Execute the rehearsals of the generated FOLDER; exit 1 where one does not end as it should.

    Several folders, or one of several, give one table. With --matrix cells are named instead, and each is built with
    each tuple for the time of the call.

    \b
    cellc mock generated/bench                 every rehearsal
    cellc mock generated/bench --rehearsal pick --evidence evidence/1
    cellc mock generated/bench --live          in Foxglove
    cellc mock cells --matrix ros=humble,jazzy
    """
    from cellc.mock.command.options import Live, RehearsalOptions

    tuples, named = read_matrix(matrix), named_by(folders, matrix)
    _refuse_view(live, listen, speed, evidence)
    shown = Live(listen or "127.0.0.1:8765", speed or 1.0) if live else None
    options = RehearsalOptions(named.paths[0], seed, edited, as_json, evidence, fan, rehearsals, records, shown)
    if named.table:
        from cellc.mock.command.fleet import rehearse_all

        about_one = {"--rehearsal": bool(rehearsals), "--evidence": evidence is not None}
        refuse_for_many({**about_one, "--records": records is not None, "--live": live})
        fleet = FleetOptions(tuples, fan, as_json)
        tell_table(named.paths, fleet, partial(rehearse_all, options=options), edited=edited)
        return
    if fan != USUAL:
        raise click.UsageError(f"{'--jobs' if fan.cluster is None else '--cluster'} needs several folders.")
    from cellc.mock.command.rehearsals import run_rehearsals

    raise click.exceptions.Exit(run_rehearsals(options))


def _refuse_view(live: bool, listen: str | None, speed: float | None, evidence: str | None) -> None:
    """Raise UsageError where options of a view do not go together."""
    needless = [option for option, value in (("--listen", listen), ("--speed", speed)) if value is not None]
    if needless and not live:
        raise click.UsageError(f"{needless[0]} needs --live.")
    if live and evidence is not None:
        raise click.UsageError("--live does not go with --evidence.")
    if speed is not None and not speed > 0.0:
        raise click.UsageError(f"--speed must be greater than 0, got {speed}.")
