"""What is viewed: a spec with its findings, or a generated folder; either way the package that the mock reads."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from cellc.compiler.catalog.load import device_names, load_device
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import FieldOfView
from cellc.compiler.link.device_facts import field_of_view
from cellc.compiler.output.write import write
from cellc.contract.contract import Contract
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.errors import CellcError
from cellc.contract.file_names import SPEC_FILE
from cellc.contract.store.swap import temporary_folder
from cellc.mock.cell import read_to_show
from cellc.mock.errors import MockError
from cellc.mock.folder import CONTRACT_FILE, GeneratedFolder, read_folder, read_text
from cellc.robot.description.packages import root_of
from cellc.tools.view.standing import Standing, Wanted, of_cell, of_package, wanted_of

PICTURES = ("graph/cell.svg", "graph/nodes.svg", "graph/responsibility.svg")
"""Files of a package that the page shows as pictures."""
_FILE_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,99}", re.ASCII)
_CELL_NAME = re.compile(r"^cell[ ]*:[ ]+[\"']?([A-Za-z][A-Za-z0-9_]{0,99})[\"']?[ ]*(?:#.*)?$", re.ASCII | re.MULTILINE)


class ViewError(CellcError):
    """There is nothing to show; the text is one line, lower case."""


@dataclass(frozen=True, slots=True)
class Subject:
    """What the page is of.

    Attributes:
        findings: what the check says, with the text of the spec; None for a generated folder.
        folder: the package; None where an error keeps it from being made.
        standing: what is in the cell; None where too little of the spec can be linked.
        wanted: what the cell names and a reader looks for in the drawing.
        views: what cameras see, by optical frame.
        pictures: text of the package's pictures, by file.
        stem: what a file of the page is called; the name where that is empty.
    """

    name: str
    findings: Findings | None
    folder: GeneratedFolder | None
    standing: Standing | None = None
    wanted: Wanted = field(default_factory=dict)
    views: Mapping[str, FieldOfView] = field(default_factory=dict)
    pictures: Mapping[str, str] = field(default_factory=dict)
    stem: str = ""

    @property
    def page_name(self) -> str:
        """Name of a file for the page."""
        return f"{self.stem or self.name}.html"


_NO_CELL = ("not-a-cell", "unsupported-in-plant")
"""Findings of a file that is something else than a cell: there is nothing to draw."""


def read_subject(path: Path) -> Subject:
    """Read a generated folder, or check and compile a spec, also the `cell.yaml` of a folder.

    Raises:
        ViewError: `cellc build` did not write the folder, or it has changes that edits do not explain.
    """
    spec = path / SPEC_FILE
    if not path.exists():
        raise ViewError(f"{path.as_posix()}: there is no such file or folder")
    try:
        if path.is_dir() and (not spec.is_file() or (path / CONTRACT_FILE).exists()):
            return _of_folder(path)
        return _of_spec(spec if path.is_dir() else path)
    except MockError as problem:
        raise ViewError(str(problem)) from None


def _of_folder(path: Path) -> Subject:
    folder = read_to_show(path, edited=True)
    views = dict(_views_by_model(folder.contract))
    return _of_package(folder.contract.cell, None, folder, views, _pictures(path, folder))


def _of_package(
    name: str,
    findings: Findings | None,
    folder: GeneratedFolder,
    views: Mapping[str, FieldOfView],
    pictures: Mapping[str, str],
) -> Subject:
    standing = of_package(folder)
    return Subject(name, findings, folder, standing, wanted_of(standing), views, pictures)


def _of_spec(path: Path) -> Subject:
    # A folder is shown without the compiler, which takes a second to load.
    from cellc.compiler.feasibility.meshes import mesh_roots
    from cellc.compiler.pipeline import DESCRIPTIONS, check, emit_cell, judge

    if path.suffix in DESCRIPTIONS:
        return _of_description(path, judge(path).findings)
    checked = check(path)
    other = next((found for found in checked.diagnostics if found.code in _NO_CELL), None)
    if other is not None:
        raise ViewError(f"{path.as_posix()}: {other.message}; {other.help}" if other.help else other.message)
    emitted = emit_cell(checked)
    findings = checked.findings.with_more(emitted.diagnostics)
    if emitted.value is None or checked.graph is None:
        return _of_errors(path, findings, None if checked.graph is None else checked.graph.cell)
    cell = checked.graph.cell
    with temporary_folder("cellc-view-") as place:
        package = place / cell.name
        write(emitted.value, package)
        folder = replace(read_folder(package), mesh_roots=mesh_roots(cell))
        pictures = _pictures(package, folder)
    return _of_package(cell.name, findings, folder, dict(_views(cell)), pictures)


def _of_description(path: Path, findings: Findings) -> Subject:
    """Return a robot alone, which is in the world."""
    from cellc.compiler.link.link import bare_cell
    from cellc.robot.description.read_description import read_description

    root = root_of(path)
    read = read_description(path, {}, root)
    cell = None if read.value is None else bare_cell(read.value, path.as_posix(), root.as_posix())
    named = None if cell is None else _FILE_NAME.fullmatch(cell.name)
    return _linked(path, findings, cell, {}, path.stem if named is None else named[0])


def _of_errors(path: Path, findings: Findings, linked: Cell | None) -> Subject:
    from cellc.tools.view.partial import cell_as_far

    cell, wanted = cell_as_far(path)
    return _linked(path, findings, linked or cell, wanted, _stem(path, findings.texts.get(path.as_posix(), "")))


def _stem(path: Path, text: str) -> str:
    """Return the name of the cell that a spec with errors states; where none is legible, that of its file or folder."""
    named = _CELL_NAME.search(text)
    if named is not None:
        return named[1]
    return path.absolute().parent.name if path.name == SPEC_FILE else path.stem


def _linked(path: Path, findings: Findings, cell: Cell | None, wanted: Wanted, stem: str) -> Subject:
    if cell is None:
        return Subject(path.as_posix(), findings, None, None, wanted, stem=stem)
    return Subject(cell.name, findings, None, of_cell(cell), wanted, dict(_views(cell)), stem=stem)


def _pictures(path: Path, folder: GeneratedFolder) -> dict[str, str]:
    return {name: read_text(path, name) for name in PICTURES if name in folder.listed}


def _views(cell: Cell) -> Iterator[tuple[str, FieldOfView]]:
    for device in cell.devices:
        for stream in () if device.sensing.camera is None else device.sensing.camera.streams:
            if stream.view is not None:
                yield stream.frame, stream.view


def _views_by_model(contract: Contract) -> Iterator[tuple[str, FieldOfView]]:
    """Yield what cameras of the catalog see: a package does not hold it."""
    for device in contract.devices.values():
        known = load_device(device.model).value if device.camera and device.model in device_names() else None
        facts = None if known is None else known.model.camera
        for stream in () if facts is None else facts.streams.values():
            view = field_of_view(stream.view)
            if view is not None:
                yield f"{device.prefix}{stream.frame}", view
