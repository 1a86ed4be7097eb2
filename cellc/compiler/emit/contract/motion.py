"""Frames, calibrations, controllers, joint limits, groups, poses and goals of the contract."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.frame import Frame, Grasp
from cellc.compiler.cell.members import shared
from cellc.compiler.cell.motion import CartesianGoal, PlanningGroup
from cellc.compiler.emit.contract.devices import contract_gripper
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.urdf.robot import described_frames
from cellc.compiler.graph.claims import adapter_of_group
from cellc.compiler.graph.control_laws import start_outside
from cellc.contract.base import ContractPose
from cellc.contract.contract import (
    ContractBand,
    ContractCalibration,
    ContractController,
    ContractFrame,
    ContractGoal,
    ContractGrasp,
    ContractGroup,
    ContractJointLimits,
    ContractManager,
    ContractPoseTarget,
    ContractSwitch,
)
from cellc.contract.devices import ContractGripper
from cellc.contract.quantities import LARGEST
from cellc.contract.transforms import Pose


def calibrations(cell: Cell) -> dict[str, ContractCalibration]:
    """Return every calibration with its revision."""
    return {
        name: ContractCalibration.model_validate(shared(calibration, ContractCalibration))
        for name, calibration in cell.calibrations.items()
    }


def frames(cell: Cell) -> dict[str, ContractFrame]:
    """Return every frame by name; the pose of one in the robot description is left to that."""
    described = described_frames(cell)
    grippers = {
        name: facts for device in cell.devices if (facts := contract_gripper(cell, device)) for name in [device.name]
    }
    return {frame.name: _frame(frame, frame.name in described, grippers) for frame in cell.frames}


def _grasp(grasp: Grasp, grippers: Mapping[str, ContractGripper]) -> ContractGrasp:
    bands: dict[str, ContractBand] = {}
    if grasp.width_m is not None and grasp.tolerance_m is not None:
        for name, gripper in grippers.items():
            ends = [gripper.position(grasp.width_m + more) for more in (-grasp.tolerance_m, grasp.tolerance_m)]
            bands[name] = ContractBand(joint=gripper.joint, lower=rounded(min(ends)), upper=rounded(max(ends)))
    return ContractGrasp(width_m=grasp.width_m, tolerance_m=grasp.tolerance_m, mass_kg=grasp.mass_kg, bands=bands)


def _frame(frame: Frame, described: bool, grippers: Mapping[str, ContractGripper]) -> ContractFrame:
    pose = None if described else frame.transform_to_parent
    simulated = frame.simulated_pose
    special = {
        "kind": frame.kind.value,
        "moving": frame.moving or frame.transform_to_parent is None,
        "pose": None if pose is None else _contract_pose(pose),
        "simulated_parent": None if simulated is None else simulated.parent,
        "simulated_pose": None if simulated is None else _contract_pose(simulated.pose),
        "grasp": None if frame.grasp is None else _grasp(frame.grasp, grippers),
    }
    return ContractFrame.model_validate({**shared(frame, ContractFrame), **special})


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
    special = {
        "controller": next(active, None if adapted is None else adapted.device),
        "start_outside": start_outside(cell),
    }
    return ContractGroup.model_validate({**shared(group, ContractGroup), **special})


def _goal(goal: CartesianGoal) -> ContractGoal:
    pose = _contract_pose(goal.transform_tip_to_frame)
    return ContractGoal.model_validate({**shared(goal, ContractGoal), "pose": pose})


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
    special = {
        "full_name": controller.full_name,
        "real_command_interfaces": None if on_real is None else on_real.command_interfaces,
        "real_action": None if other is None else other.action,
        "real_action_type": None if other is None else other.action_type,
    }
    return ContractController.model_validate({**shared(controller, ContractController), **special})


def _contract_pose(pose: Pose) -> ContractPose:
    """Return meters and a unit quaternion x, y, z, w without rounding noise."""
    x, y, z = (rounded(value) for value in pose.position)
    qx, qy, qz, qw = (rounded(value) for value in pose.quaternion)
    return ContractPose(xyz=(x, y, z), quaternion=(qx, qy, qz, qw))
