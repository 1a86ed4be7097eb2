"""What the controller manager was seen to do where no recorded case stands beside it (OBSERVED.md, tables 1 and 2)."""

from __future__ import annotations

import pytest

from cellc.mock.control import ControllerManager, ManagerAbortedError, Strictness

from .bench import Value, bench, parameters, urdf, wait


def _manager(manager: dict[str, object] | None = None, description: str = "", **arm: Value) -> ControllerManager:
    return ControllerManager(description or urdf(), parameters(arm, manager=manager))


@pytest.mark.parametrize("rate", [0, 100.0])
def test_refused_update_rate_ends_the_process(rate: float) -> None:
    with pytest.raises(ManagerAbortedError):
        _manager({"update_rate": rate})


def test_joints_that_are_an_empty_list_are_refused_in_other_words_than_none() -> None:
    empty = _manager(joints=[]).spawn(["arm"])
    assert (empty.ok, empty.reason.endswith("No parameter value set")) == (False, True)


@pytest.mark.parametrize(
    ("wanted", "runs_at"),
    [(1000, 500), (30, 29), (200, 166), (250, 250), (400, 500)],  # 500 / round(500 / wanted), a half goes up
)
def test_rate_of_a_controller_is_what_divides_that_of_its_manager(wanted: int, runs_at: int) -> None:
    manager = _manager(update_rate=wanted)
    assert manager.spawn(["arm"]).ok
    warnings = [line.text for line in manager.log.lines() if line.level == "WARN"]
    if wanted == runs_at:
        assert not warnings
    elif wanted > 500:
        assert "should be less than or equal to" in warnings[0]
    else:
        assert f"closest achievable frequency '{runs_at}' Hz" in warnings[0]


def test_unknown_component_in_the_initial_states_is_a_warning() -> None:
    manager = _manager({"hardware_components_initial_state": {"inactive": ["nobody"]}})
    assert {component.state for component in manager.list_hardware_components()} == {"active"}
    assert manager.spawn(["arm"]).ok
    assert any("nobody" in line.text for line in manager.log.lines() if line.level == "WARN")


def test_component_that_is_inactive_at_first_offers_interfaces_and_refuses_controllers() -> None:
    manager = _manager({"hardware_components_initial_state": {"inactive": ["arm_hw"]}})
    offered = {
        interface.name: interface.is_available for interface in manager.list_hardware_interfaces().command_interfaces
    }
    assert offered["a/position"]
    assert not manager.spawn(["arm"]).ok


@pytest.mark.parametrize("kind", ["sensor", "actuator"])
def test_generic_system_of_another_kind_brings_no_hardware(kind: str) -> None:
    described = urdf().replace('name="arm_hw" type="system"', f'name="arm_hw" type="{kind}"')
    assert _manager(description=described).list_hardware_components() == ()


@pytest.mark.parametrize(("strictness", "ok"), [(Strictness.STRICT, False), (Strictness.BEST_EFFORT, True)])
def test_activating_what_is_active(strictness: Strictness, ok: bool) -> None:
    assert bench().switch_controllers(["arm"], [], strictness).ok is ok


@pytest.mark.parametrize("strictness", list(Strictness))
def test_unknown_name_to_deactivate_fails_in_every_mode(strictness: Strictness) -> None:
    manager = bench(up=("joints",))
    manager.spawn(["arm"], inactive=True)
    assert not manager.switch_controllers(["arm"], ["nobody"], strictness).ok
    wait(manager, 0.1)
    assert {entry.name: entry.state for entry in manager.list_controllers()}["arm"] == "inactive"


@pytest.mark.parametrize("strictness", list(Strictness))
def test_same_name_twice_conflicts_with_itself(strictness: Strictness) -> None:
    assert not bench().switch_controllers(["arm", "arm"], ["arm"], strictness).ok


@pytest.mark.parametrize("value", ["True", "TRUE", " true ", "false", "False"])
def test_words_that_are_a_bool(value: str) -> None:
    manager = _manager(description=urdf().replace(">true<", f">{value}<"))
    assert [component.state for component in manager.list_hardware_components()] == ["active", "active"]


@pytest.mark.parametrize("value", ["1", "yes", "0", ""])
def test_words_that_are_no_bool(value: str) -> None:
    assert _manager(description=urdf().replace(">true<", f">{value}<")).list_hardware_components() == ()


@pytest.mark.parametrize("other", ["velocity", "effort"])
def test_dynamics_refuse_a_second_command_of_a_joint_and_a_force_alone(other: str) -> None:
    both = urdf().replace(
        '<command_interface name="position"/>',
        f'<command_interface name="position"/><command_interface name="{other}"/>',
    )
    claimed = ["position", "velocity"] if other == "velocity" else ["effort"]
    gains: dict[str, Value] = {} if other == "velocity" else {"gains.a.p": 1.0, "gains.b.p": 1.0}
    manager = ControllerManager(both, parameters({"command_interfaces": claimed} | gains))
    answer = manager.spawn(["arm"])
    assert (answer.ok, "prepare command mode switch was rejected" in answer.reason) == (False, True)
