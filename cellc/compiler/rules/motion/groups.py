"""Rules on planning groups and their named poses."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.rules.described import described, in_its_file
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule
from cellc.compiler.rules.tolerances import stated
from cellc.contract.quantities import SMALLEST
from cellc.contract.vocabulary import TRAJECTORIES

_PARTIAL = "allow_partial_joints_goal"


@rule(Severity.ERROR, assumes=("group-without-joints", "tip-off-the-tool-chain"))
def controller_beyond_its_group(graph: CellGraph) -> Findings:
    """Yield groups whose controllers want more joints than a plan of the group has."""
    for group in graph.cell.groups:
        for controller in graph.cell.controllers_for(group):
            if controller.behavior not in TRAJECTORIES or controller.parameters.get(_PARTIAL) is True:
                continue
            lacking = [joint for joint in controller.joints if joint not in group.joints]
            if lacking:
                shown = ", ".join(f"`{joint}`" for joint in lacking[:3]) + (" and more" if lacking[3:] else "")
                message = f"`{controller.name}` drives {shown}, which group `{group.name}` lacks"
                driven = graph.cell.locate(*controller.path, "joints")
                related = (Related("the controller drives these joints", driven),)
                yield found(graph, group.path, message, related=related)


@rule(Severity.ERROR, assumes=("wrong-joint-count",))
def gripper_without_controller(graph: CellGraph) -> Findings:
    """Yield the first grip step of each gripper without a controller with an action."""
    driven = {controller.device for controller in graph.cell.controllers if controller.action}
    reported: set[str] = set()
    for step in (step for rehearsal in graph.cell.rehearsals for step in rehearsal.steps):
        if step.kind == "grip" and step.name not in driven and step.name not in reported:
            reported.add(step.name)
            message = f"no controller drives gripper `{step.name}`"
            yield found(graph, step.path, message)


@rule(Severity.ERROR)
def group_without_joints(graph: CellGraph) -> Findings:
    """Yield groups without a joint."""
    for group in graph.cell.groups:
        if not group.joints:
            message = f"there is no moving joint between `{group.base_link}` and `{group.tip_frame}`"
            yield found(graph, group.path, message)


@rule(Severity.ERROR)
def planner_of_joint_goals(graph: CellGraph) -> Findings:
    """Yield the default pipeline of a cell with Cartesian goals that it cannot plan to."""
    pipelines = graph.cell.pipelines
    if pipelines and pipelines[0].joint_goals and graph.cell.goals:
        message = f"`{pipelines[0].name}` takes only joint goals, but `{graph.cell.goals[0].name}` is a pose"
        yield found(graph, ("motion", "pipelines", 0), message)


@rule(Severity.WARNING)
def straight_planner_first(graph: CellGraph) -> Findings:
    """Yield a default pipeline that goes around nothing, where another one of the cell does."""
    pipelines = graph.cell.pipelines
    around = next((index for index, pipeline in enumerate(pipelines) if not pipeline.avoids_nothing), 0)
    if pipelines and pipelines[0].avoids_nothing and around:
        message = f"the default pipeline must go around obstacles, as `{pipelines[around].name}` does, got"
        related = (Related("this one goes around them", graph.cell.locate("motion", "pipelines", around)),)
        path = ("motion", "pipelines", 0)
        yield found(graph, path, f"{message} `{pipelines[0].name}`", related=related)


@rule(Severity.ERROR, assumes=("unit-of-another-joint",))
def pose_outside_limits(graph: CellGraph) -> Findings:
    """Yield each joint of a pose that is below its lower or above its upper limit."""
    joints = graph.cell.joints_by_name
    for pose in graph.cell.poses:
        if len(pose.joints) != len(pose.positions):
            continue
        for name, position in zip(pose.joints, pose.positions, strict=True):
            joint = joints.get(name)
            if joint is None or joint.lower is None or joint.upper is None:
                continue
            if not joint.lower <= position <= joint.upper:
                allowed = f"between {joint.lower:.4g} and {joint.upper:.4g}"
                message = f"`{name}` must be {allowed} in pose `{pose.name}`, got {position:.4g}"
                yield found(graph, pose.path, message, related=described(graph, [name]))


@rule(Severity.ERROR)
def unit_of_another_joint(graph: CellGraph) -> Findings:
    """Yield each figure whose unit is not that of its joint, once for each place."""
    joints = graph.cell.joints_by_name
    seen = set[YamlPath]()
    for path, name, linear in _figures(graph.cell):
        joint = joints.get(name)
        if joint is None or joint.slides == linear:
            continue
        named = (*path, f"{joint.path[-1]}/{joint.local_name}")  # a tolerance by joint
        at = named if graph.cell.states(*named) else path
        if at not in seen:
            seen.add(at)
            units = "`m` or `mm`" if joint.slides else "`rad` or `deg`"
            got = graph.cell.text(*at)
            yield found(graph, at, f"`{path[-1]}` must be in {units} for `{name}`, which is {joint.type}, got {got}")


def _figures(cell: Cell) -> Iterator[tuple[YamlPath, str, bool]]:
    """Yield the place of a figure, its joint, and whether it is a length."""
    for pose in cell.poses:
        if len(pose.joints) == len(pose.linear):
            yield from ((pose.path, name, linear) for name, linear in zip(pose.joints, pose.linear, strict=True))
    for controller in cell.controllers:
        for key, figures in stated(controller):
            yield from (((*controller.path, key), name, figure.linear) for name, figure in (figures or {}).items())
    for device in cell.devices:
        if device.control.adapter is not None and device.control.adapter.path_tolerance is not None:
            at: YamlPath = (*device.path, "adapter", "path_tolerance")
            fits = [joint.slides for joint in device.actuated_joints]
            linear = device.control.adapter.path_tolerance.linear
            # One figure is said of all joints: where a device has both kinds, it is that of one of them.
            yield from ((at, joint.name, linear) for joint in device.actuated_joints if linear not in fits)
    yield from _of_one_joint(cell)


def _of_one_joint(cell: Cell) -> Iterator[tuple[YamlPath, str, bool]]:
    joints = {f"{device.name}/{joint.local_name}": joint.name for device in cell.devices for joint in device.joints}
    for first in cell.bringup.first_motions:
        for key, figure in (("max_delta", first.max_delta), ("velocity", first.velocity)):
            yield (*first.path, key), joints.get(first.name, ""), figure.linear
    for rehearsal in cell.rehearsals:
        for fault in rehearsal.faults:
            by = fault.kind.by
            if by is not None and by.amount.of_joint:
                yield (*fault.path, by.amount.key), fault.name, fault.linear


@rule(
    Severity.ERROR,
    assumes=("limit-share-of-nothing", "missing-joint-limits", "missing-velocity-limit", "reversed-limits"),
)
def unplannable_joint(graph: CellGraph) -> Findings:
    """Yield joints of planning groups without the limits that a planner needs."""
    joints = graph.cell.joints_by_name
    for group in graph.cell.groups:
        for joint in (joints[name] for name in group.joints if name in joints):
            if lacks := " and no ".join(_lacking(joint)):
                message = f"joint `{joint.name}` of group `{group.name}` has no {lacks}"
                related = (*described(graph, [joint.name]), *_limits_of(graph, joint))
                yield found(graph, group.path, message, related=related)


def _limits_of(graph: CellGraph, joint: DeviceJoint) -> tuple[Related, ...]:
    """Return where the `device.yaml` that the user brings has limits of the kind that a joint lacks, or any."""
    device = graph.cell.device(graph.cell.holders[joint.name])
    kinds = (kind for kind in ("acceleration", "jerk") if getattr(joint, kind) is None)
    stated = [related for kind in kinds for related in in_its_file(device, "limits", kind)]
    return tuple(stated) or in_its_file(device, "limits")


def _lacking(joint: DeviceJoint) -> Iterator[str]:
    for name, limit in (("velocity", joint.velocity), ("acceleration", joint.acceleration), ("jerk", joint.jerk)):
        if limit is None or limit < SMALLEST:
            yield f"{name} limit"
    if joint.type != "continuous" and joint.lower is not None and joint.lower == joint.upper:
        yield f"range: both limits are {joint.lower:g}"


@rule(Severity.ERROR)
def wrong_pose_size(graph: CellGraph) -> Findings:
    """Yield poses whose number of values is not that of the group's joints."""
    for pose in graph.cell.poses:
        if len(pose.joints) != len(pose.positions):
            message = (
                f"expected {len(pose.joints)} values in pose `{pose.name}` of `{pose.group}`, got {len(pose.positions)}"
            )
            names = ", ".join(pose.joints)
            yield found(graph, pose.path, message, f"write one value for each of {names}")
