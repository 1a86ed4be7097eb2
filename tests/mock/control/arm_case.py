"""Repeats one recorded case of the joint trajectory controller: same cell, same requests, same phase in the cycle."""

from __future__ import annotations

import copy
import itertools
import re
from typing import Any

from cellc.mock.control import (
    CancelResponse,
    ControlEvent,
    ControllerManager,
    GoalResponse,
    HardwareStateResponse,
    JointTolerance,
    ParameterResponse,
    Recording,
    ServiceResponse,
    Trajectory,
    TrajectoryGoal,
    TrajectoryPoint,
    TrajectoryStateResponse,
)
from tests.oracles import RECORDED, Case, read_yaml

from .arm_of_two import MS, S

Answer = (
    CancelResponse | HardwareStateResponse | ParameterResponse | ServiceResponse | TrajectoryStateResponse | str | None
)
_PERIOD_NS = 10 * MS
# Time of the recorded T0 in the repeated case, apart from its phase in the cycle.
_START_NS = 1002 * S


def _merge(base: Case, changes: Case) -> Case:
    merged = copy.deepcopy(base)
    for key, value in changes.items():
        if value is None:
            merged.pop(key, None)
        elif isinstance(value, dict) and isinstance(merged.get(key), dict):
            merged[key] = _merge(merged[key], value)
        else:
            merged[key] = value
    return merged


def _yaml_text(case: Case) -> str:
    base = read_yaml(RECORDED / "joint_trajectory" / "base_controllers.yaml")
    arm = _merge(base["arm_controller"]["ros__parameters"], case["parameters"]["arm_controller_differs_from_base"])
    base["arm_controller"]["ros__parameters"] = arm
    base["controller_manager"]["ros__parameters"].update(case["parameters"].get("controller_manager", {}))
    return _dump(base)


