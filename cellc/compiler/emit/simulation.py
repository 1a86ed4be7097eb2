"""``sim/scene.xml``: the cell for MuJoCo, in MJCF as its versions 3.2 to 4.0 read it.

Every link with its mass and its collision shapes, joints with their range and effort, actuators by the control law of
the real target, fingers that follow others, parts as free bodies, cameras in their optical frames, force-torque
sensors, and a keyframe for each named pose. Every frame is a site of its name, and the pairs of the SRDF are those
without a contact; those of bodies between which no joint moves are not listed, as MuJoCo looks for none there. The
file says which figures are not stated, and what is used in their place. It is written here and not by MuJoCo, so that
each machine writes the same bytes. Meshes are named as the description names them, never copied; those that are not at
hand are left out, as in every other check of collisions. A force-torque sensor of MuJoCo tells what the robot gives to
its tool, so that the weight of a tool points up: the sign of most drivers is the other one.

Left out: looks beyond the color of a shape, decomposed meshes (MuJoCo takes the convex hull), integrals of controllers,
and a cell whose bodies carry each other deeper than parsers read.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import SCENE
from cellc.compiler.feasibility import disabled_links, mesh_faults
from cellc.compiler.formats.mjcf.scene import scene
from cellc.compiler.formats.xml_text import render
from cellc.compiler.graph.cell_graph import CellGraph


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the scene."""
    pairs = tuple((pair.first, pair.second) for pair in disabled_links(graph).pairs)
    unusable = {fault.name: "is not at hand or cannot be used" for fault in mesh_faults(graph)}
    yield Artifact(SCENE, render(scene(graph, pairs, unusable), plan.header.text))
