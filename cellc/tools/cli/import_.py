"""``cellc import``: a device folder from a robot as its vendor ships it."""

from __future__ import annotations

import shlex
import time
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.compiler.catalog.device_model import device_kinds
from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.file_names import SPEC_FILE
from cellc.contract.printing import show, stage
from cellc.contract.store.swap import write_whole
from cellc.contract.vocabulary import Distro
from cellc.tools.cli.findings import show_findings
from cellc.tools.cli.limit_option import limit_option

if TYPE_CHECKING:
    from cellc.tools.importing.cell_text import FirstCell
    from cellc.tools.importing.device_text import Pairs
    from cellc.tools.importing.folder import Written
    from cellc.tools.importing.role import Role
    from cellc.tools.importing.source import Robot


@click.command(name="import")
@click.argument("robot")
@click.argument("arguments", nargs=-1, metavar="[NAME:=VALUE]...")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="Device folder; ./MODEL by default.",
)
@click.option(
    "--srdf",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="SRDF with the disabled collision pairs; by default the one beside the description.",
)
@click.option(
    "--controllers",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="Controller parameters for the cell; by default those beside the description.",
)
@click.option(
    "--kind", type=click.Choice(device_kinds()), help="Kind of device; derived from the description by default."
)
@click.option(
    "--cell", "with_cell", is_flag=True, help="Also write a cell.yaml beside the folder that moves the robot."
)
@click.option(
    "--check", "only_check", is_flag=True, help="List the files of the imported folder that ROBOT would change."
)
@click.option(
    "--ros", type=click.Choice([distro.value for distro in Distro]), default="jazzy", help="Distribution of the cell."
)
@click.option("--force", is_flag=True, help="Discard edits of files from an earlier import.")
@limit_option
def import_(
    robot: str,
    arguments: tuple[str, ...],
    output: Path | None,
    srdf: Path | None,
    controllers: Path | None,
    kind: str | None,
    with_cell: bool,
    only_check: bool,
    ros: str,
    force: bool,
) -> None:
    """Create a device folder from ROBOT: a URDF or xacro file, a ROS package folder, or an installed Python package.

    NAME:=VALUE are xacro arguments. Your own entries in an existing device.yaml are kept.

    \b
    cellc import my_robot.urdf -o devices/my_robot --cell
    cellc import my_robot_description robot:=large
    """
    if only_check:
        _tell_changes(Path(robot))
        return
    start = time.monotonic()
    stage("reading the robot")
    robot_read, role = _read(robot, dict(map(_argument, arguments)), kind, output)
    from cellc.tools.importing.beside import controllers_near, read_controllers, semantic_file
    from cellc.tools.importing.cell_text import FirstCell
    from cellc.tools.importing.device_text import DESCRIPTION, model_name
    from cellc.tools.importing.folder import write_folder
    from cellc.tools.importing.source import packages_elsewhere

    folder = output or Path(model_name(robot_read))
    if (folder / DESCRIPTION).exists() and (folder / DESCRIPTION).samefile(robot_read.file):
        raise click.UsageError(f"`{robot_read.file.as_posix()}` would be replaced by the output; name another folder")
    semantic = srdf or semantic_file(robot_read.file, robot_read.description.name)
    joints = [joint.name for joint in role.chain.joints]
    moved = controllers_near(robot_read.file, joints) if controllers is None else read_controllers(controllers, joints)
    if moved is None:
        raise click.UsageError(f"`{controllers}` has no controller of {', '.join(joints)}.")
    stage("copying meshes")
    disabled = _disabled(semantic, robot_read)
    outcome = write_folder(folder, robot_read, role, disabled, date.today().isoformat(), force=force)
    if outcome.value is None:
        show_findings((Findings(folder.as_posix(), {}, outcome.diagnostics),), "text")
        raise click.exceptions.Exit(1)
    import_report = outcome.value
    took = f"{time.monotonic() - start:.1f} s"
    show(f"wrote {folder.as_posix()}: {import_report.files} files, {import_report.size / 1e6:.1f} MB, in {took}")
    show(*(f"read {file.as_posix()}" for file in (semantic, moved.file) if file is not None))
    show(*role.lines())
    _tell_kept(folder, import_report)
    _stop_at_errors(import_report.checked)
    show(f"open questions are at the top of {folder.as_posix()}/device.yaml")
    if with_cell:
        beside = packages_elsewhere(robot_read, folder)
        _write_cell(folder, FirstCell(role, import_report.away, moved, ros, beside))


