"""Cells of the repository, emitted for any distribution."""

from __future__ import annotations

import re
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

from cellc.compiler.deploy.deployment import plan_deployment
from cellc.compiler.emit.emit_all import emit_all
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.contract import Contract
from tests.cells import graph_of, spec_text, written

CELLS = ("ur5e_pick", "minimal")


def emitted_graph(graph: CellGraph) -> dict[str, str]:
    """Return the text of every artifact of a graph by path."""
    artifacts = emit_all(graph, plan_deployment(graph))
    assert len({artifact.path for artifact in artifacts}) == len(artifacts)
    return {artifact.path: artifact.text for artifact in artifacts}


def emitted(folder: Path, text: str) -> dict[str, str]:
    """Return the text of every artifact of a spec by path."""
    return emitted_graph(graph_of(written(folder, text)))


def unbroken(page: str) -> str:
    """Return a page with every command on one line, as a shell reads it."""
    return re.sub(r" \\\n +", " ", page)


@cache
def emitted_once(text: str) -> dict[str, str]:
    """Return the text of every artifact of a spec that several tests read; nobody changes them."""
    with tempfile.TemporaryDirectory() as folder:
        return emitted(Path(folder), text)


def artifacts_of(cell: str, distro: str = "jazzy") -> dict[str, str]:
    """Return the artifacts of a cell of the repository, for any distribution."""
    return emitted_once(spec_text(cell).replace("ros: jazzy", f"ros: {distro}"))


def contract_data(text: str) -> Any:
    """Return a contract as plain data, with what is left out of the file at the default that the schema states."""
    return Contract.model_validate_json(text).model_dump(mode="json")
