"""The services of the controller manager, as a client on the graph finds them while the cell runs."""

from __future__ import annotations

import json
from typing import Any

import pytest

from cellc.mock import MockCell
from cellc.mock.errors import MockError
from tests.mock.ros.task_stand_in import TaskGraph, run

_MANAGER = "/controller_manager"


class _Asking(TaskGraph):
    """Calls one service after the other, each once the one before is answered, while the node works."""

    def __init__(self, *calls: tuple[str, dict[str, Any]]) -> None:
        super().__init__()
        self.answers: list[Any] = []
        self.states_when_answered: list[dict[str, str]] = []
        self._calls = list(calls)
        self._called: int | None = None

    def settle(self, node: str, within_s: float) -> str:
        if self.actions and self._called is None and self._calls:
            service, request = self._calls.pop(0)
            self._called = self.say(self.services[f"{_MANAGER}/{service}"], {"request": request})
        return super().settle(node, within_s)

    def answer(self, number: int, value: Any) -> None:
        if number == self._called:
            self.answers.append(json.loads(json.dumps(value)))
            listed = self.bound.control.managers["control"].list_controllers()
            self.states_when_answered.append({each.name: each.state for each in listed})
            self._called = None
        else:
            super().answer(number, value)


def _asked(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, *calls: tuple[str, dict[str, Any]]
) -> tuple[_Asking, list[Any]]:
    graph = _Asking(*calls)
    run(cell, monkeypatch, "gripper_activated", graph=graph)
    assert len(graph.answers) == len(calls)
    return graph, graph.answers


def _states(listed: Any) -> dict[str, str]:
    return {each["name"]: each["state"] for each in listed["controller"]}


def test_controllers_hardware_and_interfaces_are_listed(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    _, (listed, components, interfaces, types) = _asked(
        cell,
        monkeypatch,
        ("list_controllers", {}),
        ("list_hardware_components", {}),
        ("list_hardware_interfaces", {}),
        ("list_controller_types", {}),
    )
    states = _states(listed)
    assert (states["arm_trajectory"], states["gripper_action"]) == ("active", "active")
    (arm,) = (each for each in listed["controller"] if each["name"] == "arm_trajectory")
    assert arm["type"] == "ur_controllers/ScaledJointTrajectoryController"
    assert "arm_elbow_joint/position" in arm["claimed_interfaces"]
    known = {each["name"]: each["state"] for each in components["component"]}
    assert known["arm_hardware"] == {"id": 3, "label": "active"}  # of lifecycle_msgs/msg/State
    (elbow,) = (each for each in interfaces["command_interfaces"] if each["name"] == "arm_elbow_joint/position")
    assert elbow == {
        "name": "arm_elbow_joint/position",
        "data_type": "double",
        "is_available": True,
        "is_claimed": True,
    }
    bases = dict(zip(types["types"], types["base_classes"], strict=True))
    assert bases["joint_state_broadcaster/JointStateBroadcaster"] == "controller_interface::ControllerInterface"


def test_controllers_and_hardware_change_as_asked(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    named = {"name": "arm_speed"}
    off = {"activate_controllers": [], "deactivate_controllers": ["arm_speed"], "strictness": 2}
    stop = {"name": "arm_hardware", "target_state": {"id": 2, "label": ""}}
    graph, answers = _asked(
        cell,
        monkeypatch,
        ("switch_controller", off),
        ("unload_controller", named),
        ("list_controllers", {}),
        ("load_controller", named),
        ("configure_controller", named),
        ("list_controllers", {}),
        ("set_hardware_component_state", stop),
        ("list_hardware_components", {}),
    )
    switched, unloaded, without, loaded, configured, again, stopped, components = answers
    assert graph.states_when_answered[0]["arm_speed"] == "inactive"  # the answer comes when it is done
    assert all(each["ok"] for each in (switched, unloaded, loaded, configured))
    assert "arm_speed" not in _states(without)
    assert _states(again)["arm_speed"] == "inactive"
    assert stopped == {"ok": True, "state": {"id": 2, "label": "inactive"}}
    (arm,) = (each for each in components["component"] if each["name"] == "arm_hardware")
    assert arm["state"]["label"] == "inactive"


def test_what_the_manager_refuses_is_answered(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    graph, answers = _asked(
        cell,
        monkeypatch,
        ("load_controller", {"name": "nobody"}),
        ("configure_controller", {"name": "nobody"}),
        ("unload_controller", {"name": "arm_trajectory"}),  # it is active
        ("switch_controller", {"activate_controllers": ["nobody"], "strictness": 2}),
        ("switch_controller", {"activate_controllers": ["nobody"], "strictness": 77}),
        ("switch_controller", {"strictness": "?"}),
        ("set_hardware_component_state", {"name": "nobody", "target_state": {"id": 3, "label": "active"}}),
        ("set_hardware_component_state", {"name": "arm_hardware", "target_state": {"id": 77, "label": ""}}),
    )
    assert [each["ok"] for each in answers] == [False] * 8
    assert graph.states_when_answered[0] == graph.states_when_answered[-1]


class _Without(TaskGraph):
    """An environment without the messages of the controller manager."""

    def open_service(self, channel: int, node: str, service: str, kind: str) -> None:
        if kind.startswith("controller_manager_msgs/"):
            raise MockError("", f"`{service}` of type `{kind}` cannot be offered: No module")
        super().open_service(channel, node, service, kind)


def test_an_environment_without_their_messages_is_told(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    judged = run(cell, monkeypatch, "gripper_activated", graph=_Without())
    assert judged.result.passed
    assert judged.notes == (
        "`/controller_manager/list_controllers` of type `controller_manager_msgs/srv/ListControllers` cannot be "
        "offered: No module",
    )
