"""``config/commissioning/stage_*.yaml``: what each stage of commissioning leaves planned motion.

ROS parameter files that move_group and MoveIt Servo are given last, so that they replace the limits of
``config/joint_limits.yaml``, ``config/moveit/move_group.yaml`` and ``config/moveit/servo.yaml``. A request only scales
them down: a factor above 1 counts as 1 (verifyScalingFactor of moveit2@2.12.4
moveit_core/trajectory_processing/src/time_optimal_trajectory_generation.cpp). Left out: positions and jerks, which no
stage changes; forces, which MoveIt does not plan.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.cell.motion import Servo
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import stage_files
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.parameter_file import ANY_NODE, NodeParameters, parameter_file
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.commissioning import LINEAR_M_S, LINEAR_M_S2, TURNING_RAD_S, Stage, stages

_PLANNING = "robot_description_planning"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield a file for each stage."""
    files = stage_files(graph.cell)
    for stage in stages(graph) if files else ():
        section = NodeParameters(ANY_NODE, ("bringup", "commissioning"), _caps(stage, graph.cell.servo))
        yield Artifact(files[stage.percent], parameter_file(plan.header, [section]))


def _caps(stage: Stage, servo: Servo | None) -> dict[str, ParameterValue]:
    caps: dict[str, ParameterValue] = {}
    for name, joint in stage.joints.items():
        for of, value in (("velocity", joint.velocity), ("acceleration", joint.acceleration)):
            if value is not None:
                caps[f"{_PLANNING}.joint_limits.{name}.has_{of}_limits"] = True
                caps[f"{_PLANNING}.joint_limits.{name}.max_{of}"] = min(rounded(value), value)  # never above the limit
    straight, left = f"{_PLANNING}.cartesian_limits", stage.of_straight(LINEAR_M_S)
    caps |= {
        f"{straight}.max_trans_vel": rounded(left * LINEAR_M_S),
        f"{straight}.max_trans_acc": rounded(stage.acceleration * LINEAR_M_S2),
        f"{straight}.max_trans_dec": rounded(-stage.acceleration * LINEAR_M_S2),
        f"{straight}.max_rot_vel": rounded(left * TURNING_RAD_S),
    }
    if servo is not None:
        left = stage.of_straight(servo.linear)
        scales = {"linear": servo.linear, "rotational": servo.rotational, "joint": servo.joint}
        caps |= {f"moveit_servo.scale.{of}": rounded(left * speed) for of, speed in scales.items()}
    return caps
