"""``config/moveit/*.yaml``: what move_group is told beyond the description and the joint limits.

ROS parameter files for every node that is started with them, with the keys of MoveIt 2.5 on Humble and of 2.12 and
later on the others. Only for a cell with planning groups and a node that reads them. The controllers that it calls are
a file for each target where a device's own node takes the goals on real hardware. Left out: ``sensors_3d``, because no
sensor of the catalogue feeds an occupancy map; and servoing, which is no goal with a result.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.cell.interface import TARGETS, ParameterValue
from cellc.deploy.files import moveit_controllers_file, plans
from cellc.diagnostics import YamlPath
from cellc.emit.moveit.execution import controllers, planning_scene, trajectory_execution
from cellc.emit.moveit.pipelines import planning_pipelines
from cellc.formats.header import Header
from cellc.formats.parameter_file import ANY_NODE, NodeParameters, parameter_file
from cellc.graph.cell_graph import CellGraph

_GROUPS: YamlPath = ("motion", "groups")
_CONTROL: YamlPath = ("control", "controllers")


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the parameter files."""
    cell = graph.cell
    if not plans(cell):
        return
    for name, origin, parameters in (
        ("kinematics", _GROUPS, _kinematics(cell)),
        ("cartesian_limits", ("motion",), _cartesian_limits()),
        ("planning_pipelines", _GROUPS, planning_pipelines(cell)),
        ("trajectory_execution", _CONTROL, trajectory_execution(cell)),
        ("planning_scene", ("scene",), planning_scene()),
    ):
        section = NodeParameters(ANY_NODE, origin, parameters)
        yield Artifact(f"config/moveit/{name}.yaml", parameter_file(header, [section]))
    for file, target in {moveit_controllers_file(cell, target): target for target in TARGETS}.items():
        section = NodeParameters(ANY_NODE, _CONTROL, controllers(cell, target))
        yield Artifact(file, parameter_file(header, [section]))


def _kinematics(cell: Cell) -> Mapping[str, ParameterValue]:
    parameters: dict[str, ParameterValue] = {}
    for group in cell.groups:
        prefix = f"robot_description_kinematics.{group.name}"
        parameters |= {
            f"{prefix}.kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin",
            f"{prefix}.kinematics_solver_search_resolution": 0.005,
            f"{prefix}.kinematics_solver_timeout": 0.05,
        }
    return parameters


def _cartesian_limits() -> Mapping[str, ParameterValue]:
    # 0.25 m/s is the reduced speed of ISO 10218-1; the others are own choices that reach it within half a second.
    prefix = "robot_description_planning.cartesian_limits"
    return {
        f"{prefix}.max_trans_vel": 0.25,
        f"{prefix}.max_trans_acc": 0.5,
        f"{prefix}.max_trans_dec": -0.5,
        f"{prefix}.max_rot_vel": 0.5,
    }
