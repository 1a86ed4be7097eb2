"""``config/moveit/*.yaml``, ``config/joint_limits.yaml``: what move_group gets beyond the description.

ROS parameter files for every node that is started with them, with the keys of MoveIt 2.5 on Humble and of 2.12 and
later on the others. Only for a cell with planning groups and a node that reads them: a controller takes no limits from
here. The controllers that it calls are a file for each target where a device's own node takes the goals on real
hardware. ``sensors_3d`` and ``servo`` where the cell has them. Left out: limits of joints that follow another.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.cell.motion import POINT_CLOUD, Octomap, Pipeline, Servo
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import (
    JOINT_LIMITS,
    SENSORS,
    SERVO,
    control_path,
    executes_plans,
    moveit_controllers_file,
    plans,
)
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.parameter_file import ANY_NODE, NodeParameters, parameter_file
from cellc.compiler.formats.yaml_text import Tree, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.commissioning import LINEAR_M_S, LINEAR_M_S2, TURNING_RAD_S
from cellc.compiler.graph.control_laws import start_outside
from cellc.compiler.graph.simulated import SIM, is_asked, simulated
from cellc.compiler.link.control import TRAJECTORY_ACTION
from cellc.compiler.link.names import JOINT_STATES
from cellc.contract.diagnostics import YamlPath
from cellc.contract.entities import TARGETS, Target
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Feature, features

Parameters = Mapping[str, ParameterValue]

_GROUPS: YamlPath = ("motion", "groups")
_MANAGER = "moveit_simple_controller_manager"
_TYPES = ("FollowJointTrajectory", "GripperCommand", "ParallelGripperCommand")
# For a request that states none: MoveIt's own default. Full speed is only on request.
_SCALING: dict[str, float] = {"default_velocity_scaling_factor": 0.1, "default_acceleration_scaling_factor": 0.1}

_SAMPLING = "ompl"
_SENSOR = "map_source"
_REQUEST = "default_planning_request_adapters"
_RESPONSE = "default_planning_response_adapters"
_REQUEST_ADAPTERS = (
    "ResolveConstraintFrames",
    "ValidateWorkspaceBounds",
    "CheckStartStateBounds",
    "CheckStartStateCollision",
)
_TIMES = "AddTimeOptimalParameterization"
_RESPONSE_ADAPTERS = (_TIMES, "ValidateSolution", "DisplayMotionPath")
# Before there were lists: one text of adapters before and after planning, the outermost first; none for a pipeline that
# states its own times.
_TEXT_PREFIX = "default_planner_request_adapters"
_TEXT_ADAPTERS = (
    _TIMES,
    "ResolveConstraintFrames",
    "FixWorkspaceBounds",
    "FixStartStateBounds",
    "FixStartStateCollision",
    "FixStartStatePathConstraints",
)


@dataclass(frozen=True, slots=True)
class _Called:
    """An action that MoveIt calls: its full name and type, and the joints that it moves."""

    action: str
    type: str
    joints: tuple[str, ...]


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the parameter files."""
    cell = graph.cell
    if not plans(cell):
        return
    yield _joint_limits(cell, plan.header)
    for name, origin, parameters in (
        ("kinematics", _GROUPS, _kinematics(cell)),
        ("move_group", ("motion",), _move_group(cell)),
    ):
        section = NodeParameters(ANY_NODE, origin, parameters)
        yield Artifact(f"config/moveit/{name}.yaml", parameter_file(plan.header, [section]))
    if cell.octomap is not None:
        section = NodeParameters(ANY_NODE, ("motion", "octomap"), _sensors(cell, cell.octomap))
        yield Artifact(SENSORS, parameter_file(plan.header, [section]))
    if cell.servo is not None:
        section = NodeParameters(ANY_NODE, ("motion", "servo"), _servo(cell, cell.servo))
        yield Artifact(SERVO, parameter_file(plan.header, [section]))
    called = {moveit_controllers_file(cell, target): _controllers(cell, target) for target in TARGETS}
    if is_asked(cell) and len(called) > 1:
        called[moveit_controllers_file(cell, SIM)] = _controllers(simulated(cell), "mock")
    for file, parameters in called.items():
        section = NodeParameters(ANY_NODE, control_path(cell), parameters)
        yield Artifact(file, parameter_file(plan.header, [section]))


