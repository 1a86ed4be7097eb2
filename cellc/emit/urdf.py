"""``urdf/<cell>.mock.urdf`` and ``urdf/<cell>.real.urdf``: the cell as robot_state_publisher and ros2_control read it.

URDF 1.0 with ``<ros2_control>`` tags. The launch file passes it through xacro, which puts in the share folders of
installed packages (``$(find …)`` in hardware parameters); nothing else in it needs xacro. Left out: accelerations and
jerks, which URDF cannot hold (``config/joint_limits.yaml`` has them), dynamic frames, and transmissions.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.formats.header import Header
from cellc.formats.package_files import description_file
from cellc.formats.urdf.robot import robot_description
from cellc.formats.xml_text import render
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the description for each target."""
    cell = graph.cell
    for target in ("mock", "real"):
        yield Artifact(description_file(cell, target), render(robot_description(cell, target), header.text))
