"""``cellc view``: one HTML page of a cell, to be opened from the file system."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.errors import reason_of
from cellc.contract.limits import limits, option
from cellc.contract.printing import refuse, show
from cellc.contract.signals import within
from cellc.contract.store.regular_file import open_regular
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.words import complete_rehearsal

if TYPE_CHECKING:
    from cellc.tools.view.content import Content

_HEADS = (b"<!doctype html", b"<html")
_OWN = (
    b'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><meta http-equiv="content-security-policy" '
    b"content=\"default-src 'none'"
)
"""How a page of this command begins."""
_HEAD_BYTES = 200


@click.command()
@click.argument("folder", metavar="[CELL]", required=False, type=click.Path(path_type=str))
@click.option(
    "-o", "--output", type=click.Path(path_type=Path, dir_okay=False), help="Page to write; NAME.html by default."
)
@click.option(
    "--rehearsal",
    "names",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_rehearsal,
    help="Play back only this rehearsal; repeatable.",
)
@click.option(
    "--bag",
    "bags",
    multiple=True,
    metavar="BAG",
    type=click.Path(path_type=Path),
    help="Play back this bag of an attempt; repeat it for the parts of a split one.",
)
@click.option(
    "--task",
    metavar="NAME",
    shell_complete=complete_rehearsal,
    help="With --bag, the rehearsal whose steps the task made; the one the bag is named after by default.",
)
@click.option(
    "--against",
    metavar="OTHER",
    shell_complete=complete_rehearsal,
    help="Also draw the poses of this spec, folder or Git revision; with --bag, this rehearsal or bag as a ghost, "
    "the one of --task by default.",
)
@click.option("--seed", default=0, show_default=True, help="Seed of planning and faults.")
@limit_option
def view(
    folder: str | None,
    output: Path | None,
    names: tuple[str, ...],
    bags: tuple[Path, ...],
    task: str | None,
    against: str | None,
    seed: int,
) -> None:
    """Write one HTML page of CELL, a spec or a generated folder: 3D view, played-back rehearsals, findings, gates.

    The page is self-contained: it opens from a file without network or server, also on a phone, and prints. For a spec
    with errors it draws the parts that link and lists the rest. A URDF or xacro file is drawn as a robot alone.

    With --bag, the page plays back an attempt that was recorded, with a rehearsal as a translucent ghost beside it, and
    lists where they part. CELL is `generated/NAME` by default where the bag names its cell.

    \b
    cellc view cells/bench/cell.yaml                       writes bench.html
    cellc view generated/bench --rehearsal pick -o pick.html
    cellc view cells/bench/cell.yaml --against main        what a change moves
    cellc view generated/bench --bag bags/1 --task pick    writes bench.bag.html
    """
    _refuse_mixed(folder, names, bags, task)
    content, place = _judged(partial(_drawn, folder, output, names, bags, task, against, seed), folder, output)
    _write(content, place, folder, against)


def _refuse_mixed(folder: str | None, names: tuple[str, ...], bags: tuple[Path, ...], task: str | None) -> None:
    if folder is None and not bags:
        raise click.UsageError("Missing argument 'CELL'.")
    if task is not None and not bags:
        raise click.UsageError("--task needs --bag.")
    if names and bags:
        raise click.UsageError("--rehearsal takes no --bag beside it; name the rehearsal of a bag with --task.")


def _judged(draw: Callable[[], tuple[Content, Path]], folder: str | None, output: Path | None) -> tuple[Content, Path]:
    """Return what is drawn; what cannot be ends with a line and 2."""
    from cellc.mock.errors import MockError
    from cellc.tools.attempt.bag import BagError
    from cellc.tools.review.sides import SideError
    from cellc.tools.view.subject import ViewError

    try:
        if output is not None and not output.absolute().parent.is_dir():
            raise ViewError(f"{output.as_posix()}: cannot be written: no such folder")
        if output is not None:
            _hold_replaceable(output)
        drawn = within(limits().command_seconds, draw)
        if drawn is None:
            most = f"must take at most {limits().command_seconds} s of processor time; {option('command-seconds')}"
            raise ViewError(f"{folder or 'the bag'}: {most}")
    except (BagError, ViewError, MockError, SideError) as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None
    return drawn


def _write(content: Content, place: Path, folder: str | None, against: str | None) -> None:
    """Write the page, and say what it does not have."""
    # Drawing loads the compiler, and playing back the planning.
    from cellc.contract.store.swap import replace_whole
    from cellc.tools.report.text_report import summed_errors
    from cellc.tools.view.page import three_js, to_html

    subject, library = content.subject, three_js()
    page = to_html(content, library).encode()
    try:
        replace_whole(place, page)
    except OSError as error:
        refuse(f"{place.as_posix()}: cannot be written: {reason_of(error)}")
        raise click.exceptions.Exit(2) from None
    show(f"wrote {place.as_posix()}, {len(page) / 1e6:.1f} MB")
    if content.attempt is not None and content.attempt.no_ghost:
        show(f"no ghost: {content.attempt.no_ghost}")
    if against is not None and subject.folder is None:
        show(f"not compared with {against}: there is no package of {folder}")
    if library is None:
        show("without 3D: the installed trimesh ships no three.js that cellc knows")
    if subject.findings is not None and not subject.findings.ok:
        show(*summed_errors(subject.findings.diagnostics, subject.findings.file))
        raise click.exceptions.Exit(1)


def _drawn(
    folder: str | None,
    output: Path | None,
    names: tuple[str, ...],
    bags: tuple[Path, ...],
    task: str | None,
    against: str | None,
    seed: int,
) -> tuple[Content, Path]:
    """Return what the page shows, and where it goes."""
    from cellc.tools.view.content import attempt_content, before_of, content_of
    from cellc.tools.view.subject import read_subject

    named = _package_of(bags) if folder is None else folder
    subject = read_subject(Path(named))
    place = output or Path(f"{Path(subject.page_name).stem}.bag.html" if bags else subject.page_name)
    if output is None:  # the cell chose the name, which may be that of somebody's page
        _hold_replaceable(place, (_OWN,), "a page of this command")
    if bags:
        return attempt_content(subject, bags, task, against, seed), place
    content = content_of(subject, names, seed)
    if against is not None and subject.folder is not None:
        content = replace(content, before=before_of(against, named))
    return content, place


def _package_of(bags: tuple[Path, ...]) -> str:
    """Return the generated folder of the cell that bags name."""
    from cellc.tools.attempt.bag import BagError
    from cellc.tools.attempt.read import cell_of

    cell = cell_of(bags)
    if cell is None:
        raise BagError(f"{bags[0].as_posix()}: does not name its cell; name the generated folder as CELL")
    return os.path.join("generated", cell)


def _hold_replaceable(place: Path, heads: tuple[bytes, ...] = _HEADS, what: str = "an HTML page") -> None:
    """Refuse to put a page in the place of anything but a page, such as the spec itself.

    Raises:
        ViewError: something else is there.
    """
    from cellc.tools.view.subject import ViewError

    try:
        with open_regular(place) as stream:
            head = stream.read(_HEAD_BYTES).lstrip().lower()
    except FileNotFoundError:
        return
    except OSError as error:
        raise ViewError(f"{place.as_posix()}: cannot be written: {reason_of(error)}") from None
    if head and not head.startswith(heads):
        raise ViewError(f"{place.as_posix()}: is not {what}; move it away, or name another file")
