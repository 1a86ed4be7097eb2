"""All artifacts of a cell, in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cellc.artifact import Artifact
from cellc.deploy.deployment import Deployment
from cellc.emit import (
    cell_picture,
    description,
    frames,
    gates,
    moveit,
    node_graph,
    package,
    parameters,
    picture,
    readme,
    rehearsals,
    responsibility_graph,
    rviz,
)
from cellc.emit.audit import audit
from cellc.emit.contract import contract
from cellc.emit.launch import launch
from cellc.emit.middleware import middleware
from cellc.emit.security import policy
from cellc.graph.cell_graph import CellGraph

EMITTERS: tuple[Callable[[CellGraph, Deployment], Iterator[Artifact]], ...] = (
    package.emit,
    description.emit,
    moveit.emit,
    rviz.emit,
    parameters.emit,
    frames.emit,
    launch.emit,
    contract.emit,
    rehearsals.emit,
    middleware.emit,
    policy.emit,
    responsibility_graph.emit,
    picture.emit,
    cell_picture.emit,
    node_graph.emit,
    gates.emit,
    audit.emit,
    readme.emit,
)
"""Every emitter; a new one is one file and one line here."""


def emit_all(graph: CellGraph, plan: Deployment) -> tuple[Artifact, ...]:
    """Emit every artifact of a checked cell but the manifest, which is taken over them.

    Returns:
        Artifacts in the order of the emitters; their paths are relative to the generated package and differ.
    """
    return tuple(artifact for emit in EMITTERS for artifact in emit(graph, plan))
