"""The bag of a rehearsal, read back by two libraries and compared with the run and with calculations by hand."""

from __future__ import annotations

import json
import math
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader

from cellc.mock import MockCell
from cellc.mock.result import to_json_line
from tests.mock.conftest import Received, Written, received, stamp_ns

TOPICS = {
    "/robot_description": "std_msgs/msg/String",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/arm_trajectory/controller_state": "control_msgs/msg/JointTrajectoryControllerState",
    "/cellc/arm_trajectory/goal": "trajectory_msgs/msg/JointTrajectory",
    "/cellc/gripper_action/goal": "sensor_msgs/msg/JointState",
    "/object_pose": "geometry_msgs/msg/PoseStamped",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    "/clock": "rosgraph_msgs/msg/Clock",
    "/cellc/attempts": "std_msgs/msg/String",
    "/arm_trajectory/follow_joint_trajectory/_action/status": "action_msgs/msg/GoalStatusArray",
    "/gripper_action/gripper_cmd/_action/status": "action_msgs/msg/GoalStatusArray",
    "/move_action/_action/status": "action_msgs/msg/GoalStatusArray",
    "/rosout": "rcl_interfaces/msg/Log",
}
PERIOD_NS = 2_000_000
"""The manager of the cell runs at 500 Hz."""
JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
HOME = [0.0, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0]
"""`home` of the cell in the order of the arm's joints."""


def messages(written: Written, topic: str, rehearsal: str = "pick_and_place") -> tuple[Received, ...]:
    return _messages(written.bag(rehearsal), topic)


@cache
def _messages(bag: Path, topic: str) -> tuple[Received, ...]:
    """Decode a topic once: all tests read the same bag, and rosbags takes half a second for the longest topic."""
    return tuple(received(bag, topic))


def test_mcap_finds_every_topic_with_its_type_and_no_damage(written: Written) -> None:
    for rehearsal in written.results:
        with written.bag(rehearsal).open("rb") as file:
            reader = make_reader(file, validate_crcs=True)
            summary = reader.get_summary()
            assert summary is not None
            found = {each.topic: summary.schemas[each.schema_id].name for each in summary.channels.values()}
            assert found == TOPICS
            assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
            assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}
            assert summary.statistics is not None
            assert sum(1 for _ in reader.iter_messages()) == summary.statistics.message_count


def test_header_names_the_profile_and_no_version_of_a_library(written: Written) -> None:
    with written.bag("canceled").open("rb") as file:
        header = make_reader(file).get_header()
    assert (header.profile, header.library) == ("ros2", "cellc mock")


def test_rosbags_decodes_every_message_by_the_definitions_in_the_bag(written: Written) -> None:
    from rosbags.highlevel import AnyReader

    with AnyReader([written.bag("canceled")]) as reader:
        assert {connection.topic: connection.msgtype for connection in reader.connections} == TOPICS
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)


def test_profiles_are_those_of_the_contract_in_the_form_of_rosbag2(written: Written, cell: MockCell) -> None:
    with written.bag("canceled").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    offered = {each.topic: yaml.safe_load(each.metadata["offered_qos_profiles"]) for each in summary.channels.values()}
    for topic in ("/tf", "/tf_static", "/joint_states", "/object_pose"):
        (profile,) = offered[topic]
        stated = cell.contract.interfaces[topic].sources[0].qos
        assert profile["depth"] == stated.depth
        assert (profile["reliability"] == 1) == (stated.reliability == "reliable")  # rmw/types.h: 1 is RELIABLE
        assert (profile["durability"] == 1) == (stated.durability == "transient_local")  # 1 is TRANSIENT_LOCAL
        assert profile["deadline"] == {"sec": 9223372036, "nsec": 854775807}  # RMW_DURATION_INFINITE


def test_joint_states_come_with_every_update_cycle(written: Written) -> None:
    stamps = [stamp_ns(each.message.header) for each in messages(written, "/joint_states")]
    assert set(np.diff(stamps).tolist()) == {PERIOD_NS}


def test_arm_stands_at_home_before_it_moves_and_at_the_end(written: Written) -> None:
    states = messages(written, "/joint_states")
    for each in (states[0], states[-1]):
        by_name = dict(zip(each.message.name, each.message.position.tolist(), strict=True))
        at = [by_name[f"arm_{name}_joint"] for name in JOINTS]
        assert at == pytest.approx(HOME, abs=1e-6)


