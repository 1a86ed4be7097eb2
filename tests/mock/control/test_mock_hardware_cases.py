"""Every recorded case of mock_components/GenericSystem is repeated: values in each cycle, states, claims."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from cellc.mock.control import ControllerManager
from tests.oracles import Case, read_yaml, recorded_cases

from .arm_of_two import MS, S

_START_NS = 2 * S


def _yaml_text(case: Case) -> str:
    lines = ["controller_manager:", "  ros__parameters:"]
    lines += [f"    {name}: {str(value).lower()}" for name, value in case["manager"].items()]
    lines.append("    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}")
    lines += [f"    {name}: {{type: {controller['type']}}}" for name, controller in case["controllers"].items()]
    for name, controller in case["controllers"].items():
        lines += [f"{name}:", "  ros__parameters:"]
        for key, value in controller.items():
            text = f"[{', '.join(value)}]" if isinstance(value, list) else value
            lines += [] if key == "type" else [f"    {key}: {text}"]
    return "\n".join(lines)


def _advance(manager: ControllerManager, until_ns: int) -> None:
    while manager.advance(until_ns) < until_ns:
        manager.take_events()


def _check_before(manager: ControllerManager, observed: Case) -> None:
    for name, value in observed.get("values_before_controllers", {}).items():
        assert manager.state(name) == pytest.approx(value, abs=1e-5, nan_ok=True), name
    for kind in ("command", "state"):
        found = getattr(manager.list_hardware_interfaces(), f"{kind}_interfaces")
        expected = observed.get("interfaces_before_activation", {}).get(kind)
        if expected is not None:
            assert [(i.name, i.is_available, i.is_claimed) for i in found] == [
                (entry["name"], entry["available"], entry["claimed"]) for entry in expected
            ]


class _Replay:
    """One case while it is repeated; cycles keep the recorded phase."""

    def __init__(self, case: Case, manager: ControllerManager) -> None:
        self.case = case
        self.manager = manager
        rows = case["observed"].get("samples", {}).get("rows", [])
        phases = sorted(round(row[0] * 1000) % 10 for row in rows[:20])
        phase = phases[len(phases) // 2] if phases else 0
        self.t0_ns = _START_NS - phase * MS
        self.steps = sorted(
            ((round(command["at"] * S), command) for command in case["commands"]), key=lambda step: step[0]
        )

    def advance(self, time_s: float) -> None:
        """Send what is due before a time and run up to it."""
        stamp = round(time_s * S)
        while self.steps and self.steps[0][0] < stamp:
            at_ns, command = self.steps.pop(0)
            # A message takes about a millisecond: one sent at the time of a cycle is seen by the next.
            _advance(self.manager, self.t0_ns + at_ns + MS)
            self.send(command)
        _advance(self.manager, max(self.t0_ns + stamp + MS // 2, self.manager.now_ns))

    def send(self, command: Case) -> None:
        """Send one command or change of the component's state."""
        if "hw" in command:
            answer = self.manager.set_hardware_component_state("arm_hw", command["hw"])
            assert (answer.ok, answer.state) == (command["answer"]["ok"], command["answer"]["state"])
            return
        self.manager.publish_commands(command["controller"], [float(value) for value in command["data"]])


def _check_samples(replay: _Replay, observed: Case) -> None:
    table = observed.get("samples")
    if not table:
        return
    names = table["columns"][1:]
    # A component of half the rate reads in one of two cycles; which of them is not known.
    reach = 2 if any(0 < c.rw_rate < 100 for c in replay.manager.list_hardware_components()) else 1
    found: list[list[float]] = []
    for row in table["rows"]:
        replay.advance(row[0])
        found.append([replay.manager.state(name) for name in names])
    wrong = [
        (row, values)
        for index, (row, values) in enumerate(zip(table["rows"], found, strict=True))
        if not any(_agrees(row, found[i]) for i in range(max(index - reach, 0), min(index + reach + 1, len(found))))
    ]
    assert not wrong, wrong[:3]


def _agrees(row: list[object], values: list[float]) -> bool:
    """Equal but for the measured period, which was 1 ms off at most; differences over it scale with it."""
    for recorded, value in zip(row[1:], values, strict=True):
        wanted = float(str(recorded))
        if math.isnan(wanted) != math.isnan(value) or abs(value - wanted) > 2e-3 + 5e-3 * abs(wanted):
            return False
    return True


@pytest.mark.parametrize("path", recorded_cases("mock_hardware", "cases/*.yaml"))
def test_mock_hardware_does_as_recorded(path: Path) -> None:
    case = read_yaml(path)
    observed = case["observed"]
    manager = ControllerManager((path.parent / case["urdf_file"]).read_text(), _yaml_text(case))
    components = [{"name": c.name, "state": c.state} for c in manager.list_hardware_components()]
    assert components == observed["hardware"]
    manager.spawn(["joint_state_broadcaster"])
    manager.spawn(list(case["controllers"]), inactive=True)
    _advance(manager, S // 2)
    _check_before(manager, observed)
    for name, expected in observed.get("activation", {}).items():
        answer = manager.switch_controllers([name], [])
        assert (answer.ok, answer.message) == (expected["ok"], expected["message"])
        _advance(manager, manager.now_ns + 50 * MS)
    replay = _Replay(case, manager)
    _check_samples(replay, observed)
    states = {c.name: c for c in manager.list_controllers()}
    for name, expected in observed.get("controllers_after", {}).items():
        assert states[name].state == expected["state"], name
        assert sorted(states[name].claimed_interfaces) == expected["claimed"], name
    for line in observed["log"]:
        assert any(line.split("(throttled")[0][:60] in text for text in manager.log.texts()), line
