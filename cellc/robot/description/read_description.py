"""The one door from a description file, URDF or xacro, to a Description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path

from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span
from cellc.contract.limits import Budget, Limits, limits
from cellc.contract.printing import stage
from cellc.robot.description.model import Description
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.xacro_expansion import Expansion, expand_here, expand_xacro
from cellc.robot.description.xacro_files import ConfinedFiles, XacroRefusedError

_KEPT = 32  # descriptions of the devices of a few cells


def read_description(
    file: Path, arguments: Mapping[str, str], root: Path, budget: Budget | None = None, beside: Sequence[str] = ()
) -> Outcome[Description]:
    """Read a description that the user brought: ``.xacro`` is expanded in a child process, all else is URDF.

    Args:
        file: the description, as the user named it.
        arguments: values of ``<xacro:arg>``; a plain URDF takes none.
        root: the folder that the description and all it includes must lie under.
        budget: what expansions of the spec may still take; as much as one may where it is absent.
        beside: further folders of packages that the spec names.
    """
    stage(f"reading {file.as_posix()}")
    if file.suffix == ".xacro":
        return _read_expanded(file, expand_xacro(file, arguments, root, budget=budget, beside=beside))
    if arguments:
        message, start = f"`{file.name}` is URDF and takes no arguments", Span(file.as_posix(), 1, 1, 1, 1)
        problem = Diagnostic("xacro-unknown-argument", Severity.ERROR, message, start, help="remove `arguments:`")
        return Outcome(None, (problem,))
    text = text_under(file, root)
    return Outcome(None, text.diagnostics) if text.value is None else _read(text.value, file.as_posix(), limits())


def text_under(file: Path, root: Path) -> Outcome[str]:
    """Return the text of a URDF or SRDF that must lie under a folder."""
    try:
        return Outcome(ConfinedFiles(root.as_posix()).read(file.as_posix()))
    except XacroRefusedError as refusal:
        start = Span(file.as_posix(), 1, 1, 1, 1)
        return Outcome(
            None, (Diagnostic(refusal.code, Severity.ERROR, refusal.message, start, help=refusal.help_text),)
        )


@lru_cache(maxsize=_KEPT)
def _read(text: str, file: str, _bounds: Limits) -> Outcome[Description]:
    """Read a user's URDF; cells of one folder name the same devices, and an editor asks at every change."""
    return read_urdf(text, file, from_user=True)


def read_catalog_description(
    file: Path, arguments: Mapping[str, str], root: Path, shown_root: str
) -> Outcome[Description]:
    """Read a description that ships with the catalog, in this process."""
    return _read_expanded(file, expand_here(file.as_posix(), arguments, root.as_posix(), shown_root))


def _read_expanded(file: Path, expanded: Outcome[Expansion]) -> Outcome[Description]:
    if expanded.value is None:
        return Outcome(None, expanded.diagnostics)
    read = read_urdf(expanded.value.text, file.as_posix(), expanded.value.origins, from_user=True)
    return Outcome(read.value, expanded.diagnostics + read.diagnostics)