def test_reference_passes_through_every_point_of_the_goal_when_it_is_due(written: Written) -> None:
    """A point is due between two cycles; in the 2 ms up to the next one its own acceleration carries it on."""
    goal = messages(written, "/cellc/arm_trajectory/goal")[1]
    states = {each.log_ns: each.message for each in messages(written, "/arm_trajectory/controller_state")}
    # A goal without a stamp starts with the first update after it has arrived.
    start_ns = (goal.log_ns // PERIOD_NS + 1) * PERIOD_NS
    for point in goal.message.points[:-1]:
        due_ns = start_ns + point.time_from_start.sec * 1_000_000_000 + point.time_from_start.nanosec
        cycle_ns = -(-due_ns // PERIOD_NS) * PERIOD_NS
        after_s = (cycle_ns - due_ns) / 1e9
        by_hand = point.positions + point.velocities * after_s + point.accelerations * after_s**2 / 2
        assert states[cycle_ns].reference.positions.tolist() == pytest.approx(by_hand.tolist(), abs=1e-6)
    assert len(goal.message.points) > 10


def test_measured_position_follows_the_command_one_cycle_later(written: Written) -> None:
    states = [each.message for each in messages(written, "/arm_trajectory/controller_state")]
    for before, after in pairwise(states):
        assert after.feedback.positions.tolist() == before.output.positions.tolist()
    for state in states[:: len(states) // 20]:
        error = state.reference.positions - state.feedback.positions
        assert state.error.positions.tolist() == pytest.approx(error.tolist(), abs=1e-12)
        assert state.speed_scaling_factor == 1.0


def test_reference_velocity_is_the_slope_of_the_reference(written: Written) -> None:
    states = [each.message for each in messages(written, "/arm_trajectory/controller_state")]
    for before, state, after in list(zip(states[:-2], states[1:-1], states[2:], strict=True))[::97]:
        slope = (after.reference.positions - before.reference.positions) / (2 * PERIOD_NS / 1e9)
        assert state.reference.velocities.tolist() == pytest.approx(slope.tolist(), abs=1e-3)


def test_transforms_come_at_the_rate_of_their_publisher_with_the_stamp_of_the_joint_state(written: Written) -> None:
    """robot_state_publisher takes a joint state 50 ms after the one before, 20 Hz by default."""
    moving = [each for each in messages(written, "/tf") if len(each.message.transforms) > 1]
    assert {after.log_ns - before.log_ns for before, after in pairwise(moving)} == {50_000_000}
    for each in moving:
        assert {stamp_ns(transform.header) for transform in each.message.transforms} == {each.log_ns}


def test_tip_stands_where_the_arithmetic_of_the_arm_puts_it(written: Written) -> None:
    """At home the upper arm points up, the forearm forwards and the tool down.

    Lengths of the arm in m from its kinematic parameters: shoulder 0.1625, upper arm 0.425, forearm 0.3922, wrists
    0.1333, 0.0997 and 0.0996; its base stands 0.8 above the world.
    """
    by_hand = (0.3922 + 0.0997, 0.1333, 0.8 + 0.1625 + 0.425 - 0.0996)
    position = _position("arm_tool0", _edges(written, at_ns=messages(written, "/tf")[0].log_ns))
    assert position == pytest.approx(by_hand, abs=1e-9)


def test_transforms_agree_with_another_reader_of_the_description(written: Written, tmp_path: Any) -> None:
    import yourdfpy

    file = tmp_path / "cell.urdf"
    file.write_text(messages(written, "/robot_description")[0].message.data)
    robot = yourdfpy.URDF.load(str(file), load_meshes=False, build_scene_graph=True)
    states = {each.log_ns: each.message for each in messages(written, "/joint_states")}
    moving = [each.log_ns for each in messages(written, "/tf") if len(each.message.transforms) > 1]
    for at_ns in moving[:: len(moving) // 10]:
        state = states[at_ns]
        robot.update_cfg(dict(zip(state.name, state.position.tolist(), strict=True)))
        expected = robot.get_transform("tcp", "world")[:3, 3]
        assert _position("tcp", _edges(written, at_ns)) == pytest.approx(expected.tolist(), abs=1e-9)


def _edges(written: Written, at_ns: int) -> dict[str, Any]:
    """Return the edges known at an instant, by child: fixed ones, and those of the message of that instant."""
    fixed = messages(written, "/tf_static")[0].message.transforms
    moving = [each for each in messages(written, "/tf") if each.log_ns == at_ns]
    return {
        edge.child_frame_id: edge for edge in (*fixed, *(edge for each in moving for edge in each.message.transforms))
    }


def _position(frame: str, edges: dict[str, Any]) -> list[float]:
    """Compose edges up to the root with rotation matrices."""
    point = np.zeros(3)
    while frame in edges:
        transform = edges[frame].transform
        x, y, z, w = (getattr(transform.rotation, part) for part in "xyzw")
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        translation = [getattr(transform.translation, part) for part in "xyz"]
        point = rotation @ point + np.array(translation)
        frame = edges[frame].header.frame_id
    return [float(value) for value in point]


def test_object_pose_is_seen_where_the_cell_puts_the_object(written: Written, cell: MockCell) -> None:
    """While the arm stands at home: camera in the world by the bag's own transforms, object by the folder."""
    frame = cell.contract.frames["object"]
    joints = cell.folder.description.joints
    fixture = next(joint.pose for joint in joints if joint.child == frame.simulated_parent)
    assert frame.simulated_pose is not None
    object_z = fixture.position[2] + frame.simulated_pose.xyz[2]
    edges = _edges(written, at_ns=messages(written, "/tf")[0].log_ns)
    seen = messages(written, "/object_pose")[0].message
    assert seen.header.frame_id == frame.parent
    position = seen.pose.position
    edges["seen"] = _edge(frame.parent, (position.x, position.y, position.z))
    assert _position("seen", edges)[2] == pytest.approx(object_z, abs=1e-9)


def _edge(parent: str, translation: tuple[float, float, float]) -> Any:
    from types import SimpleNamespace as Plain

    x, y, z = translation
    transform = Plain(translation=Plain(x=x, y=y, z=z), rotation=Plain(x=0.0, y=0.0, z=0.0, w=1.0))
    return Plain(transform=transform, header=Plain(frame_id=parent))


def test_attempts_of_the_bag_are_the_records_of_the_run(written: Written) -> None:
    for rehearsal, result in written.results.items():
        lines = [each.message.data for each in messages(written, "/cellc/attempts", rehearsal)]
        assert lines == [to_json_line(record) for record in result.attempts]
        file = (written.folder / f"{rehearsal}.records.jsonl").read_text(encoding="utf-8")
        assert file.splitlines() == lines


def test_diagnostics_tell_when_all_controllers_are_active(written: Written) -> None:
    statuses = [each.message.status for each in messages(written, "/diagnostics")]
    activity = [status for each in statuses for status in each if status.name.endswith("Controllers Activity")]
    assert activity[0].level == 1  # WARN: the trajectory controller was not active yet
    assert activity[-1].level == 0
    assert {value.value for value in activity[-1].values} == {"active"}


def test_metadata_names_configuration_and_seed(written: Written, cell: MockCell) -> None:
    with written.bag("canceled").open("rb") as file:
        (metadata,) = make_reader(file).iter_metadata()
    assert metadata.metadata["configuration_id"] == cell.contract.configuration_id
    assert metadata.metadata["seed"] == "0"
    assert metadata.metadata["version.ros"] == "jazzy"


def test_watching_changes_nothing(written: Written, cell: MockCell) -> None:
    for rehearsal, result in written.results.items():
        assert cell.run(rehearsal) == result


def test_canceled_goal_has_its_latency_among_the_figures(written: Written) -> None:
    content = json.loads((written.folder / "canceled.kpis.json").read_text(encoding="utf-8"))
    figures = {figure["name"]: figure for figure in content["kpis"]}
    cancels = [record.cancel for record in written.results["canceled"].attempts if record.cancel is not None]
    assert cancels[0].held_ns is not None
    by_hand = (cancels[0].held_ns - cancels[0].requested_ns) / 1e9
    assert figures["cancel_s"]["value"] == by_hand
    assert figures["cancel_s"]["met"] == (by_hand <= 0.2)


@pytest.mark.parametrize("name", ["pick_and_place", "canceled"])
def test_undisturbed_runs_have_no_owner_that_the_contract_does_not_state(written: Written, name: str) -> None:
    content = json.loads((written.folder / f"{name}.kpis.json").read_text(encoding="utf-8"))
    figures = {figure["name"]: figure for figure in content["kpis"]}
    of_owners = figures["wrong_owner_events"]
    assert (of_owners["value"], of_owners["met"]) == (0, True)
    assert (figures["missed_cycles"]["value"], figures["protective_stops"]["value"]) == (0, 0)