def _joint_limits(cell: Cell, header: Header) -> Artifact:
    """Return the limits of every joint that moves on its own.

    MoveIt takes positions from here over those of the URDF and has accelerations and jerks from nowhere else: without
    an acceleration for every active joint its time parameterization fails.
    """
    joints = (joint for device in cell.devices for joint in device.joints if joint.mimics is None)
    limits: Tree = {**_SCALING, "joint_limits": {joint.name: _limits(joint) for joint in joints}}
    tree: Tree = {ANY_NODE: {"ros__parameters": {"robot_description_planning": limits}}}
    return Artifact(JOINT_LIMITS, header.commented("#") + "# devices, with the limits of each\n" + render(tree))


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


def _kinematics(cell: Cell) -> Parameters:
    parameters: dict[str, ParameterValue] = {}
    for group in cell.groups:
        prefix, solver = f"robot_description_kinematics.{group.name}", group.solver
        parameters |= {
            f"{prefix}.kinematics_solver": solver.plugin,
            f"{prefix}.kinematics_solver_search_resolution": solver.search_resolution,
            f"{prefix}.kinematics_solver_timeout": solver.timeout_s,
        }
        parameters |= {f"{prefix}.{name}": value for name, value in solver.parameters.items()}
    return parameters


def _move_group(cell: Cell) -> Parameters:
    """Return pipelines, execution, scene and the limits of linear motion."""
    return {**_planning_pipelines(cell), **_trajectory_execution(cell), **_planning_scene(), **_cartesian_limits()}


def _cartesian_limits() -> Parameters:
    prefix = "robot_description_planning.cartesian_limits"
    return {
        f"{prefix}.max_trans_vel": LINEAR_M_S,
        f"{prefix}.max_trans_acc": LINEAR_M_S2,
        f"{prefix}.max_trans_dec": -LINEAR_M_S2,
        f"{prefix}.max_rot_vel": TURNING_RAD_S,
    }


def _planning_pipelines(cell: Cell) -> Parameters:
    """Return the pipelines with their plugins, adapters and planners; the first is the default."""
    capabilities = " ".join(name for pipeline in cell.pipelines for name in pipeline.capabilities)
    parameters: dict[str, ParameterValue] = {
        "planning_pipelines": tuple(pipeline.name for pipeline in cell.pipelines),
        "default_planning_pipeline": cell.pipelines[0].name,
        **({"capabilities": capabilities} if capabilities else {}),
    }
    for pipeline in cell.pipelines:
        parameters |= _pipeline(cell, pipeline)
        if pipeline.name == _SAMPLING:
            parameters |= _planners(cell)
        parameters |= {f"{pipeline.name}.{name}": value for name, value in pipeline.parameters.items()}
    return parameters


def _pipeline(cell: Cell, pipeline: Pipeline) -> Parameters:
    name = pipeline.name
    if Feature.PLUGIN_LISTS not in features(cell.distro):
        adapters = "" if pipeline.timed else " ".join(f"{_TEXT_PREFIX}/{adapter}" for adapter in _TEXT_ADAPTERS)
        # Zero: a start state outside its bounds is refused, and moved inside only as far as springs let joints droop.
        outside: Parameters = {f"{name}.start_state_max_bounds_error": start_outside(cell)}
        bounds = {} if pipeline.timed else outside
        return {f"{name}.planning_plugin": pipeline.plugin, f"{name}.request_adapters": adapters, **bounds}
    response = (adapter for adapter in _RESPONSE_ADAPTERS if not (pipeline.timed and adapter == _TIMES))
    return {
        f"{name}.planning_plugins": (pipeline.plugin,),
        f"{name}.request_adapters": tuple(f"{_REQUEST}/{adapter}" for adapter in _REQUEST_ADAPTERS),
        f"{name}.response_adapters": tuple(f"{_RESPONSE}/{adapter}" for adapter in response),
    }


