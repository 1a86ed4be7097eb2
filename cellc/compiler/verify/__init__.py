"""Reads our artifacts back with parsers that we did not write: once for the same bytes, the answer rests on no more."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.files import SCENE
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.verify.disagreement import Disagreement
from cellc.compiler.verify.meant import meant_by
from cellc.compiler.verify.scene import is_read
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.extras import PHYSICS
from cellc.contract.store.cache import Program, recall

_PARSERS = Program(
    code=("compiler/verify", "contract"),
    libraries=(
        *("pin", "yourdfpy", "trimesh", "numpy", "lxml", "PyYAML", "jsonschema", "referencing", "pydantic"),
        "mujoco",
    ),
)


def unread() -> str:
    """Return which file is not read back, because its parser is not installed, as the end of a sentence."""
    return "" if is_read() else f"; {SCENE} is not read: the extra `{PHYSICS.name}` is not installed"


def verify(artifacts: Sequence[Artifact], graph: CellGraph) -> tuple[Diagnostic, ...]:
    """Return a diagnostic for each difference between the cell and what foreign parsers read from its artifacts.

    Each finding is a bug of cellc, located at the name of the cell. A clean result is cached, because loading and
    running the parsers takes as long as the rest of a build. Findings are computed again.
    """
    meant = meant_by(graph)

    def ask() -> tuple[Disagreement, ...]:
        from cellc.compiler.verify.read_back import read_back

        return tuple(read_back(artifacts, meant))

    place, question = graph.cell.locate("cell"), repr((tuple(artifacts), meant))
    kind = tuple[Disagreement, ...]
    disagreements = recall("verify", question, kind, ask, lambda found: not found, Path(place.file), _PARSERS)
    return tuple(sorted((disagreement.at(place) for disagreement in disagreements), key=Diagnostic.sort_key))
