"""``cellc init``: a new cell from device names."""

from __future__ import annotations

import os
import re
import shlex
from pathlib import Path
from urllib.parse import quote

import click

from cellc.compiler.catalog.compiled import DEVICE_FILE
from cellc.compiler.catalog.load import device_names, load_device, load_device_folder
from cellc.compiler.catalog.starter import NamedDevice, starter_spec
from cellc.compiler.catalog.starter_wires import without_signal
from cellc.contract.diagnostics import did_you_mean
from cellc.contract.file_names import SPEC_FILE
from cellc.contract.printing import show
from cellc.contract.store.swap import write_whole
from cellc.contract.vocabulary import Distro
from cellc.robot.description.packages import folders_elsewhere, lies_under
from cellc.tools.cli.words import complete_named_model
from cellc.tools.report.text_report import render_text

_SIGNALS = "io"
"""The kind of device that has digital outputs."""


@click.command()
@click.argument("name")
@click.argument("devices", nargs=-1, metavar="[DEVICE=]MODEL...", shell_complete=complete_named_model)
@click.option(
    "--ros",
    type=click.Choice([distro.value for distro in Distro]),
    default="jazzy",
    show_default=True,
    help="ROS 2 distribution.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    help="File to write; by default cells/NAME/cell.yaml, or cell.yaml beside a device folder.",
)
@click.option("--force", is_flag=True, help="Replace an existing file.")
def init(name: str, devices: tuple[str, ...], ros: str, output: Path | None, force: bool) -> None:
    """Write a cell NAME with the given devices; without MODEL, list the models.

    A device is named after its kind (arm, gripper, camera) unless DEVICE= names it. MODEL is a model of the catalog or
    a folder that `cellc import` wrote.

    \b
    cellc init bench                           the models
    cellc init bench MODEL MODEL --ros jazzy
    cellc init bench left=MODEL right=MODEL
    cellc init bench arm=./my_robot gripper=MODEL
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]+", name) or "__" in name:
        raise click.UsageError(f"`{name}` is not a package name: use lower case letters, digits and single underscores")
    if not devices:
        raise click.UsageError(f"name at least one model of the catalog: {', '.join(device_names())}")
    folders = [Path(text.rpartition("=")[2]) for text in devices if _is_folder(text.rpartition("=")[2])]
    file = output or (folders[0].parent if folders else Path("cells") / name) / SPEC_FILE
    if file.exists() and not force:
        raise click.UsageError(f"{file.as_posix()} exists; give --force to replace it, or -o for another file")
    entries = _named(devices, file.parent)
    _add_signals(entries)
    schema = quote(Path(os.path.relpath("schemas/cell.schema.json", file.parent)).as_posix())
    named = [
        entry.model.description.package for entry in entries.values() if entry.model.description.package is not None
    ]
    beside = folders_elsewhere(named, file.parent.as_posix())
    write_whole(file, starter_spec(name, Distro(ros), entries, schema, beside))
    show(f"wrote {file.as_posix()}")
    show(f"next: cellc build {shlex.quote(file.as_posix())} && cellc mock generated/{name}")
    if not Path("schemas/cell.schema.json").exists():
        show("for completion in an editor: cellc schema -o schemas")


def _is_folder(model: str) -> bool:
    return "/" in model


def _named(devices: tuple[str, ...], beside: Path) -> dict[str, NamedDevice]:
    """Return the devices by their names, as a spec in a folder names them."""
    entries: dict[str, NamedDevice] = {}
    for text in devices:
        given, _, model = text.rpartition("=")
        device = _of_folder(Path(model), beside) if _is_folder(model) else _of_catalog(model)
        name = given or _free_name(device.model.kind, entries)
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
            raise click.UsageError(f"`{name}` is not a device name: use letters, digits and underscores")
        if name in entries:
            raise click.UsageError(f"two devices have the name `{name}`: name them apart, such as `{name}_2={model}`")
        entries[name] = device
    return entries


def _add_signals(entries: dict[str, NamedDevice]) -> None:
    """Add the I/O devices that the outputs of switched devices need, and tell of each."""
    while unwired := without_signal({name: named.model for name, named in entries.items()}):
        name, model = _free_name(_SIGNALS, entries), _first_of_kind(_SIGNALS)
        entries[name] = _of_catalog(model)
        show(f"added {name}: {model}, for the outputs of {', '.join(unwired)}")


def _first_of_kind(kind: str) -> str:
    """Return the first model of the catalog that is of a kind."""
    loaded = ((name, load_device(name).value) for name in device_names())
    return next(name for name, entry in loaded if entry is not None and entry.model.kind == kind)


def _of_catalog(model: str) -> NamedDevice:
    if model not in device_names():
        known = did_you_mean(model, device_names(), "models of the catalog, or ./FOLDER")
        raise click.UsageError(f"the catalog has no model `{model}`: {known}")
    entry = load_device(model).value
    assert entry is not None  # package data, held valid by the catalog's tests
    return NamedDevice(model, entry)


def _of_folder(folder: Path, beside: Path) -> NamedDevice:
    if not (folder / DEVICE_FILE).is_file():
        raise click.UsageError(f"`{folder}` holds no `{DEVICE_FILE}`: `cellc import` writes such a folder")
    if not lies_under(str(folder), str(beside)):
        raise click.UsageError(f"`{folder}` must lie below the folder of the spec, which is `{beside}`")
    loaded = load_device_folder(folder, beside)
    if loaded.value is None:
        show(*render_text(loaded.diagnostics, {}))
        raise click.exceptions.Exit(1)
    return NamedDevice(f"./{Path(os.path.relpath(folder, beside)).as_posix()}", loaded.value)


def _free_name(kind: str, taken: dict[str, NamedDevice]) -> str:
    if kind not in taken:
        return kind
    return next(f"{kind}_{number}" for number in range(2, len(taken) + 3) if f"{kind}_{number}" not in taken)
