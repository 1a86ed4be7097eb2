"""Parameters that a consumer refuses or that make a cell worse, in every distribution, by the vendors' declarations."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from cellc.compiler.catalog.load import controller_kinds, load_controller_kind, load_program_parameters
from cellc.compiler.catalog.parameter_facts import DiscouragedValue
from tests.cells import diagnose, spec_text, there, written


@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted", "lyrical"])
@pytest.mark.parametrize(
    ("parameters", "reported"),
    [
        ("", True),
        (", parameters: {frame_id: arm_tool0}", False),
        (", parameters: {sensor_name: arm_tcp_fts_sensor}", True),
    ],
)
def test_empty_default_that_the_broadcaster_refuses_is_missing(
    distro: str, parameters: str, reported: bool, tmp_path: Path
) -> None:
    # force_torque_sensor_broadcaster declares frame_id with default "" and not_empty<> in every distribution.
    text = spec_text("ur5e_pick").replace("  ros: jazzy", f"  ros: {distro}", 1)
    force = "    arm_force: {type: force_torque_sensor_broadcaster, device: arm" + parameters + "}\n"
    assert "    arm_trajectory:\n" in text
    found = diagnose(written(tmp_path, text.replace("    arm_trajectory:\n", force + "    arm_trajectory:\n", 1)))
    assert any(one.code == "missing-controller-parameter" for one in found) is reported


def _value(**figures: float | str | bool) -> DiscouragedValue:
    return DiscouragedValue.model_validate({"does": "it does that", "source": "a line", **figures})


@pytest.mark.parametrize(
    ("row", "held", "others"),
    [
        (_value(value=0.0), [0.0, 0, -0.0], [0.01, False, "0.0"]),
        (_value(value=False), [False, (True, False)], [True, 0, 0.0, "False"]),
        (_value(value="none"), ["none"], ["splines", False]),
        (_value(above=0.1), [0.11, 1], [0.1, 0.0, True, "1"]),
        (_value(below=0.0), [-0.1, (1.0, -1.0)], [0.0, 1.0, False]),
    ],
)
def test_value_is_held_to_be_worse_only_where_it_is_meant(
    row: DiscouragedValue, held: list[object], others: list[object]
) -> None:
    assert all(row.holds(value) for value in held)
    assert not any(row.holds(value) for value in others)


def test_no_default_of_a_program_is_discouraged_but_where_cellc_writes_another() -> None:
    worse = {
        f"{kind}.{name}"
        for kind in controller_kinds()
        for name, facts in there(load_controller_kind(kind).value).parameters.items()
        if any(one.holds(facts.default) and not one.is_any for one in facts.discouraged)
    }
    assert worse == {"parallel_gripper.allow_stalling"}


def _rows() -> Iterator[tuple[str, DiscouragedValue]]:
    for kind in controller_kinds():
        for name, facts in there(load_controller_kind(kind).value).parameters.items():
            yield from ((f"{kind}.{name}", row) for row in facts.discouraged)
    for program in there(load_program_parameters().value).programs:
        for name, facts in program.parameters.items():
            yield from ((f"{program.executables[0]}.{name}", row) for row in facts.discouraged)


def test_rows_are_values_or_ranges_and_those_of_every_value_have_a_condition_or_say_that_they_change_nothing() -> None:
    rows = dict(_rows())
    assert len(rows) > 40
    ranged = ("below", "above", "below_of", "most_of", "above_of", "begins", "lacks", "ahead")
    for name, row in rows.items():
        assert row.value is None or all(getattr(row, key) is None for key in ranged), name
        assert not row.is_any or row.given or row.commands or "changes nothing" in row.does, name


def test_parameters_that_rows_compare_with_are_declared_beside_them() -> None:
    for program in there(load_program_parameters().value).programs:
        for facts in program.parameters.values():
            others = {
                other for row in facts.discouraged for other in (row.below_of, row.most_of, row.above_of) if other
            }
            assert others <= set(program.parameters)
    for kind in controller_kinds():
        declared = there(load_controller_kind(kind).value).parameters
        for facts in declared.values():
            others = {
                other for row in facts.discouraged for other in (row.below_of, row.most_of, row.above_of) if other
            }
            assert others <= {*declared, "update_rate"}


def _of_trajectory(tmp_path: Path, parameters: str, keys: str = "", distro: str = "jazzy") -> dict[str, str]:
    text = spec_text("ur5e_pick").replace("  ros: jazzy", f"  ros: {distro}", 1)
    line = "      client: move_group\n"
    assert line in text
    text = text.replace(line, f"{line}{keys}      parameters: {{{parameters}}}\n", 1)
    return {one.code: one.message for one in diagnose(written(tmp_path, text)) if one.yaml_path[-1:] != ("ros",)}


@pytest.mark.parametrize(
    ("parameters", "keys", "reported"),
    [
        ("cmd_timeout: 1.0", "", True),  # goal_time is 1 s
        ("cmd_timeout: 1.5", "", False),
        ("cmd_timeout: 0.0", "", False),
        ("cmd_timeout: -1.0", "", True),
        ("action_monitor_rate: 500.0", "", False),  # that of the manager
        ("action_monitor_rate: 501.0", "", True),
        ("action_monitor_rate: 150.0", "      update_rate: 100 Hz\n", True),
        ("gains.arm_elbow_joint.p: 100.0", "", True),
        ("constraints.arm_elbow_joint.max_deceleration_on_cancel: 2.0", "", True),
        (
            "constraints.arm_elbow_joint.max_deceleration_on_cancel: 2.0, constraints.decelerate_on_cancel: true",
            "",
            False,
        ),
        ("open_loop_control: true", "", True),
        ("open_loop_control: false", "", False),
        ("constraints.stopped_velocity_tolerance: 0.0005", "", True),
        ("constraints.stopped_velocity_tolerance: 0.05", "", False),
    ],
)
def test_value_that_a_trajectory_controller_ignores_or_that_spoils_it_is_discouraged(
    parameters: str, keys: str, reported: bool, tmp_path: Path
) -> None:
    assert ("discouraged-parameter" in _of_trajectory(tmp_path, parameters, keys)) is reported


@pytest.mark.parametrize(
    ("parameters", "code"),
    [
        ("constraints.goal_time: 5.0", "parameter-over-cell"),
        ("constraints.arm_elbow_joint.goal: 0.1", "parameter-over-cell"),
        ("joints: [arm_elbow_joint]", "parameter-over-cell"),
        ("constraints.elbow.goal: 0.1", "parameter-of-nothing"),
        ("constraints.arm/elbow_joint.goal: 0.1", "parameter-of-nothing"),
    ],
)
def test_parameter_that_a_key_states_or_that_is_of_no_joint_is_named(
    parameters: str, code: str, tmp_path: Path
) -> None:
    found = _of_trajectory(tmp_path, parameters)
    assert code in found
    assert len(found.keys() & {"parameter-over-cell", "parameter-of-nothing"}) == 1


def _of_node(tmp_path: Path, node: str, parameters: str, distro: str = "jazzy") -> set[str]:
    text = spec_text("ur5e_pick").replace("  ros: jazzy", f"  ros: {distro}", 1)
    line = "  move_group: {run: moveit_ros_move_group/move_group, host: control_pc, owner: integration}\n"
    assert line in text
    text = text.replace(
        line, f"{line}  other: {{run: {node}, host: control_pc, owner: x, parameters: {{{parameters}}}}}\n"
    )
    codes = {one.code for one in diagnose(written(tmp_path, text)) if one.yaml_path[-2:-1] == ("parameters",)}
    return codes | {one.code for one in diagnose(written(tmp_path, text)) if one.yaml_path[-3:-2] == ("parameters",)}


_GROUP = "moveit_ros_move_group/move_group"
_SERVO = "moveit_servo/servo_node"


@pytest.mark.parametrize(
    ("node", "parameters", "distro", "codes"),
    [
        (_GROUP, "ompl.planning_plugin: ompl_interface/OMPLPlanner", "jazzy", {"unknown-node-parameter"}),
        (_GROUP, "ompl.planning_plugin: ompl_interface/OMPLPlanner", "humble", {"parameter-over-cell"}),
        (_GROUP, "jiggle_fraction: 0.02", "humble", {"unknown-node-parameter"}),
        (_GROUP, "ompl.jiggle_fraction: 0.02", "humble", set()),
        (_GROUP, "ompl.request_adapters: a b", "humble", set()),
        (_GROUP, "ompl.request_adapters: a b", "jazzy", {"wrong-parameter-type"}),
        (
            _GROUP,
            "trajectory_execution.allowed_start_tolerance: 1",
            "jazzy",
            {"wrong-parameter-type", "discouraged-parameter"},
        ),
        (_GROUP, "my_capability.rate: 1", "jazzy", set()),
        (_GROUP, "use_sim_time: false", "jazzy", {"mixed-clocks"}),
        (_GROUP, "robot_description_kinematics.panda_arm.kinematics_solver: a", "jazzy", {"parameter-of-nothing"}),
        (_SERVO, "moveit_servo.joint_limit_margin: 0.1", "jazzy", {"unknown-node-parameter"}),
        (_SERVO, "incoming_command_timeout: 0.1", "jazzy", {"unknown-node-parameter"}),
        (_SERVO, "moveit_servo.joint_limit_margins: [0.1]", "jazzy", set()),
        (
            _SERVO,
            "moveit_servo.joint_limit_margins: [-0.1]",
            "jazzy",
            {"parameter-out-of-range", "discouraged-parameter"},
        ),
        (_SERVO, "moveit_servo.publish_period: 0.01", "jazzy", {"parameter-over-cell"}),
        (_SERVO, "moveit_servo.lower_singularity_threshold: 30.0", "jazzy", set()),
        (_SERVO, "moveit_servo.hard_stop_singularity_threshold: 17.0", "jazzy", {"discouraged-parameter"}),
    ],
)
def test_parameter_of_a_program_is_held_against_what_the_program_declares(
    node: str, parameters: str, distro: str, codes: set[str], tmp_path: Path
) -> None:
    assert _of_node(tmp_path, node, parameters, distro) == codes


_ADAPTERS = "default_planning_response_adapters"


@pytest.mark.parametrize(
    ("adapters", "reported"),
    [
        ("AddTimeOptimalParameterization, ValidateSolution", False),
        ("AddTimeOptimalParameterization, AddRuckigTrajectorySmoothing, ValidateSolution", False),
        ("AddRuckigTrajectorySmoothing, AddTimeOptimalParameterization, ValidateSolution", True),
        ("ValidateSolution", True),
        ("AddTimeOptimalParameterization", True),
    ],
)
def test_list_of_adapters_is_held_against_what_a_path_needs(adapters: str, reported: bool, tmp_path: Path) -> None:
    names = ", ".join(f"{_ADAPTERS}/{name}" for name in adapters.split(", "))
    found = _of_node(tmp_path, _GROUP, f"ompl.response_adapters: [{names}]")
    assert found == ({"discouraged-parameter"} if reported else set())
