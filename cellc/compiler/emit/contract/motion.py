"""Frames, calibrations, controllers, joint limits, groups, poses and goals of the contract."""

from __future__ import annotations

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.frame import Frame
from cellc.compiler.cell.motion import CartesianGoal, PlanningGroup
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.urdf.robot import described_frames
from cellc.compiler.graph.claims import adapter_of_group
from cellc.compiler.graph.control_laws import start_outside
from cellc.contract.base import ContractPose
from cellc.contract.contract import (
    ContractCalibration,
    ContractController,
    ContractFrame,
    ContractGoal,
    ContractGroup,
    ContractJointLimits,
    ContractManager,
    ContractPoseTarget,
    ContractSwitch,
)
from cellc.contract.quantities import LARGEST
from cellc.contract.transforms import Pose


def calibrations(cell: Cell) -> dict[str, ContractCalibration]:
    """Return every calibration with its revision."""
    return {
        name: ContractCalibration(revision=calibration.revision, owner=calibration.owner)
        for name, calibration in cell.calibrations.items()
    }


def frames(cell: Cell) -> dict[str, ContractFrame]:
    """Return every frame by name; the pose of one in the robot description is left to that."""
    described = described_frames(cell)
    return {frame.name: _frame(frame, frame.name in described) for frame in cell.frames}


def _frame(frame: Frame, described: bool) -> ContractFrame:
    pose = None if described else frame.transform_to_parent
    simulated = frame.simulated_pose
    return ContractFrame(
        parent=frame.parent,
        authority=frame.authority,
        kind=frame.kind.value,
        moving=frame.moving or frame.transform_to_parent is None,
        pose=None if pose is None else _contract_pose(pose),
        calibration=frame.calibration,
        rate_hz=frame.rate_hz,
        buffer_s=frame.buffer_s,
        simulated_parent=None if simulated is None else simulated.parent,
        simulated_pose=None if simulated is None else _contract_pose(simulated.pose),
    )


def groups(cell: Cell) -> dict[str, ContractGroup]:
    """Return every planning group with the controller that is active for it."""
    return {group.name: _group(cell, group) for group in cell.groups}


def poses(cell: Cell) -> dict[str, tuple[ContractPoseTarget, ...]]:
    """Return named poses; one name may place several groups."""
    names = dict.fromkeys(pose.name for pose in cell.poses)
    return {
        name: tuple(
            ContractPoseTarget(group=pose.group, positions=pose.positions) for pose in cell.poses if pose.name == name
        )
        for name in names
    }


def goals(cell: Cell) -> dict[str, ContractGoal]:
    """Return every Cartesian goal."""
    return {goal.name: _goal(goal) for goal in cell.goals}


def _group(cell: Cell, group: PlanningGroup) -> ContractGroup:
    active = (c.label for c in cell.controllers if c.label in group.controllers and c.active)
    adapted = adapter_of_group(cell, group)
    return ContractGroup(
        base_link=group.base_link,
        tip_frame=group.tip_frame,
        joints=group.joints,
        controller=next(active, None if adapted is None else adapted.device),
        start_outside=start_outside(cell),
    )


def _goal(goal: CartesianGoal) -> ContractGoal:
    return ContractGoal.model_validate(
        {
            "group": goal.group,
            "frame": goal.frame,
            "pose": _contract_pose(goal.transform_tip_to_frame),
            "approach": goal.approach,
            "transform_at": goal.transform_at,
        }
    )


def managers(cell: Cell) -> dict[str, ContractManager]:
    """Return every controller manager with its controllers in the order of start-up."""
    return {manager.name: _manager(manager) for manager in cell.managers}


def joint_limits(cell: Cell) -> dict[str, ContractJointLimits]:
    """Return the limits of every joint that moves on its own and whose limits are all stated.

    A figure beyond any machine, such as the 1e16 that exporters write, is no limit. A joint with a speed limit of 0
    cannot move; a rule reports its commander.
    """
    limits: dict[str, ContractJointLimits] = {}
    for joint in (joint for device in cell.devices for joint in device.joints if joint.mimics is None):
        if joint.velocity and joint.acceleration is not None and joint.jerk is not None:
            lower, upper = (None, None) if joint.type == "continuous" else (joint.lower, joint.upper)
            limits[joint.name] = ContractJointLimits(
                lower=None if lower is None or lower < -LARGEST else lower,
                upper=None if upper is None or upper > LARGEST else upper,
                velocity=min(joint.velocity, LARGEST),
                acceleration=joint.acceleration,
                jerk=joint.jerk,
            )
    return limits


def _manager(manager: ControllerManager) -> ContractManager:
    labels = {controller.name: controller.label for controller in manager.controllers}
    return ContractManager(
        namespace=manager.namespace,
        update_rate_hz=manager.update_rate_hz,
        controllers={controller.label: _controller(controller) for controller in manager.controllers},
        switches={
            switch.name: ContractSwitch(
                activate=tuple(labels[name] for name in switch.activate),
                deactivate=tuple(labels[name] for name in switch.deactivate),
            )
            for switch in manager.switches
        },
    )


def _controller(controller: Controller) -> ContractController:
    other, on_real = controller.stand_in, controller.on_real
    return ContractController.model_validate(
        {
            "plugin": controller.plugin,
            "behavior": controller.behavior,
            "full_name": controller.full_name,
            "targets": controller.targets,
            "device": controller.device,
            "joints": controller.joints,
            "command_interfaces": controller.command_interfaces,
            "real_command_interfaces": None if on_real is None else on_real.command_interfaces,
            "state_interfaces": controller.state_interfaces,
            "active": controller.active,
            "client": controller.client,
            "action": controller.action,
            "action_type": controller.action_type,
            "real_action": None if other is None else other.action,
            "real_action_type": None if other is None else other.action_type,
            "goal_time_s": controller.goal_time_s,
            "on_violation": controller.on_violation,
        }
    )


def _contract_pose(pose: Pose) -> ContractPose:
    """Return meters and a unit quaternion x, y, z, w without rounding noise."""
    x, y, z = (rounded(value) for value in pose.position)
    qx, qy, qz, qw = (rounded(value) for value in pose.quaternion)
    return ContractPose(xyz=(x, y, z), quaternion=(qx, qy, qz, qw))