def _stop_at_errors(found: Findings) -> None:
    """Show what is wrong with a cell, and end the command where something is."""
    errors = tuple(diagnostic for diagnostic in found.diagnostics if diagnostic.severity is Severity.ERROR)
    if errors:
        show_findings((replace(found, diagnostics=errors),), "text")
        raise click.exceptions.Exit(1)


def _tell_kept(folder: Path, written: Written) -> None:
    from cellc.tools.importing.folder import LOCK

    if written.kept:
        changed = f"kept, with changes of the vendor: {', '.join(written.changed)}" if written.changed else "unchanged"
        show(f"{folder.as_posix()}/device.yaml is {changed}")
    if written.lost:
        show(
            f"{folder.as_posix()}/{LOCK} was damaged: device.yaml lacks later changes of the vendor; "
            "compare it by hand, or remove device.yaml and import again"
        )


def _argument(text: str) -> tuple[str, str]:
    name, separator, value = text.partition(":=")
    if not separator or not name:
        raise click.UsageError(f"an argument of the xacro must be NAME:=VALUE, got `{text}`")
    return name, value


def _read(named: str, arguments: dict[str, str], kind: str | None, output: Path | None) -> tuple[Robot, Role]:
    """Return the named robot and its part in a cell; an error in it is reported and ends the command."""
    from cellc.tools.importing.device_text import model_name
    from cellc.tools.importing.folder import kept_kind
    from cellc.tools.importing.role import role_of
    from cellc.tools.importing.source import ImportRefusedError, read_robot, the_description

    try:
        file = the_description(named)
        read = read_robot(file, arguments)
        if read.value is not None:
            stated = kind or kept_kind(output or Path(model_name(read.value)))
            return read.value, role_of(read.value.description, stated)
    except ImportRefusedError as refusal:
        show(f"refused: {refusal}")
        raise click.exceptions.Exit(1) from None
    show_findings((Findings(file.as_posix(), {}, read.diagnostics),), "text")
    raise click.exceptions.Exit(1)


def _disabled(srdf: Path | None, robot: Robot) -> Pairs:
    from cellc.tools.importing.device_text import disabled_by_srdf

    if srdf is None:
        return {}
    read = disabled_by_srdf(srdf, {link.name for link in robot.description.links})
    if read.value is None:
        show_findings((Findings(srdf.as_posix(), {}, read.diagnostics),), "text")
        raise click.exceptions.Exit(1)
    return read.value


def _tell_changes(folder: Path) -> None:
    from cellc.tools.importing.folder import LOCK, changed_files

    changed = changed_files(folder)
    if changed is None:
        raise click.UsageError(f"`{folder.as_posix()}` holds no {LOCK}: name a folder that `cellc import` wrote")
    show(*(f"changed: {name}" for name in changed))
    if changed:
        raise click.exceptions.Exit(1)
    show(f"{folder.as_posix()} is unchanged since its import")


def _write_cell(folder: Path, first: FirstCell) -> None:
    """Write the spec beside the folder, unless a person has one there, and check what is there then."""
    from cellc.compiler.pipeline import check
    from cellc.tools.importing.cell_text import cell_text

    file, name = folder.parent / SPEC_FILE, f"{folder.name}_cell"
    if file.exists() or file.is_symlink():  # one that leads nowhere is kept too
        show(f"kept {file.as_posix()} unchanged")
    else:
        write_whole(file, cell_text(name, f"./{folder.name}", first))
        show(f"wrote {file.as_posix()}")
    _stop_at_errors(check(file).findings)
    show(f"next: cellc build {shlex.quote(file.as_posix())} && cellc mock generated/{name}")
