"""Controller managers, controllers and joint limits of the contract."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.control import Controller, ControllerManager
from cellc.contract.contract import ContractController, ContractJointLimits, ContractManager, ContractSwitch


def managers(cell: Cell) -> dict[str, ContractManager]:
    """Return every controller manager with its controllers in the order of start-up."""
    return {manager.name: _manager(manager) for manager in cell.managers}


def joint_limits(cell: Cell) -> dict[str, ContractJointLimits]:
    """Return the limits of every joint that moves on its own and whose limits are all stated."""
    limits: dict[str, ContractJointLimits] = {}
    for joint in (joint for device in cell.devices for joint in device.joints if joint.mimics is None):
        if joint.velocity is not None and joint.acceleration is not None and joint.jerk is not None:
            bounded = joint.type != "continuous"
            limits[joint.name] = ContractJointLimits(
                lower=joint.lower if bounded else None,
                upper=joint.upper if bounded else None,
                velocity=joint.velocity,
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
    other = controller.stand_in
    return ContractController.model_validate(
        {
            "plugin": controller.plugin,
            "behaviour": controller.behaviour,
            "full_name": controller.full_name,
            "targets": controller.targets,
            "device": controller.device,
            "joints": controller.joints,
            "command_interfaces": controller.command_interfaces,
            "state_interfaces": controller.state_interfaces,
            "active": controller.active,
            "client": controller.client,
            "action": controller.action,
            "action_type": controller.action_type,
            "real_action": None if other is None else other.action,
            "real_action_type": None if other is None else other.action_type,
            "on_violation": controller.on_violation,
        }
    )
