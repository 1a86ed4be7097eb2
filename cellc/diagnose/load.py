"""Reads the knowledge that ships with cellc."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from cellc.catalog.read_model import read_model
from cellc.diagnose.knowledge_model import LAYERS, LayerKnowledge

FOLDER = Path(__file__).parent / "knowledge"


@cache
def knowledge() -> tuple[LayerKnowledge, ...]:
    """Return every layer, in the order in which they are ruled out.

    Raises:
        ValueError: a file of the package is not what its model says; tests hold that none is.
    """
    return tuple(_layer(name) for name in LAYERS)


def _layer(name: str) -> LayerKnowledge:
    read = read_model(FOLDER / f"{name}.yaml", f"{name}.yaml", LayerKnowledge)
    if read.value is None:
        raise ValueError("; ".join(f"{found.span}: {found.message}" for found in read.diagnostics))
    return read.value[0]
