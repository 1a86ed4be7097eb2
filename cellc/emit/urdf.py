"""``urdf/<cell>.mock.urdf`` and ``urdf/<cell>.real.urdf``: the cell as robot_state_publisher and ros2_control read it.

URDF 1.0 with ``<ros2_control>`` tags. The launch file passes it through xacro, which puts in the share folders of
installed packages (``$(find …)`` in hardware parameters); nothing else in it needs xacro. Left out: accelerations and
jerks, which URDF cannot hold (``config/joint_limits.yaml`` has them), dynamic frames, and transmissions.
A cell with several controller managers has one more for each, ``urdf/<cell>.<manager>.<target>.urdf``: a manager takes
all hardware that it reads of, and two that drive one robot are one too many.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.deploy.deployment import Deployment
from cellc.deploy.files import description_file, manager_description_file
from cellc.formats.urdf.robot import manager_description, robot_description
from cellc.formats.xml_text import render
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the description for each target."""
    cell = graph.cell
    for target in ("mock", "real"):
        yield Artifact(description_file(cell, target), render(robot_description(cell, target), plan.header.text))
        for manager in cell.managers if len(cell.managers) > 1 else ():
            own = manager_description(cell, target, manager.devices)
            yield Artifact(manager_description_file(cell, manager, target), render(own, plan.header.text))
