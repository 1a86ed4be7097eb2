"""``config/joint_limits.yaml``: limits of the cell for planning, as ROS parameters that MoveIt reads.

MoveIt takes positions from here over those of the URDF and has accelerations and jerks from nowhere else: without an
acceleration for every active joint its time parameterization fails. Only for a cell that plans: a controller takes no
limits from here. Left out: joints that follow another.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.device import DeviceJoint
from cellc.deploy.files import JOINT_LIMITS, plans
from cellc.formats.header import Header
from cellc.formats.parameter_file import ANY_NODE
from cellc.formats.yaml_text import Tree, render
from cellc.graph.cell_graph import CellGraph

# The limits below are the cell's own and already tightened, so that nothing is scaled a second time.
_SCALING: dict[str, float] = {"default_velocity_scaling_factor": 1.0, "default_acceleration_scaling_factor": 1.0}


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the limits of every joint that moves on its own, for a cell that plans."""
    if not plans(graph.cell):
        return
    joints = (joint for device in graph.cell.devices for joint in device.joints if joint.mimics is None)
    limits: Tree = {**_SCALING, "joint_limits": {joint.name: _limits(joint) for joint in joints}}
    tree: Tree = {ANY_NODE: {"ros__parameters": {"robot_description_planning": limits}}}
    yield Artifact(JOINT_LIMITS, header.commented("#") + "# devices, with the limits of each\n" + render(tree))


def _limits(joint: DeviceJoint) -> Tree:
    position = {} if joint.type == "continuous" else {"min_position": joint.lower, "max_position": joint.upper}
    return {
        **_stated("has_position_limits", position),
        **_stated("has_velocity_limits", {"max_velocity": joint.velocity}),
        **_stated("has_acceleration_limits", {"max_acceleration": joint.acceleration}),
        **_stated("has_jerk_limits", {"max_jerk": joint.jerk}),
    }


def _stated(switch: str, values: dict[str, float | None]) -> dict[str, bool | float]:
    known = {name: float(value) for name, value in values.items() if value is not None}
    return {switch: bool(known)} | known
