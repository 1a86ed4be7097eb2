"""``cellc import``: a device folder from a robot as its vendor ships it."""

from __future__ import annotations

import shlex
import time
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.cli.findings import show_findings
from cellc.cli.limit_option import limit_option
from cellc.diagnostics import Severity
from cellc.diagnostics.diagnostic import Findings
from cellc.printing import show
from cellc.store.swap import write_whole
from cellc.vocabulary import Distro

if TYPE_CHECKING:
    from cellc.importing.cell_text import FirstCell
    from cellc.importing.chain import Chain
    from cellc.importing.device_text import Pairs
    from cellc.importing.folder import Written
    from cellc.importing.source import Robot


@click.command(name="import")
@click.argument("robot")
@click.argument("arguments", nargs=-1, metavar="[NAME:=VALUE]...")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="Device folder; ./MODEL if absent.",
)
@click.option(
    "--srdf",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="SRDF whose pairs of links may touch; the robot's own beside its description if absent.",
)
@click.option(
    "--controllers",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="Parameters of controllers for the cell; those beside the description if absent.",
)
@click.option("--cell", "with_cell", is_flag=True, help="Write a cell.yaml beside the folder too, which moves it.")
@click.option("--check", "only_check", is_flag=True, help="Tell which files of the imported folder ROBOT changed.")
@click.option(
    "--ros", type=click.Choice([distro.value for distro in Distro]), default="jazzy", help="Distribution of the cell."
)
@limit_option
def import_(
    robot: str,
    arguments: tuple[str, ...],
    output: Path | None,
    srdf: Path | None,
    controllers: Path | None,
    with_cell: bool,
    only_check: bool,
    ros: str,
) -> None:
    """Make a device folder of ROBOT: a URDF or xacro file, the folder of a ROS package, or an installed Python package.

    NAME:=VALUE are arguments of the xacro. What a person wrote into a device.yaml stays.

    \b
    cellc import my_robot.urdf -o devices/my_robot --cell
    cellc import my_robot_description robot:=large
    """
    if only_check:
        _tell_changes(Path(robot))
        return
    begun = time.monotonic()
    found, chain = _read(robot, dict(map(_argument, arguments)))
    from cellc.importing.beside import controllers_near, read_controllers, semantic_file
    from cellc.importing.cell_text import FirstCell
    from cellc.importing.device_text import DESCRIPTION, model_name
    from cellc.importing.folder import write_folder
    from cellc.importing.source import packages_elsewhere

    folder = output or Path(model_name(found))
    if (folder / DESCRIPTION).exists() and (folder / DESCRIPTION).samefile(found.file):
        raise click.UsageError(
            f"`{found.file.as_posix()}` would be replaced by what is made of it: name another folder"
        )
    semantic = srdf or semantic_file(found.file, found.description.name)
    joints = [joint.name for joint in chain.joints]
    moved = controllers_near(found.file, joints) if controllers is None else read_controllers(controllers, joints)
    if moved is None:
        raise click.UsageError(f"`{controllers}` has no controller of {', '.join(joints)}.")
    written = write_folder(folder, found, chain, _disabled(semantic, found), date.today().isoformat())
    took = f"{time.monotonic() - begun:.1f} s"
    show(f"wrote {folder.as_posix()}: {written.files} files, {written.size / 1e6:.1f} MB, in {took}")
    show(*(f"read {file.as_posix()}" for file in (semantic, moved.file) if file is not None))
    _tell_kept(folder, written)
    if with_cell:
        beside = packages_elsewhere(found, folder)
        _write_cell(folder, FirstCell(chain, written.away, moved, ros, beside))
    errors = tuple(one for one in written.checked.diagnostics if one.severity is Severity.ERROR)
    if errors:
        show_findings((replace(written.checked.findings, diagnostics=errors),), "text")
        raise click.exceptions.Exit(1)
    show(f"open questions stand at the head of {folder.as_posix()}/device.yaml")


def _tell_kept(folder: Path, written: Written) -> None:
    if written.kept:
        changed = (
            f"kept, with what the vendor changed: {', '.join(written.changed)}" if written.changed else "as it was"
        )
        show(f"{folder.as_posix()}/device.yaml is {changed}")


def _argument(text: str) -> tuple[str, str]:
    name, separator, value = text.partition(":=")
    if not separator or not name:
        raise click.UsageError(f"an argument of the xacro must be NAME:=VALUE, got `{text}`")
    return name, value


def _read(named: str, arguments: dict[str, str]) -> tuple[Robot, Chain]:
    """Return the robot that is meant, and its main chain; what is wrong with it is told and ends the command."""
    from cellc.importing.chain import chain_of
    from cellc.importing.source import ImportRefusedError, read_robot, the_description

    try:
        file = the_description(named)
        read = read_robot(file, arguments)
        if read.value is not None:
            return read.value, chain_of(read.value.description)
    except ImportRefusedError as refusal:
        show(f"refused: {refusal}")
        raise click.exceptions.Exit(1) from None
    show_findings((Findings(file.as_posix(), {}, read.diagnostics),), "text")
    raise click.exceptions.Exit(1)


def _disabled(srdf: Path | None, robot: Robot) -> Pairs:
    from cellc.importing.device_text import disabled_by_srdf

    links = {link.name for link in robot.description.links}
    return {} if srdf is None else disabled_by_srdf(srdf.read_text(encoding="utf-8"), links, srdf.as_posix())


def _tell_changes(folder: Path) -> None:
    from cellc.importing.folder import LOCK, changed_files

    if not (folder / LOCK).is_file():
        raise click.UsageError(f"`{folder.as_posix()}` holds no {LOCK}: name a folder that `cellc import` wrote")
    changed = tuple(changed_files(folder))
    show(*(f"changed: {name}" for name in changed))
    if changed:
        raise click.exceptions.Exit(1)
    show(f"{folder.as_posix()} is as it was imported")


def _write_cell(folder: Path, first: FirstCell) -> None:
    """Write the spec beside the folder, unless a person has one there."""
    from cellc.importing.cell_text import cell_text

    file, name = folder.parent / "cell.yaml", f"{folder.name}_cell"
    if file.exists():
        show(f"kept {file.as_posix()} as it was")
    else:
        write_whole(file, cell_text(name, f"./{folder.name}", first))
        show(f"wrote {file.as_posix()}")
    show(f"next: cellc build {shlex.quote(file.as_posix())} && cellc mock generated/{name}")
