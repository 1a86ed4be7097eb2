"""What controllers do whose interfaces are not there yet, as ros2_control 5.16 was observed to answer.

A component that is not configured exports nothing. joint_state_broadcaster reads all that is there; without any its
activation ends in an error, which leaves it unconfigured. The other controllers of the request are switched.
"""

from __future__ import annotations

import json

from cellc.contract.vocabulary import Distro
from cellc.mock.control import ControllerChanged, ControllerManager

from .arm_of_two import S, run, urdf
from .bench import parameters


def _manager(*unconfigured: str, inactive: tuple[str, ...] = ()) -> ControllerManager:
    text = json.loads(parameters())
    states = {"unconfigured": list(unconfigured), "inactive": list(inactive)}
    told = {f"hardware_components_initial_state.{state}": names for state, names in states.items() if names}
    text["controller_manager"]["ros__parameters"] |= told
    manager = ControllerManager(urdf(), json.dumps(text), distro=Distro.KILTED, plugin_behaviors={}, start_ns=0)
    assert manager.spawn(["joints", "arm", "hand"], inactive=True).ok
    return manager


def _states(manager: ControllerManager) -> dict[str, str]:
    return {entry.name: entry.state for entry in manager.list_controllers()}


def _published(manager: ControllerManager) -> tuple[tuple[str, ...], ...]:
    """Return the joints of the messages since the last time, each set once."""
    manager.subscribe_joint_states("joints")
    run(manager, S // 10)
    blocks = manager.take_joint_states("joints")
    assert all(block.positions.shape == (len(block.stamps_ns), len(block.names)) for block in blocks)
    return tuple(block.names for block in blocks)


def test_broadcaster_without_any_interface_falls_to_unconfigured() -> None:
    manager = _manager("arm_hw", "hand_hw")
    answer = manager.switch_controllers(["joints"], [])
    events = run(manager, S // 10)
    assert (answer.ok, answer.message) == (False, "Failed to activate controller : joints")
    assert _states(manager) == {"joints": "unconfigured", "arm": "inactive", "hand": "inactive"}
    changed = [each for each in events if isinstance(each, ControllerChanged) and each.controller == "joints"][-1]
    assert changed.state == "unconfigured"
    assert "No state interfaces found to publish." in changed.reason
    assert any("Error initializing joint data" in line.text for line in manager.log.lines())
    again = manager.switch_controllers(["joints"], [])
    assert not again.ok
    assert "needs to be configured" in again.message


def test_broadcaster_publishes_what_was_there_as_it_was_activated() -> None:
    manager = _manager("hand_hw")
    assert manager.switch_controllers(["joints"], []).ok
    run(manager, S // 10)
    assert _published(manager) == (("a", "b"),)
    assert manager.set_hardware_component_state("hand_hw", "active").ok
    assert _published(manager) == (("a", "b"),)
    assert manager.switch_controllers(["joints"], ["joints"]).ok
    assert _published(manager) == (("a", "b"), ("a", "b", "f"))
    assert _published(manager) == (("a", "b", "f"),)


def test_component_that_is_inactive_exports_what_it_has() -> None:
    manager = _manager(inactive=("arm_hw", "hand_hw"))
    assert manager.switch_controllers(["joints"], []).ok
    run(manager, S // 10)
    assert _published(manager) == (("a", "b", "f"),)


def test_others_of_the_request_are_switched_all_the_same() -> None:
    manager = _manager("hand_hw")
    assert manager.set_hardware_component_state("arm_hw", "unconfigured").ok
    assert not manager.switch_controllers(["joints", "arm"], []).ok  # the arm's own interfaces are missing, too
    run(manager, S // 10)
    assert _states(manager) == {"joints": "inactive", "arm": "inactive", "hand": "inactive"}
