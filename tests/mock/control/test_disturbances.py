"""Faults that are switched on from outside have the effect that they are named after."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.contract.vocabulary import Behavior, Distro
from cellc.mock.control import (
    ControllerChanged,
    ControllerManager,
    GripperEnded,
    GripperGoal,
    HardwareChanged,
    JointFault,
    ManagerAbortedError,
    TrajectoryEnded,
    TrajectoryGoal,
    TrajectoryPoint,
)

from .arm_of_two import MS, S, parameters, run, started, urdf

_GOAL = TrajectoryGoal(("a", "b"), (TrajectoryPoint((0.5, -0.4), time_from_start_ns=S),))


def _arm() -> ControllerManager:
    return started(ControllerManager(urdf(), parameters()))


def _results(manager: ControllerManager, duration_ns: int = 3 * S) -> list[tuple[int, int]]:
    events = run(manager, duration_ns)
    return [(int(event.status), event.error_code) for event in events if isinstance(event, TrajectoryEnded)]


def test_healthy_arm_reaches_its_goal() -> None:
    manager = _arm()
    manager.send_goal("arm", _GOAL)
    assert _results(manager) == [(4, 0)]
    assert manager.joint_positions() == pytest.approx({"a": 0.5, "b": -0.4, "f": 0.0})


def test_stuck_joint_violates_the_path_tolerance() -> None:
    manager = _arm()
    manager.disturbances.disturb("b", JointFault(stuck=True))
    manager.send_goal("arm", _GOAL)
    assert _results(manager) == [(6, -4)]
    assert manager.state("b/position") == 0.0


def test_slow_joint_never_exceeds_its_velocity() -> None:
    manager = _arm()
    manager.subscribe_joint_states("joints")
    manager.disturbances.disturb("a", JointFault(max_velocity=0.45))
    manager.send_goal("arm", _GOAL)
    assert _results(manager) == [(4, 0)]
    (block,) = manager.take_joint_states("joints")
    assert np.abs(block.velocities[:, block.names.index("a")]).max() == pytest.approx(0.45)


def test_lagging_joint_follows_with_its_time_constant() -> None:
    manager = _arm()
    manager.disturbances.disturb("a", JointFault(time_constant_s=0.1))
    manager.send_goal("arm", _GOAL)
    run(manager, S - 10 * MS)
    # A first-order lag follows a ramp of 0.5 rad/s with a delay of one time constant: 0.05 rad behind.
    assert 0.5 * 0.99 - manager.state("a/position") == pytest.approx(0.05, abs=0.002)


def test_of_two_faults_of_a_joint_each_ends_by_itself() -> None:
    manager = _arm()
    slow, beside = JointFault(max_velocity=0.45), JointFault(offset=0.002)
    for fault in (slow, beside):
        manager.disturbances.disturb("a", fault)
    manager.disturbances.restore("a", slow)
    manager.send_goal("arm", _GOAL)
    run(manager, S + 100 * MS)
    assert manager.state("a/position") == pytest.approx(0.502)
    manager.disturbances.restore("a", beside)
    run(manager, 10 * MS)
    assert manager.state("a/position") == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("by_nature", "fault", "together"),
    [
        (JointFault(max_velocity=0.2), JointFault(max_velocity=0.5), JointFault(max_velocity=0.2)),
        (JointFault(lower=-0.1, upper=0.3), JointFault(upper=0.2), JointFault(lower=-0.1, upper=0.2)),
        (JointFault(offset=0.1), JointFault(offset=0.2, stuck=True), JointFault(offset=0.1 + 0.2, stuck=True)),
    ],
)
def test_no_fault_makes_a_joint_better_than_it_is(
    by_nature: JointFault, fault: JointFault, together: JointFault
) -> None:
    assert by_nature & fault == together
    assert fault & by_nature == together


def test_object_between_the_fingers_stalls_the_gripper() -> None:
    manager = _arm()
    manager.disturbances.disturb("f", JointFault(upper=0.021))
    manager.send_goal("hand", GripperGoal((0.04,)))
    (ended,) = [event for event in run(manager, S) if isinstance(event, GripperEnded)]
    assert (int(ended.status), ended.stalled, ended.reached_goal) == (4, True, False)
    assert ended.position == (0.021,)


@pytest.mark.parametrize("kind", ["read", "write"])
def test_hardware_error_finalizes_the_component_and_stops_its_controllers(kind: str) -> None:
    manager = _arm()
    manager.send_goal("arm", _GOAL)
    run(manager, 300 * MS)
    getattr(manager.disturbances, f"fail_{kind}")("arm_hw")
    events = run(manager, S)
    assert [event.state for event in events if isinstance(event, HardwareChanged)] == ["finalized"]
    stopped = {event.controller for event in events if isinstance(event, ControllerChanged)}
    assert "arm" in stopped
    assert "hand" not in stopped
    assert [(int(e.status), e.error_code) for e in events if isinstance(e, TrajectoryEnded)] == [(6, -1)]
    assert not manager.set_hardware_component_state("arm_hw", "active").ok


def test_missed_cycles_let_the_trajectory_jump_on_in_time() -> None:
    manager = _arm()
    manager.record("arm", 500.0)
    manager.send_goal("arm", _GOAL)
    run(manager, 300 * MS)
    manager.disturbances.skip_cycles(20)
    run(manager, 300 * MS)
    stamps = manager.recording("arm").stamps_ns
    assert int(np.diff(stamps).max()) == 21 * manager.period_ns
    assert manager.state("a/position") == pytest.approx(0.3, abs=0.003)


def test_protective_stop_freezes_the_joints_until_it_is_released() -> None:
    manager = _arm()
    manager.send_goal("arm", _GOAL)
    run(manager, 300 * MS)
    manager.disturbances.protective_stop("arm_hw")
    stopped_at = manager.state("a/position")
    assert _results(manager) == [(6, -4)]
    assert manager.state("a/position") == stopped_at
    assert not manager.switch_controllers(["forward"], []).ok
    manager.disturbances.release("arm_hw")
    manager.send_goal("arm", _GOAL)
    assert _results(manager) == [(4, 0)]


def test_fallback_controller_takes_over_when_an_update_fails() -> None:
    text = parameters(extra=", fallback_controllers: [forward]")
    outside = '<state_interface name="position"><param name="initial_value">9.0</param></state_interface>'
    manager = ControllerManager(urdf().replace('<state_interface name="position"/>', outside, 1), text)
    assert manager.spawn(["forward"], inactive=True).ok
    assert manager.spawn(["arm"]).ok
    run(manager, 100 * MS)
    assert {c.name: c.state for c in manager.list_controllers()} == {"forward": "active", "arm": "inactive"}


def test_older_gripper_controller_exists_only_where_its_package_does() -> None:
    text = parameters("position_controllers/GripperActionController")
    old = ControllerManager(urdf(), text, distro=Distro.JAZZY)
    assert old.spawn(["hand"]).ok
    assert ControllerManager(urdf(), text, distro=Distro.KILTED).spawn(["hand"]).reason.endswith("not found.")


def test_type_that_the_caller_names_behaves_as_told() -> None:
    text = parameters().replace("joint_trajectory_controller/JointTrajectoryController", "vendor/Scaled")
    assert not ControllerManager(urdf(), text).spawn(["arm"]).ok
    named = {"vendor/Scaled": Behavior.SCALED_JOINT_TRAJECTORY}
    manager = ControllerManager(urdf(), text, plugin_behaviors=named)
    answer = manager.spawn(["arm"])
    # The interface that the scaled controller wants does not exist in this cell.
    assert "speed_scaling/speed_scaling_factor" in answer.reason


def test_limits_are_not_enforced_by_default_before_kilted() -> None:
    manager = started(ControllerManager(urdf(), parameters(), distro=Distro.JAZZY))
    manager.spawn(["forward"], inactive=True)
    manager.switch_controllers(["forward"], ["arm"])
    run(manager, 10 * MS)
    manager.publish_commands("forward", [2.5, 0.0])
    run(manager, 6 * MS)
    assert manager.state("a/position") == 2.5


def test_document_type_in_the_description_is_refused() -> None:
    manager = ControllerManager('<!DOCTYPE r [<!ENTITY x "y">]>' + urdf(), parameters())
    assert not manager.list_hardware_components()
    assert "document type" in manager.description_error


def test_tab_in_the_parameter_file_ends_the_process() -> None:
    with pytest.raises(ManagerAbortedError):
        ControllerManager(urdf(), "controller_manager:\n\tros__parameters: {}")


def test_reference_keeps_the_velocity_of_a_last_point_that_has_one() -> None:
    text = parameters().replace(
        "command_interfaces", "allow_nonzero_velocity_at_trajectory_end: true\n    command_interfaces"
    )
    manager = started(ControllerManager(urdf(), text))
    manager.record("arm", 500.0)
    point = TrajectoryPoint((0.3, 0.2), (0.5, 0.0), time_from_start_ns=S)
    manager.send_goal("arm", TrajectoryGoal(("a", "b"), (point,)))
    assert _results(manager) == [(4, 0)]
    assert manager.recording("arm").desired_velocity[-1] == pytest.approx([0.5, 0.0])
    assert manager.joint_positions() == pytest.approx({"a": 0.3, "b": 0.2, "f": 0.0})


def test_infinite_position_is_accepted_moves_one_step_and_is_aborted() -> None:
    manager = _arm()
    goal = TrajectoryGoal(("a", "b"), (TrajectoryPoint((float("inf"), 0.2), time_from_start_ns=S),))
    assert manager.send_goal("arm", goal).accepted
    assert _results(manager) == [(6, -4)]
    assert manager.state("a/position") == pytest.approx(2.0 * 0.002)