def _dump(value: object) -> str:
    """Flow-style YAML that keeps integers and floats apart."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_dump(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_dump(item) for item in value) + "]"
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)


def _urdf_text(case: Case) -> str:
    text = (RECORDED / "joint_trajectory" / "base_cell.urdf").read_text()
    parameters = case["hardware"]["mock_parameters"]
    lines = "".join(f'<param name="{name}">{value}</param>' for name, value in parameters.items())
    text = text.replace('<param name="calculate_dynamics">true</param>', lines)
    changes = case["hardware"]["urdf_differs_from_base"]
    if "cmd" in changes:
        commands = "".join(f'<command_interface name="{kind}"/>' for kind in changes["cmd"])
        text = text.replace('<command_interface name="position"/>', commands)
    if "acceleration" in changes.get("state", []):
        velocity = '<state_interface name="velocity"></state_interface>'
        text = text.replace(velocity, velocity + '<state_interface name="acceleration"/>')
    if "init" in changes:
        values = iter(changes["init"])
        text = re.sub(r'(name="initial_value">)[^<]*', lambda match: f"{match[1]}{next(values)}", text)
    if "jtype" in changes.get("j1", {}):
        text = text.replace('name="joint1" type="revolute"', f'name="joint1" type="{changes["j1"]["jtype"]}"', 1)
    return text


def _stamp(sent: Case, now_ns: int) -> int:
    if "stamp" not in sent:
        return 0
    return int(sent.get("stamp_ns", now_ns + round(float(sent["stamp"].removeprefix("now") or 0.0) * S)))


def _points(sent: Case) -> tuple[TrajectoryPoint, ...]:
    kinds = ("positions", "velocities", "accelerations", "effort")
    return tuple(
        TrajectoryPoint(
            **{kind: tuple(float(value) for value in point.get(kind, [])) for kind in kinds},
            time_from_start_ns=round(point["time_from_start"] * S),
        )
        for point in sent["points"]
    )


def _tolerances(sent: list[Case]) -> tuple[JointTolerance, ...]:
    return tuple(JointTolerance(t["name"], t["position"], t["velocity"], t["acceleration"]) for t in sent)


class ArmCase:
    """One case while it is repeated.

    Args:
        case: the recorded case.
    """

    def __init__(self, case: Case) -> None:
        self.case = case
        self.manager = ControllerManager(_urdf_text(case), _yaml_text(case), start_ns=1000 * S)
        self.goals: dict[str, GoalResponse] = {}
        self.sent_ns: dict[str, int] = {}
        self.answers: dict[int, Answer] = {}
        self.events: list[ControlEvent] = []
        inactive = not case.get("arm_controller_active_at_start", True)
        self.manager.spawn(["joint_state_broadcaster"])
        self.manager.spawn(["arm_controller"], inactive=inactive)
        self.manager.spawn(["forward_position_controller"], inactive=True)
        self.manager.record("arm_controller", 1000.0)
        self.manager.subscribe_joint_states("joint_state_broadcaster")
        taken = self._taken(0.0)
        self.t0_ns = _START_NS - round((self._phase_s() if taken is None else taken[0]) * S)

    def _rows(self) -> list[list[float]]:
        rows: list[list[float]] = self.case["observed"].get("samples", {}).get("rows", [])
        return rows

    def _phase_s(self) -> float:
        """Time from T0 to a cycle, as recorded: the samples carry the times of the cycles."""
        phases = sorted(round(row[0] * 1000) % 10 for row in self._rows()[:20])
        return (phases[len(phases) // 2] if phases else 5) / 1000

    def _taken(self, at_s: float) -> tuple[float, float] | None:
        """Time of the cycle that took over what was sent at a time, and the trajectory time in it.

        The cycle may lie before the recorded time, which is when the answer had come back to the client.
        """
        for before, row in itertools.pairwise(self._rows()):
            jump_s = (row[1] - before[1]) - (row[0] - before[0])
            if -0.012 < row[0] - at_s < 0.0125 and abs(jump_s) > 0.005:
                return row[0], row[1]
        return None

    def run(self) -> None:
        """Send everything at its time, then wait."""
        steps = [(kind, fields) for step in self.case["sent"] for kind, fields in step.items()]
        origin = next((fields["at"] for kind, fields in steps if kind in ("goal", "topic")), 0)
        for index, (kind, fields) in enumerate(steps):
            at_s = self._time_of(index, fields) - origin
            taken = self._taken(at_s) if kind in ("goal", "topic", "cancel") else None
            if taken is not None:
                at_s = taken[0] - 0.0005
            self._advance(self.t0_ns + round(at_s * S))
            if fields.get("stamp") and taken is not None:
                # The client took the stamp a while before it sent it.
                fields = {**fields, "stamp_ns": self.t0_ns + round((taken[0] - taken[1]) * S)}
            self.answers[index] = self._send(kind, fields)
        self._advance(self.manager.now_ns + 4 * S)

    def _time_of(self, index: int, fields: Case) -> float:
        """When a step was really sent: some were recorded as late."""
        for response in self.case["observed"].get("responses", []):
            if response["step"] == index and "published_at" in response["response"]:
                return float(response["response"]["published_at"])
        return float(fields["at"])

    def _advance(self, until_ns: int) -> None:
        until_ns = max(until_ns, self.manager.now_ns)
        while self.manager.advance(until_ns) < until_ns:
            self.events.extend(self.manager.take_events())
        self.events.extend(self.manager.take_events())

    def _send(self, kind: str, fields: Case) -> Answer:
        manager, arm = self.manager, "arm_controller"
        if kind == "goal":
            self.sent_ns[fields["id"]] = manager.now_ns
            self.goals[fields["id"]] = manager.send_goal(arm, self._goal(fields), feedback=True)
        elif kind == "topic":
            trajectory = Trajectory(tuple(fields["joints"]), _points(fields), _stamp(fields, manager.now_ns))
            return manager.publish_trajectory(arm, trajectory)
        elif kind == "cancel":
            return manager.cancel_goal(self.goals[fields["id"]].goal_id)
        elif kind == "cancel_all":
            return manager.cancel_all(arm)
        elif kind == "switch":
            return manager.switch_controllers(fields.get("activate", []), fields.get("deactivate", []))
        elif kind == "hw":
            return manager.set_hardware_component_state("arm_hw", fields["state"])
        elif kind == "scale":
            manager.publish_speed_scaling(arm, fields["factor"])
        elif kind == "param":
            return manager.set_parameter(arm, fields["name"], fields["value"])
        elif kind == "query":
            return manager.query_state(arm, manager.now_ns + round(fields["time"] * S))
        elif kind == "fwd":
            manager.publish_commands("forward_position_controller", fields["data"])
        return None

    def _goal(self, fields: Case) -> TrajectoryGoal:
        return TrajectoryGoal(
            tuple(fields["joints"]),
            _points(fields),
            _stamp(fields, self.manager.now_ns),
            _tolerances(fields.get("path_tolerance", [])),
            _tolerances(fields.get("goal_tolerance", [])),
            round(fields.get("goal_time_tolerance", 0.0) * S),
        )

    def recording(self) -> Recording:
        """The states of the controller over the whole case."""
        return self.manager.recording("arm_controller")


def rows_near(table: Case, columns: list[str]) -> list[tuple[float, list[Any]]]:
    """Time and chosen columns of a recorded table."""
    places = [table["columns"].index(column) for column in columns]
    return [(row[0], [row[place] for place in places]) for row in table["rows"]]
