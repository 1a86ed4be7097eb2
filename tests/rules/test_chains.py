"""Every time and rate of the language is compared with what bounds it, or is free for a reason that is written here.

The table of inequalities is `cellc/compiler/rules/clocks/chains.py`; rules with figures of their own are beside it. A
key that is added without an entry fails, and so does an entry without a key. The figures of the rows are by hand.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest
from pydantic import BaseModel

from cellc.compiler.catalog.load import controller_kinds, device_names, load_controller_kind, load_device
from cellc.compiler.pages import all_codes
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.quantity import DURATION, FREQUENCY, QuantityType
from tests.cells import diagnose, spec_text, there, written

_JUDGED = {
    "ActionSpec.cancel_within": {"cancel-bound-not-kept", "kpi-beyond-contract"},
    "ActionSpec.timeout": {"timeout-below-inner", "timeout-below-motion", "max-age-beyond-timeout"},
    "AdapterSpec.command_timeout": {"watchdog-below-period"},
    "AdapterSpec.goal_time": {"timeout-below-inner"},
    "AdapterSpec.stop_time": {"cancel-bound-not-kept"},
    "CallbackSpec.period": {"callbacks-exceed-thread"},
    "CallbackSpec.takes": {"callbacks-exceed-thread", "age-budget-exceeded"},
    "ClockSpec.max_offset": {"host-offset-beyond-age"},
    "ControllerSpec.goal_time": {"timeout-below-inner"},
    "ControllerSpec.update_rate": {"controller-faster-than-manager", "uneven-update-rate", "period-below-cycle"},
    "FaultSpec.at": {"event-never-comes"},
    "FirstMotionSpec.timeout": {"first-motion-cannot-end"},
    "FrameSpec.buffer": {"short-transform-buffer", "budget-beyond-buffer"},
    "FrameSpec.rate": {"transform-slower-than-its-poses"},
    "GroupSpec.ik_timeout": {"timeout-below-inner"},
    "KpisSpec.cancel": {"cancel-bound-not-kept", "kpi-beyond-contract"},
    "KpisSpec.plan_to_execute": {"timeout-below-inner", "budget-beyond-buffer"},
    "ManagerSpec.update_rate": {"refused-update-rate", "watchdog-below-period", "faster-than-the-device"},
    "OctomapSpec.rate": {"faster-than-its-source"},
    "QosSpec.deadline": {"deadline-below-period"},
    "QosSpec.lease_duration": {"watchdog-below-period"},
    "QosSpec.lifespan": {"lifespan-below-max-age"},
    "RehearsalSpec.timeout": {"timeout-below-inner"},
    "RehearsalSpec.within": {"timeout-below-inner"},
    "ServoSpec.command_timeout": {"watchdog-below-period"},
    "ServoSpec.period": {"watchdog-below-period", "period-below-cycle"},
    "StampSpec.exposure": {"exposure-beyond-period", "max-age-too-short", "age-budget-exceeded"},
    "StampSpec.max_offset": {"clock-offset-beyond-age"},
    "SwitchingSpec.time": {"wait-below-way"},
    "SwitchingSpec.within": {"wait-below-way"},
    "TopicSpec.max_age": {"max-age-too-short", "age-budget-exceeded", "queue-older-than-max-age"},
    "TopicSpec.rate": {"faster-than-its-source", "faster-than-the-device", "queue-older-than-max-age"},
    "TopicSpec.transport": {"max-age-too-short", "age-budget-exceeded"},
    "joint_trajectory.action_monitor_rate": {"cancel-bound-not-kept"},
    "joint_trajectory.cmd_timeout": {"watchdog-below-period"},
    "joint_trajectory.constraints.goal_time": {"timeout-below-inner"},
    "joint_trajectory.state_publish_rate": {"faster-than-the-device"},
    "parallel_gripper.action_monitor_rate": {"cancel-bound-not-kept"},
    "parallel_gripper.stall_timeout": {"timeout-below-inner"},
    "robot_state_broadcaster.convenience_publish_rate": {"faster-than-the-device"},
    "speed_scaling_state_broadcaster.state_publish_rate": {"faster-than-the-device"},
}
_FREE = {
    "ClockSpec.simulated_offset": "a rehearsal may set a clock off by more than is allowed, to see what happens",
    "EventSpec.after": "a fault may come at any time after a step",
    "FaultSpec.lasting": "a fault may last for any time",
    "KpisSpec.recovery_time": "people recover a cell, and no part of the spec says how fast",
    "ServiceSpec.timeout": "how long an answer takes is not in the language",
    "SimulatedJointSpec.lag": "a rehearsal plays the joints of another robot on purpose",
    "SimulatedNetworkSpec.jitter": "a rehearsal plays a worse network on purpose",
    "SimulatedNetworkSpec.latency": "a rehearsal plays a worse network on purpose",
    "StampSpec.simulated_offset": "a rehearsal may set a clock off by more than is allowed, to see what happens",
    "freedrive.inactive_timeout": "a person guides the arm, at no rate",
    "joint_trajectory.gains.<joint>.tracking_time_constant": "how fast an integral follows its clamp, in the loop",
    "joint_trajectory.positions_upsampling.policy_frequency": "the rate of a policy, which is no part of the cell",
    "pid.gains.<dof_names>.tracking_time_constant": "how fast an integral follows its clamp, in the loop",
}
_NAMED_AS_TIME = re.compile(r"(rate|timeout|time|period|frequency|time_constant)$")


def _keys() -> Iterator[str]:
    """Yield every key of the language that takes a time or a rate, as `Model.key`."""
    seen: set[type[BaseModel]] = set()
    todo: list[type[BaseModel]] = [CellSpec]
    while todo:
        model = todo.pop()
        if model in seen:
            continue
        seen.add(model)
        for name, field in model.model_fields.items():
            parts = [*field.metadata, *_parts(field.annotation)]
            if any(isinstance(part, QuantityType) and {DURATION, FREQUENCY} & {*part.dimensions} for part in parts):
                yield f"{model.__name__}.{field.alias or name}"
            todo += [part for part in parts if isinstance(part, type) and issubclass(part, BaseModel)]


def _parts(annotation: Any) -> Iterator[Any]:
    """Yield an annotation, what it is made of, and what is said of its parts."""
    yield annotation
    yield from getattr(annotation, "__metadata__", ())
    for part in get_args(annotation):
        yield from _parts(part)


def _parameters() -> Iterator[str]:
    """Yield every parameter of a controller of the catalog that is named as a time or a rate."""
    kinds = {kind: there(load_controller_kind(kind).value).parameters for kind in controller_kinds()}
    for device in device_names():
        own = there(load_device(device).value).model.controllers
        kinds |= {name: controller.parameters for name, controller in own.items()}
    yield from (f"{kind}.{name}" for kind, names in kinds.items() for name in names if _NAMED_AS_TIME.search(name))


def test_every_time_and_rate_has_an_entry() -> None:
    assert {*_keys(), *_parameters()} == {*_JUDGED, *_FREE}


def test_entries_name_rules() -> None:
    assert set().union(*_JUDGED.values()) <= set(all_codes())
    assert not _JUDGED.keys() & _FREE.keys()


_MANUAL = "{perception: {reliability: reliable, depth: 1, liveliness: manual_by_topic, lease_duration: LEASE}}"
_STREAM = (
    "  /arm_trajectory/joint_trajectory: {topic: trajectory_msgs/msg/JointTrajectory, from: task, to: arm_trajectory,\n"
    "                                     rate: 10 Hz, max_age: 1 s, on_stale: ignore_sample, frame: world}\n"
)
_CALLED = (
    "  /regrasp: {action: demo_msgs/action/Regrasp, server: perception, client: move_group, frame: world,\n"
    "             timeout: 80 s, on_timeout: cancel_and_hold, cancel_within: 150 ms}\n"
)
_CLOSED = (
    "  /gripper_action/gripper_cmd:\n    {action: control_msgs/action/ParallelGripperCommand, server: gripper_action,\n"
    "     client: task, timeout: 5 s, on_timeout: error, cancel_within: 200 ms}\n"
)


def _pick(*edits: tuple[str, str]) -> tuple[str, tuple[tuple[str, str], ...]]:
    return "ur5e_pick", edits


def _sdk(*edits: tuple[str, str]) -> tuple[str, tuple[tuple[str, str], ...]]:
    return "hybrid_sdk", edits


_INTERFACES = "\ninterfaces:\n"
_GRIPPER = "{type: parallel_gripper, device: gripper, client: task}"
_WAIT = "steps: [move: home, wait: 5 s, acknowledge: operator, move: home]"
_SCALED = "      type: scaled_joint_trajectory\n"
_TIMEOUT = "arm_trajectory:\n      parameters: {cmd_timeout: SILENCE}\n"

_HELD = "                 on_timeout: cancel_and_hold, cancel_within: 450 ms"
_OUTER = "client: task, frame: world, timeout: 90 s,\n" + _HELD.replace("450", "400")
_INJECTED = (
    "    inject:\n"
    "      - {program_stop: arm, at: {step: 2, after: 500 ms}}\n"
    "      - {jog: arm/wrist_3_joint, by: 1.5 deg, at: {step: 2, after: 1 s}}\n"
    "      - {program_start: arm, at: {step: 2, after: 2 s}}\n"
)
_SPEED = "{type: speed_scaling_state_broadcaster, device: arm}"
_OFTEN = _SPEED[:-1] + ", update_rate: 50 Hz, parameters: {state_publish_rate: RATE}}"

_JOG = "    arm_jog: {type: forward_command, device: arm, active: false, client: servo}\n"
_SERVED = (
    ("\nnodes:\n", "\nnodes:\n  servo: {run: moveit_servo/servo_node, host: control_pc, owner: integration}\n"),
    (
        _INTERFACES,
        _INTERFACES + "  /servo/delta_twist_cmds: {topic: geometry_msgs/msg/TwistStamped, from: task, to: servo,\n"
        "                            frame: arm/base_link, rate: 50 Hz, max_age: 100 ms, on_stale: stop_and_hold}\n",
    ),
    ("    arm_trajectory:\n", _JOG + "    arm_trajectory:\n"),
    (
        "\nmotion:\n",
        "\nmotion:\n  servo: {node: servo, controller: arm_jog, linear: 0.05 m/s, rotational: 0.2 rad/s,\n"
        "          joint: 0.2 rad/s, period: 4 ms, command_timeout: WAITS}\n",
    ),
)

_PAIRS = {
    # What is bounded at exactly its bound is accepted, and reported a little past it.
    "a watchdog of two periods of 4 ms": (
        _sdk(("command_timeout: 20 ms", "command_timeout: 8 ms")),
        _sdk(("command_timeout: 20 ms", "command_timeout: 7 ms")),
        ("watchdog-below-period", "devices.arm.adapter.command_timeout"),
    ),
    "a stop of 200 ms after a cycle of 4 ms": (
        _sdk(("cancel_within: 450 ms}\n  /move_action", "cancel_within: 204 ms}\n  /move_action")),
        _sdk(("cancel_within: 450 ms}\n  /move_action", "cancel_within: 203 ms}\n  /move_action")),
        ("cancel-bound-not-kept", "interfaces./arm/follow_joint_trajectory.cancel_within"),
    ),
    "a cancel through another action": (
        _sdk(("wheel, rpy", "wheel, rpy")),
        _sdk(("client: task, frame: world, timeout: 90 s,\n" + _HELD, _OUTER)),
        ("cancel-bound-not-kept", "interfaces./move_action.cancel_within"),
    ),
    "a loop that may take a second past the end": (
        _sdk(("frame: world, timeout: 90 s,\n     on_timeout", "frame: world, timeout: 1 s,\n     on_timeout")),
        _sdk(("frame: world, timeout: 90 s,\n     on_timeout", "frame: world, timeout: 900 ms,\n     on_timeout")),
        ("timeout-below-inner", "interfaces./arm/follow_joint_trajectory.timeout"),
    ),
    "a goal that waits for another": (
        _pick((_INTERFACES, _INTERFACES + _CALLED)),
        _pick((_INTERFACES, _INTERFACES + _CALLED), ("timeout: 90 s", "timeout: 70 s")),
        ("timeout-below-inner", "interfaces./move_action.timeout"),
    ),
    "fingers that stall for 6 s": (
        _pick((_INTERFACES, _INTERFACES + _CLOSED), (_GRIPPER, _GRIPPER[:-1] + ", parameters: {stall_timeout: 5.0}}")),
        _pick((_INTERFACES, _INTERFACES + _CLOSED), (_GRIPPER, _GRIPPER[:-1] + ", parameters: {stall_timeout: 6.0}}")),
        ("timeout-below-inner", "interfaces./gripper_action/gripper_cmd.timeout"),
    ),
    "a rehearsal that waits for 5 s": (
        _pick((_WAIT, _WAIT + "\n    timeout: 6 s"), (_INJECTED, "")),
        _pick((_WAIT, _WAIT + "\n    timeout: 4 s"), (_INJECTED, "")),
        ("timeout-below-inner", "rehearsals.jogged_and_restarted.timeout"),
    ),
    "a solver within half a second of planning": (
        _pick(("tip: tcp}", "tip: tcp, ik_timeout: 500 ms}")),
        _pick(("tip: tcp}", "tip: tcp, ik_timeout: 600 ms}")),
        ("timeout-below-inner", "motion.groups.manipulator.ik_timeout"),
    ),
    "a silence of two samples a second": (
        _pick((_INTERFACES, _INTERFACES + _STREAM), ("arm_trajectory:\n", _TIMEOUT.replace("SILENCE", "0.2"))),
        _pick((_INTERFACES, _INTERFACES + _STREAM), ("arm_trajectory:\n", _TIMEOUT.replace("SILENCE", "0.15"))),
        ("watchdog-below-period", "control.controllers.arm_trajectory.parameters.cmd_timeout"),
    ),
    "a lease of one sample in 100 ms": (
        _pick(("{perception: {reliability: reliable, depth: 1}}", _MANUAL.replace("LEASE", "100 ms"))),
        _pick(("{perception: {reliability: reliable, depth: 1}}", _MANUAL.replace("LEASE", "90 ms"))),
        ("watchdog-below-period", "interfaces./object_pose.from.perception.lease_duration"),
    ),
    "a topic of 100 Hz in a controller of 50 Hz": (
        _pick((_SPEED, _OFTEN.replace("RATE", "50.0"))),
        _pick((_SPEED, _OFTEN.replace("RATE", "100.0"))),
        ("faster-than-the-device", "control.controllers.arm_speed.parameters.state_publish_rate"),
    ),
    "a monitor that looks five times a second": (
        _pick((_SCALED, _SCALED + "      parameters: {action_monitor_rate: 5.0}\n")),
        _pick((_SCALED, _SCALED + "      parameters: {action_monitor_rate: 4.0}\n")),
        ("cancel-bound-not-kept", "control.controllers.arm_trajectory.parameters.action_monitor_rate"),
    ),
    "an exposure of 32.2 ms at 30 Hz": (
        _pick(("exposure: 8 ms", "exposure: 32.2 ms")),
        _pick(("exposure: 8 ms", "exposure: 32.4 ms")),
        ("exposure-beyond-period", "devices.camera.stamp.exposure"),
    ),
    "a Servo that waits for two commands of 20 ms": (
        _pick(*_SERVED, ("WAITS", "40 ms")),
        _pick(*_SERVED, ("WAITS", "30 ms")),
        ("watchdog-below-period", "motion.servo.command_timeout"),
    ),
    "a vendor that stops after 40 ms of silence": (
        _pick(("update_rate: 500 Hz", "update_rate: 50 Hz")),
        _pick(("update_rate: 500 Hz", "update_rate: 40 Hz")),
        ("watchdog-below-period", "control.update_rate"),
    ),
}


@pytest.mark.parametrize("what", _PAIRS)
def test_pair_is_reported_past_its_bound_and_not_at_it(what: str, tmp_path: Path) -> None:
    sound, broken, (code, path) = _PAIRS[what]

    def places(cell: str, edits: tuple[tuple[str, str], ...]) -> set[str]:
        text = spec_text(cell)
        for old, new in edits:
            assert old in text
            text = text.replace(old, new, 1)
        found = diagnose(written(tmp_path, text))
        return {".".join(map(str, diagnostic.yaml_path)) for diagnostic in found if diagnostic.code == code}

    assert path not in places(*sound)
    assert path in places(*broken)
