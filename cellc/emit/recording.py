"""``config/recording_qos.yaml``: what an attempt records, with the QoS that every publisher offers.

QoS override file of rosbag2, whose topics are those of the motion path and those that the spec adds; the command to
record stands in its first lines. Durations are left at their defaults, which match any publisher. Left out: raw images
of cameras on the control path, unless the spec asks for them: their volume belongs on another card.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.interface import Qos
from cellc.deploy.deployment import Deployment
from cellc.deploy.files import RECORDING
from cellc.deploy.recording import record_command
from cellc.formats.yaml_text import Tree, render
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the override file."""
    # As a comment, so that the override file says what it is used with; E is the folder of the attempt.
    command = "# " + " \\\n#   ".join(record_command(graph.cell, "bag")) + "\n\n"
    text = render({name: _profile(qos) for name, qos in plan.recorded.items()})
    origin = "# interfaces, control.controllers, recording.topics\n"
    yield Artifact(RECORDING, plan.header.commented("#") + command + origin + text)


def _profile(qos: Qos) -> Tree:
    return {
        "history": "keep_last",
        "depth": qos.depth,
        "reliability": qos.reliability,
        "durability": qos.durability,
    }
