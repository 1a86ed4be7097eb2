"""Every recorded start of the real controller manager is repeated with the same URDF and parameter file."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.mock.control import (
    ControllerManager,
    GripperEnded,
    GripperGoal,
    ManagerAbortedError,
    TrajectoryEnded,
    TrajectoryGoal,
    TrajectoryPoint,
)
from tests.oracles import Case, read_yaml, recorded_cases

from .arm_of_two import MS, S


def _start(folder: Path, observed: Case) -> ControllerManager:
    flags = observed["flags"]
    text = (folder / "controllers.yaml").read_text()
    manager = ControllerManager(
        (folder / "cell.urdf").read_text(),
        text if flags["yaml_to_manager"] else "",
        namespace=flags["namespace"],
    )
    answer = manager.spawn(flags["spawned"], parameters=text if flags["yaml_to_spawner"] else None)
    if observed.get("spawner_ok") is not None and observed["hardware"]:
        assert answer.ok is observed["spawner_ok"]
    if flags["spawned_inactive"]:
        manager.spawn(flags["spawned_inactive"], inactive=True)
    # The real states were read a second or more after the spawners.
    _run(manager, 2 * S)
    return manager


def _run(manager: ControllerManager, until_ns: int) -> list[object]:
    events: list[object] = []
    while manager.advance(until_ns) < until_ns:
        events.extend(manager.take_events())
    events.extend(manager.take_events())
    return events


def _check_states(manager: ControllerManager, observed: Case) -> None:
    components = {c.name: c.state for c in manager.list_hardware_components()}
    assert components == {entry["name"]: entry["state"] for entry in observed["hardware"]}
    loaded = {c.name: c for c in manager.list_controllers()}
    for name, expected in observed["controllers"].items():
        assert (name in loaded) is expected["loaded"], name
        if name in loaded:
            assert (loaded[name].state in ("inactive", "active")) is expected["configured"], name
            assert (loaded[name].state == "active") is expected["active"], name
            assert sorted(loaded[name].claimed_interfaces) == expected["claimed"], name
            assert loaded[name].update_rate == expected.get("update_rate", loaded[name].update_rate)


def _check_interfaces(manager: ControllerManager, observed: Case) -> None:
    interfaces = manager.list_hardware_interfaces()
    if "command_interfaces" in observed:
        found = {i.name: {"available": i.is_available, "claimed": i.is_claimed} for i in interfaces.command_interfaces}
        assert found == observed["command_interfaces"]
    if "state_interfaces" in observed:
        assert [i.name for i in interfaces.state_interfaces] == observed["state_interfaces"]
    for name, position in observed.get("joint_states_before_goals", {}).items():
        assert manager.state(f"{name}/position") == pytest.approx(position, abs=1e-6)


def _check_goal(manager: ControllerManager, goal: Case) -> None:
    if "reached_goal" in goal:
        manager.send_goal(goal["controller"], GripperGoal((goal["sent"]["position"],)))
    else:
        names = tuple(goal["sent"])
        point = TrajectoryPoint(tuple(goal["sent"].values()), time_from_start_ns=round(goal["seconds"] * S))
        manager.send_goal(goal["controller"], TrajectoryGoal(names, (point,)))
    (ended,) = [e for e in _run(manager, manager.now_ns + 3 * S) if isinstance(e, TrajectoryEnded | GripperEnded)]
    assert ended.status == goal["status"]
    if isinstance(ended, GripperEnded):
        assert (ended.stalled, ended.reached_goal) == (goal["stalled"], goal["reached_goal"])
        # The position is read in a cycle that is decided by the phase of the request: one cycle of motion.
        assert ended.position == pytest.approx(tuple(goal["position"]), abs=0.0021)
        return
    assert (ended.error_code, ended.error_string) == (goal["error_code"], goal["error_string"])
    for name, position in goal["joint_states_after"].items():
        assert manager.state(f"{name}/position") == pytest.approx(position, abs=0.021), name


def _without_decimals(text: str) -> str:
    """Errors in texts carry the jitter of the recording."""
    return re.sub(r"[0-9]+\.[0-9]{3,}", "N", text)


def _plain(text: str) -> str:
    """The start of a recorded line without its bracketed head and without what was cut off."""
    text = text.split("]: ", 1)[-1] if text.startswith("[") else text
    return text.split("...")[0].strip()[:100]


@pytest.mark.parametrize("path", recorded_cases("controller_manager", "cases/*/observed.yaml"))
def test_manager_answers_as_recorded(path: Path) -> None:
    observed = read_yaml(path)
    if not observed["manager_survives"]:
        with pytest.raises(ManagerAbortedError):
            _start(path.parent, observed)
        return
    manager = _start(path.parent, observed)
    _check_states(manager, observed)
    _check_interfaces(manager, observed)
    for goal in observed["goals"]:
        _check_goal(manager, goal)
        _run(manager, manager.now_ns + 500 * MS)
    written = _without_decimals("\n".join(manager.log.texts()))
    for message in observed["messages"]:
        if not message.startswith("[WARN] [io/out1]"):
            assert _without_decimals(_plain(message)[:60]) in written


@pytest.mark.parametrize(
    ("case", "reason"),
    [
        ("y_int_update_rate_float", "expected [integer] got [double]"),
        ("y_rate_zero", "cannot store a negative time point in rclcpp::Time"),
        ("y_noros", "Sequences can only be values and not keys in params. Error at line 14"),
    ],
)
def test_manager_that_aborts_says_why(case: str, reason: str) -> None:
    found = recorded_cases("controller_manager", f"cases/{case}/observed.yaml")[0]
    path = found.values[0]
    with pytest.raises(ManagerAbortedError) as aborted:
        _start(path.parent, read_yaml(path))
    assert reason in aborted.value.reason
