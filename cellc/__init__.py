"""cellc: a declarative compiler for robot cells.

What a program calls is here: ``check`` a spec, ``build`` its ROS 2 package, ``load_mock`` to execute that package; with
the types that these return and raise. docs/python.md shows each of them.

    import cellc

    for found in cellc.check("cells/bench/cell.yaml"):
        print(found)
    report = cellc.build("cells/bench/cell.yaml", "generated")
    if report.value is not None:
        result = cellc.load_mock("generated/bench").run("pick_and_place")
        print(result.outcome)

Importing the package loads no stage; each name loads what it needs.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from cellc.version import __version__

if TYPE_CHECKING:
    from cellc.compiler.output.write import WriteReport
    from cellc.compiler.pipeline import Checked
    from cellc.contract.diagnostics import Diagnostic, Outcome, Related, Severity, Span
    from cellc.contract.errors import CellcError
    from cellc.mock import AttemptRecord, MockCell, MockError, RehearsalResult

__all__ = [
    "AttemptRecord",
    "CellcError",
    "Checked",
    "Diagnostic",
    "MockCell",
    "MockError",
    "Outcome",
    "RehearsalResult",
    "Related",
    "Severity",
    "Span",
    "WriteReport",
    "__version__",
    "build",
    "check",
    "load_mock",
]

_HOMES = {
    "AttemptRecord": "cellc.mock",
    "CellcError": "cellc.contract.errors",
    "Checked": "cellc.compiler.pipeline",
    "Diagnostic": "cellc.contract.diagnostics",
    "MockCell": "cellc.mock",
    "MockError": "cellc.mock",
    "Outcome": "cellc.contract.diagnostics",
    "RehearsalResult": "cellc.mock",
    "Related": "cellc.contract.diagnostics",
    "Severity": "cellc.contract.diagnostics",
    "Span": "cellc.contract.diagnostics",
    "WriteReport": "cellc.compiler.output.write",
}

if not TYPE_CHECKING:  # a checker of types knows the names above, and no others

    def __getattr__(name: str) -> object:
        """Load a type where it is first asked for: its stage may be heavy."""
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        return getattr(import_module(_HOMES[name]), name)

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})


def check(spec: str | Path) -> Checked:
    """Read, link and check a cell; nothing is written.

    Args:
        spec: the YAML file of a cell or a plant; or a `device.yaml`, URDF or xacro file, which is judged by itself.

    Returns:
        Its diagnostics, and the linked cell where nothing hides it. A file that cannot be read is a diagnostic too.
    """
    from cellc.compiler.pipeline import judge

    return judge(spec)


def build(spec: str | Path, output: str | Path = "generated", *, force: bool = False) -> Outcome[WriteReport]:
    """Check a cell and write its ROS 2 package to a folder of the cell's name in ``output``.

    Args:
        spec: the YAML file of a cell or a plant.
        output: folder that holds a folder for each cell.
        force: discard edits that were made by hand in generated files.

    Returns:
        What was written, and the diagnostics of all stages. There is no value where an error stopped the build.
    """
    from cellc.compiler.output.write import write
    from cellc.compiler.pipeline import check_buildable, compile_cell
    from cellc.contract.diagnostics import Outcome

    checked = check_buildable(spec)
    compiled = compile_cell(checked)
    findings = (*checked.diagnostics, *compiled.diagnostics)
    if checked.presence is None or compiled.value is None or not compiled.ok:
        return Outcome(None, findings)
    report = write(compiled.value, Path(output) / checked.presence.name, force=force)
    return Outcome(report.value, (*findings, *report.diagnostics))


def load_mock(folder: str | Path, *, edited: bool = False, stage: str = "") -> MockCell:
    """Load a generated folder, whose rehearsals ``run(name)`` executes.

    Args:
        edited: take a folder that differs from its manifest; every result says so, and no gate is signed.
        stage: the stage of commissioning that motion is planned in, such as ``10``; the last where it is empty.

    Raises:
        MockError: the folder cannot be executed; the message names the file and the reason.
    """
    from cellc.mock import load

    return load(Path(folder), edited=edited, stage=stage)