def _planners(cell: Cell) -> Parameters:
    """Return the planner of each group in the sampling pipeline, and its projection evaluator."""
    parameters: dict[str, ParameterValue] = {}
    for planner in dict.fromkeys(group.planner for group in cell.groups):
        parameters[f"{_SAMPLING}.planner_configs.{_config(planner)}.type"] = f"geometric::{planner}"
    for group in cell.groups:
        prefix, planner = f"{_SAMPLING}.{group.name}", _config(group.planner)
        parameters |= {
            f"{prefix}.default_planner_config": planner,
            f"{prefix}.planner_configs": (planner,),
            f"{prefix}.longest_valid_segment_fraction": 0.005,
        }
        if len(group.joints) > 1:
            parameters[f"{prefix}.projection_evaluator"] = f"joints({','.join(group.joints[:2])})"
    return parameters


def _config(planner: str) -> str:
    return f"{planner}kConfigDefault"


def _controllers(cell: Cell, target: Target) -> Parameters:
    """Return what executes plans on a target: controllers with an action that MoveIt knows, adapters, stand-ins."""
    called = {_name(cell, called): called for called in _called(cell, target) if _short(called.type) in _TYPES}
    parameters: dict[str, ParameterValue] = {
        "moveit_controller_manager": f"{_MANAGER}/MoveItSimpleControllerManager",
        f"{_MANAGER}.controller_names": tuple(called),
    }
    for name, declared in called.items():
        parameters |= {
            f"{_MANAGER}.{name}.type": _short(declared.type),
            f"{_MANAGER}.{name}.action_ns": declared.action.rpartition("/")[2],
            f"{_MANAGER}.{name}.joints": declared.joints,
            f"{_MANAGER}.{name}.default": True,
        }
    return parameters


def _trajectory_execution(cell: Cell) -> Parameters:
    """Return how execution is watched.

    A device that slows trajectories down outlasts the planned duration: there MoveIt must not abort for it, and the
    controller's own tolerances watch instead.
    """
    slowed = any(device.control.speed_scaling is not None for device in cell.devices)
    return {
        # Switching is a declared step of the cell, never a side effect of planning.
        "moveit_manage_controllers": False,
        "trajectory_execution.execution_duration_monitoring": not slowed,
        "trajectory_execution.allowed_execution_duration_scaling": 1.2,
        "trajectory_execution.allowed_goal_duration_margin": 0.5,
        "trajectory_execution.allowed_start_tolerance": 0.01,
        "trajectory_execution.wait_for_trajectory_completion": True,
    }


def _planning_scene() -> Parameters:
    """Return what move_group tells of its scene; the description's publisher is robot_state_publisher alone."""
    return {
        "publish_planning_scene": True,
        "publish_geometry_updates": True,
        "publish_state_updates": True,
        "publish_transforms_updates": True,
        "publish_robot_description": False,
        "publish_robot_description_semantic": True,
    }


def _sensors(cell: Cell, octomap: Octomap) -> Parameters:
    """Return what feeds the occupancy map: an updater refuses to start where one of its parameters is missing.

    The plugins are those of moveit_ros_perception, with the parameters of setParams in 2.5.9 and 2.12.4:
    moveit_ros/perception/depth_image_octomap_updater/src, moveit_ros/perception/pointcloud_octomap_updater/src.
    """
    types = {interface.name: interface.type for interface in cell.interfaces}
    common: Parameters = {
        "padding_offset": octomap.padding_m,
        "padding_scale": 1.0,
        "max_update_rate": octomap.rate_hz,
        "filtered_cloud_topic": "octomap_input_without_robot",
        "ns": "",
    }
    if types.get(octomap.source) == POINT_CLOUD:
        plugin, settings = "PointCloudOctomapUpdater", _of_cloud(octomap)
    else:
        plugin, settings = "DepthImageOctomapUpdater", _of_image(octomap)
    sensor = {"sensor_plugin": f"occupancy_map_monitor/{plugin}", **settings, **common}
    parameters = {f"{_SENSOR}.{name}": value for name, value in sensor.items()}
    return {"octomap_resolution": octomap.resolution_m, "sensors": (_SENSOR,), **parameters}


