"""All artifacts of a cell, in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.emit import (
    cell_picture,
    commissioning,
    description,
    frames,
    gates,
    moveit,
    node_graph,
    package,
    parameters,
    readme,
    rehearsals,
    responsibility_graph,
    rviz,
    simulation,
)
from cellc.compiler.emit.audit import audit
from cellc.compiler.emit.contract import contract
from cellc.compiler.emit.launch import among_mock, launch
from cellc.compiler.emit.middleware import middleware
from cellc.compiler.emit.security import policy
from cellc.compiler.graph.cell_graph import CellGraph

EMITTERS: tuple[Callable[[CellGraph, Deployment], Iterator[Artifact]], ...] = (
    package.emit,
    description.emit,
    simulation.emit,
    moveit.emit,
    commissioning.emit,
    rviz.emit,
    parameters.emit,
    frames.emit,
    launch.emit,
    among_mock.emit,
    contract.emit,
    rehearsals.emit,
    middleware.emit,
    policy.emit,
    responsibility_graph.emit,
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
