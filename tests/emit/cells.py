"""Cells of the repository, compiled for the tests of the emitters."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from cellc.emit.emit_all import emit_all
from cellc.graph.cell_graph import CellGraph, build_graph
from cellc.link.link import link
from cellc.source import read
from cellc.spec.parse import parse

ROOT = Path(__file__).resolve().parents[2]
CELLS = ("ur5e_pick", "minimal")
DISTROS = ("humble", "jazzy", "kilted", "lyrical")


def spec_text(cell: str) -> str:
    """Return the spec of a cell of the repository."""
    return (ROOT / "cells" / cell / "cell.yaml").read_text(encoding="utf-8")


def graph_of(folder: Path, text: str) -> CellGraph:
    """Link a spec written into a folder."""
    file = folder / "cell.yaml"
    file.write_text(text, encoding="utf-8")
    document = read(file).value
    assert document is not None
    spec = parse(document)
    assert spec.value is not None, spec.diagnostics
    cell = link(spec.value, document)
    assert cell.value is not None, cell.diagnostics
    return build_graph(cell.value)


def emitted(folder: Path, text: str) -> dict[str, str]:
    """Return the text of every artifact of a spec by path."""
    artifacts = emit_all(graph_of(folder, text))
    assert len({artifact.path for artifact in artifacts}) == len(artifacts)
    return {artifact.path: artifact.text for artifact in artifacts}


@lru_cache(maxsize=16)
def artifacts_of(cell: str, distro: str = "jazzy") -> dict[str, str]:
    """Return the artifacts of a cell of the repository, for any distribution."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return emitted(Path(folder), spec_text(cell).replace("ros: jazzy", f"ros: {distro}"))