def _of_cloud(octomap: Octomap) -> Parameters:
    return {"point_cloud_topic": octomap.source, "max_range": octomap.range_m, "point_subsample": 1}


def _of_image(octomap: Octomap) -> Parameters:
    return {
        "image_topic": octomap.source,
        "queue_size": 5,
        "near_clipping_plane_distance": octomap.nearest_m,
        "far_clipping_plane_distance": octomap.range_m,
        "shadow_threshold": 0.2,
        "skip_vertical_pixels": 4,
        "skip_horizontal_pixels": 6,
    }


def _servo(cell: Cell, servo: Servo) -> Parameters:
    """Return what MoveIt Servo gets; move_group keeps the planning scene, and Servo follows it.

    Sources: moveit2@2.12.4 moveit_ros/moveit_servo/config/servo_parameters.yaml, the same in 2.14.1 and 2.15.0; @2.5.9
    moveit_ros/moveit_servo/src/servo_parameters.cpp:101-260, where frames have no default that fits a robot.
    """
    (group,) = (group for group in cell.groups if group.name == servo.group)
    frames: Parameters = {
        "use_gazebo": False,
        "planning_frame": WORLD,
        "ee_frame_name": group.tip_frame,
        "robot_link_command_frame": group.base_link,
    }
    parameters: Parameters = {
        "move_group_name": group.name,
        "command_in_type": servo.commands,
        "scale.linear": servo.linear,
        "scale.rotational": servo.rotational,
        "scale.joint": servo.joint,
        "incoming_command_timeout": servo.command_timeout_s,
        "publish_period": servo.period_s,
        "command_out_topic": servo.topic,
        "command_out_type": servo.type.replace("/msg/", "/"),
        "publish_joint_positions": servo.positions,
        "publish_joint_velocities": servo.velocities,
        "publish_joint_accelerations": False,
        "check_collisions": True,
        "is_primary_planning_scene_monitor": False,
        "monitored_planning_scene_topic": _scene_topic(cell),
        "joint_topic": JOINT_STATES,
        **({} if Feature.PLUGIN_LISTS in features(cell.distro) else frames),
    }
    return {f"moveit_servo.{name}": value for name, value in parameters.items()}


def _scene_topic(cell: Cell) -> str:
    namespace = next((node.namespace for node in cell.planners), "")
    return f"{namespace}/monitored_planning_scene"


def _called(cell: Cell, target: Target) -> Iterator[_Called]:
    for controller in cell.controllers:
        if not executes_plans(cell, controller):
            continue
        if target in controller.targets and controller.action is not None:
            yield _Called(controller.action, controller.action_type or "", controller.joints)
        elif target == "real" and controller.stand_in is not None:
            yield _Called(controller.stand_in.action, controller.stand_in.action_type, controller.joints)
    for adapted in cell.adapters:
        if executes_plans(cell, adapted):
            yield _Called(adapted.action, TRAJECTORY_ACTION, adapted.joints)


def _name(cell: Cell, called: _Called) -> str:
    """Return the name below which MoveIt looks for the action, with the namespace of who serves it.

    It is relative to move_group: with its slash where that is in a namespace of its own.
    """
    name = called.action.rpartition("/")[0]
    return name if any(node.namespace for node in cell.planners) else name.removeprefix("/")


def _short(type_: str) -> str:
    return type_.rpartition("/")[2]
