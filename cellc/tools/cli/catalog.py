"""``cellc catalog``: which devices there are, and what is known of each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click

from cellc.compiler.catalog.device_model import device_kinds
from cellc.compiler.catalog.load import device_names, load_device
from cellc.contract.printing import columns, refuse, show, stage
from cellc.contract.vocabulary import Distro
from cellc.tools.browse.search import Answer, Wanted, answered, answers, kilograms, meters
from cellc.tools.cli.handbook import write_pages
from cellc.tools.cli.words import complete_model

_OF_A_FILE = 1000
"""Columns of what another program reads: a line for each device."""


class _Figure(click.ParamType[float]):
    """A quantity with its unit, as in a spec; its value is in SI."""

    def __init__(self, name: str, read: Callable[[str], float]) -> None:
        self.name = name
        self._read = read

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> float:
        try:
            return self._read(value)
        except ValueError as problem:
            self.fail(str(problem), param, ctx)


@click.command()
@click.argument("words", nargs=-1, metavar="[MODEL | WORD...]", shell_complete=complete_model)
@click.option("--kind", type=click.Choice(device_kinds()), help="Devices of one kind.")
@click.option("--reach", type=_Figure("LENGTH", meters), help="Arms with at least this reach, such as `900 mm`.")
@click.option("--payload", type=_Figure("MASS", kilograms), help="Arms with at least this payload, such as `5 kg`.")
@click.option(
    "--ros", type=click.Choice([distro.value for distro in Distro]), help="Devices with a driver for this distribution."
)
@click.option("--all", "everything", is_flag=True, help="With --output, write the pages of all devices.")
@click.option("-o", "--output", type=click.Path(path_type=Path, file_okay=False), help="Folder of the pages.")
def catalog(
    words: tuple[str, ...],
    kind: str | None,
    reach: float | None,
    payload: float | None,
    ros: str | None,
    everything: bool,
    output: Path | None,
) -> None:
    """List the devices of the catalog; show MODEL, or the devices with each WORD in model, vendor, driver or summary.

    \b
    cellc catalog                                  every device
    cellc catalog MODEL                            all that is known of one
    cellc catalog --kind arm --reach "900 mm" --payload "5 kg" --ros jazzy
    """
    if (output is not None) != everything:
        raise click.UsageError("--all and --output must be given together; they write the pages of every device.")
    # Pages load what draws.
    from cellc.tools.browse.page import page, pages
    from cellc.tools.report.terminal_form import show_markdown

    if output is not None:
        stage("drawing the pages")
        write_pages(output, pages())
        show(f"wrote {output.as_posix()}")
        return
    entry = load_device(words[0]).value if len(words) == 1 and words[0] in device_names() else None
    if entry is not None:
        show_markdown(page(entry))
        return
    wanted = Wanted(words=words, kind=kind, reach_m=reach, payload_kg=payload, distro=ros)
    given = answers(wanted)
    show(*answered(given, wanted, columns(_OF_A_FILE)))
    if not given[Answer.YES]:
        refuse("no device of the catalog meets all of these; relax one, or add your own device with `cellc import`")
        raise click.exceptions.Exit(1)
