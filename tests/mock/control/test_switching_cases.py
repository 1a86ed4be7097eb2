"""Every recorded service request of the real controller manager is repeated and must be answered alike."""

from __future__ import annotations

from typing import Any

import pytest

from cellc.mock.control import ControllerManager, ServiceResponse, Strictness
from tests.oracles import RECORDED, Case, read_yaml

_FOLDER = RECORDED / "switching"
_URDF = (RECORDED / "joint_trajectory" / "base_cell.urdf").read_text()
_FORWARD = "forward_command_controller/ForwardCommandController"
_TYPES = """
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    forward_position_controller: {type: FORWARD}
    joint1_only: {type: FORWARD}
    joint2_only: {type: FORWARD}
    missing_iface: {type: FORWARD}
    chain_top: {type: FORWARD}
    unconfigured_one: {type: FORWARD}
    bad_params: {type: FORWARD}
    pid_low: {type: pid_controller/PidController}
    pid_low2: {type: pid_controller/PidController}
    bad_type: {type: no_such_package/NoSuch}
    bad_jtc: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters: {joints: [joint1, joint2], command_interfaces: [position], state_interfaces: [position, velocity]}
forward_position_controller:
  ros__parameters: {joints: [joint1, joint2], interface_name: position}
joint1_only:
  ros__parameters: {joints: [joint1], interface_name: position}
joint2_only:
  ros__parameters: {joints: [joint2], interface_name: position}
missing_iface:
  ros__parameters: {joints: [joint1], interface_name: effort}
unconfigured_one:
  ros__parameters: {joints: [joint1], interface_name: position}
chain_top:
  ros__parameters: {joints: [pid_low/joint1], interface_name: position}
bad_params:
  ros__parameters: {joints: [joint1]}
pid_low:
  ros__parameters: {dof_names: [joint1], command_interface: position, reference_and_state_interfaces: [position]}
pid_low2:
  ros__parameters: {dof_names: [joint2], command_interface: position, reference_and_state_interfaces: [position]}
""".replace("FORWARD", _FORWARD)


def _requests() -> list[Any]:
    recorded = read_yaml(_FOLDER / "switch_controller.yaml")["requests"]
    return [pytest.param(request, id=request["name"]) for request in recorded]


def _cycle(manager: ControllerManager) -> None:
    target = manager.now_ns + 5 * manager.period_ns
    while manager.advance(target) < target:
        pass


def _active(manager: ControllerManager) -> list[str]:
    broadcaster = "joint_state_broadcaster"
    return sorted(c.name for c in manager.list_controllers() if c.state == "active" and c.name != broadcaster)


def _claimed(manager: ControllerManager) -> list[str]:
    return sorted(i.name for i in manager.list_hardware_interfaces().command_interfaces if i.is_claimed)


@pytest.mark.parametrize("request_", _requests())
def test_switch_is_answered_as_recorded(request_: Case) -> None:
    manager = ControllerManager(_URDF, _TYPES)
    names = ["joint_state_broadcaster", "arm_controller", "forward_position_controller", "joint1_only", "joint2_only"]
    manager.spawn([*names, "missing_iface", "pid_low", "pid_low2", "chain_top"], inactive=True)
    manager.load_controller("unconfigured_one")
    if request_["before_active"]:
        assert manager.switch_controllers(request_["before_active"], []).ok
    _cycle(manager)
    assert _active(manager) == sorted(request_["before_active"])
    wanted = request_["request"]
    strictness = Strictness[wanted["strictness"]] if isinstance(wanted["strictness"], str) else Strictness.UNSPECIFIED
    answer = manager.switch_controllers(wanted["activate"], wanted["deactivate"], strictness)
    _cycle(manager)
    assert answer == ServiceResponse(request_["answer"]["ok"], request_["answer"]["message"])
    assert _active(manager) == sorted(request_["after_active"])
    assert _claimed(manager) == sorted(request_["claimed_after"])


def _call(manager: ControllerManager, step: Case) -> ServiceResponse:
    name = step.get("name", "")
    if step["call"] == "switch":
        strictness = Strictness[step.get("strictness", "STRICT")]
        return manager.switch_controllers(step.get("activate", []), step.get("deactivate", []), strictness)
    if step["call"] == "hardware":
        hardware = manager.set_hardware_component_state(name, step["state"])
        assert hardware.state == step["answer"]["state"]
        return ServiceResponse(hardware.ok)
    services = {
        "load": manager.load_controller,
        "configure": manager.configure_controller,
        "cleanup": manager.cleanup_controller,
        "unload": manager.unload_controller,
    }
    return services[step["call"]](name)


def test_sequence_of_services_is_answered_as_recorded() -> None:
    manager = ControllerManager(_URDF, _TYPES)
    for step in read_yaml(_FOLDER / "services_sequence.yaml")["sequence"]:
        answer = _call(manager, step)
        _cycle(manager)
        where = f"step {step['step']}: {step['call']} {step.get('name', '')}"
        assert answer.ok is step["answer"]["ok"], where
        assert "message" not in step["answer"] or answer.message == step["answer"]["message"], where
        assert {c.name: c.state for c in manager.list_controllers()} == step["controllers"], where
        assert {c.name: c.state for c in manager.list_hardware_components()} == step["hardware"], where
        assert _claimed(manager) == sorted(step["claimed"]), where
        interfaces = manager.list_hardware_interfaces().command_interfaces
        assert sorted(i.name for i in interfaces if i.is_available) == sorted(step["available"]), where
