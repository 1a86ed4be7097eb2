"""Every recorded case of the parallel gripper action controller is repeated."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.mock.control import ControllerManager, GoalResponse, GripperEnded, GripperGoal
from tests.oracles import RECORDED, Case, read_yaml, recorded_cases

from .arm_of_two import MS, S

_START_NS = 2 * S
_NAME = "gripper_controller"


def _urdf_text(case: Case) -> str:
    text = (RECORDED / "controller_manager" / "cases" / "base" / "cell.urdf").read_text()
    parameters = "".join(f'<param name="{name}">{value}</param>' for name, value in case["hardware"].items())
    plain = "<hardware><plugin>mock_components/GenericSystem</plugin></hardware>"
    return text.replace(plain, plain.replace("</hardware>", f"{parameters}</hardware>"))


def _yaml_text(case: Case) -> str:
    changes = case["parameters"]["gripper_controller_differs_from_base"]
    own = "".join(f"    {name}: {str(value).lower()}\n" for name, value in changes.items())
    manager = "".join(
        f"    {name}: {str(value).lower()}\n" for name, value in case["parameters"]["controller_manager"].items()
    )
    return (
        "controller_manager:\n  ros__parameters:\n    update_rate: 100\n" + manager + "    joint_state_broadcaster: "
        "{type: joint_state_broadcaster/JointStateBroadcaster}\n    gripper_controller: "
        "{type: parallel_gripper_action_controller/GripperActionController}\n"
        "gripper_controller:\n  ros__parameters:\n    joint: finger_joint\n" + own
    )


class _Replay:
    """One case while it is repeated."""

    def __init__(self, case: Case) -> None:
        self.case = case
        self.manager = ControllerManager(_urdf_text(case), _yaml_text(case))
        self.goals: dict[str, GoalResponse] = {}
        self.ended: dict[int, GripperEnded] = {}
        self.manager.spawn(["joint_state_broadcaster"])
        self.manager.spawn([_NAME], inactive="action_server" in case["observed"])
        self.manager.subscribe_joint_states("joint_state_broadcaster")
        rows = case["observed"].get("joint_states", {}).get("rows", [])
        phases = sorted(round(row[0] * 1000) % 10 for row in rows[:20])
        self.t0_ns = _START_NS - max((phases[len(phases) // 2] if phases else 5) * MS, MS // 2)

    def run(self) -> None:
        """Send everything at its time, then wait."""
        for step in self.case["sent"]:
            ((kind, fields),) = step.items()
            self._advance(self.t0_ns + round(fields["at"] * S))
            if kind == "goal":
                goal = GripperGoal(tuple(float(value) for value in fields["position"]), (), (), tuple(fields["name"]))
                self.goals[fields["id"]] = self.manager.send_goal(_NAME, goal)
            else:
                answer = self.manager.cancel_goal(self.goals[fields["id"]].goal_id)
                expected = self.case["observed"]["responses"][0]
                assert answer.return_code == expected["return_code"]
                assert len(answer.goals_canceling) == expected["goals_canceling"]
        self._advance(self.manager.now_ns + 3 * S)

    def _advance(self, until_ns: int) -> None:
        while self.manager.advance(until_ns) < until_ns:
            self._collect()
        self._collect()

    def _collect(self) -> None:
        for event in self.manager.take_events():
            if isinstance(event, GripperEnded):
                self.ended[event.goal_id] = event


def _check_goals(replay: _Replay, observed: Case) -> None:
    for goal in observed["goals"]:
        response = replay.goals[goal["id"]]
        assert response.accepted is goal["accepted"]
        if not goal["accepted"]:
            continue
        result = replay.ended[response.goal_id]
        assert result.status == goal["status"]
        assert (result.stalled, result.reached_goal) == (goal["stalled"], goal["reached_goal"])
        # One cycle of motion at 0.2 m/s: the request's place inside the cycle is not known better.
        assert result.position == pytest.approx(tuple(goal["state"]["position"]), abs=0.0021)
        assert result.effort == pytest.approx(tuple(goal["state"]["effort"]))
        assert (result.stamp_ns - replay.t0_ns) / S == pytest.approx(goal["time_to_result"], abs=0.056)


def _check_motion(replay: _Replay, observed: Case) -> None:
    rows = observed.get("joint_states", {}).get("rows", [])
    (block,) = replay.manager.take_joint_states("joint_state_broadcaster")
    column = block.names.index("finger_joint")
    for time_s, position, velocity in rows:
        index = int(abs(block.stamps_ns - (replay.t0_ns + round(time_s * S))).argmin())
        near = range(max(index - 1, 0), min(index + 2, len(block.stamps_ns)))
        found = [(block.positions[i, column], block.velocities[i, column]) for i in near]
        assert any(abs(p - position) < 1e-4 and abs(v - velocity) < 2e-3 + 5e-3 * abs(v) for p, v in found), (
            time_s,
            position,
            found,
        )


@pytest.mark.parametrize("path", recorded_cases("gripper", "cases/*.yaml"))
def test_gripper_does_as_recorded(path: Path) -> None:
    case = read_yaml(path)
    observed = case["observed"]
    replay = _Replay(case)
    replay.run()
    _check_goals(replay, observed)
    _check_motion(replay, observed)
    states = {c.name: c for c in replay.manager.list_controllers()}
    for name, expected in observed["controllers_after"].items():
        assert states[name].state == expected["state"], name
        assert sorted(states[name].claimed_interfaces) == expected["claimed"], name
    for line in observed["log"]:
        assert any(line.split("(throttled")[0][:60] in text for text in replay.manager.log.texts()), line
