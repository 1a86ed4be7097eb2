"""Cards of hosts, stages, managed programs, and names that programs and controllers give themselves, in whole cells."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cells import diagnose, spec_text, written

_CARD = "robot: {address: 192.168.56.10/24, carries: [control]}"
_GROUP = "  move_group: {run: moveit_ros_move_group/move_group, host: control_pc, owner: integration}\n"


def _codes(tmp_path: Path, old: str, new: str, cell: str = "ur5e_pick") -> set[str]:
    text = spec_text(cell)
    assert old in text
    before = {one.code for one in diagnose(written(tmp_path, text))}
    return {one.code for one in diagnose(written(tmp_path, text.replace(old, new, 1)))} - before


@pytest.mark.parametrize(
    ("card", "codes"),
    [
        ("interface: enp3s0, ", set()),
        ("interface: eth0, ", set()),
        ("interface: wlp2s0, ", {"unsuited-card"}),
        ("interface: wlan0, ", {"unsuited-card"}),
        ("interface: lo, ", {"unsuited-card"}),
        ("interface: docker0, ", {"unsuited-card"}),
        ("speed: 100 Mbit/s, ", set()),
        ("speed: 10 Mbit/s, ", {"unsuited-card"}),
    ],
)
def test_card_of_a_robot_is_wired_and_a_card_at_all(card: str, codes: set[str], tmp_path: Path) -> None:
    new = _CARD.replace("carries", f"{card}carries")
    assert _codes(tmp_path, _CARD, new) == codes


def test_card_of_images_may_be_wireless(tmp_path: Path) -> None:
    old = "bulk: {address: 10.10.0.10/24, carries"
    assert _codes(tmp_path, old, old.replace("carries", "interface: wlp2s0, carries")) == set()


@pytest.mark.parametrize(
    ("address", "codes"),
    [("192.168.56.10/24", set()), ("192.168.56.10/16", set()), ("192.168.56.10/8", {"public-address"})],
)
def test_subnet_of_a_private_card_holds_no_public_addresses(address: str, codes: set[str], tmp_path: Path) -> None:
    assert _codes(tmp_path, "192.168.56.10/24", address) == codes


@pytest.mark.parametrize(
    ("peers", "codes"),
    [
        ("[10.20.0.10, 10.20.0.11]", set()),
        ("[172.16.0.1, 10.20.0.11]", {"peer-on-control-card"}),
        ("[10.20.0.10, 172.16.0.2]", {"peer-on-control-card", "unknown-peer"}),
    ],
)
def test_peers_have_cards_for_ros(peers: str, codes: set[str], tmp_path: Path) -> None:
    assert _codes(tmp_path, "[10.20.0.10, 10.20.0.11]", peers, "fr3_hand") == codes


@pytest.mark.parametrize(
    ("by", "codes"),
    [
        ("chrony", set()),
        ("ptp4l", set()),
        ("NTP server of the plant", set()),
        ("none", {"unsynchronized-hosts"}),
        ("set by hand", {"unsynchronized-hosts"}),
        ("No", {"unsynchronized-hosts"}),
    ],
)
def test_clock_of_a_host_is_kept_by_a_program(by: str, codes: set[str], tmp_path: Path) -> None:
    old = "planner_pc: {scheduling: generic, clock: {domain: ros, synchronized_by: chrony"
    assert _codes(tmp_path, old, old.replace("chrony", f'"{by}"'), "fr3_hand") == codes


@pytest.mark.parametrize(
    ("caps", "codes"),
    [
        ("velocity: 100 %, acceleration: 100 %, stages: 25 100 %", set()),
        ("velocity: 100 %, acceleration: 100 %, stages: 30 100 %", {"hasty-stages"}),
        ("velocity: 100 %, acceleration: 100 %, stages: 100 %", {"hasty-stages"}),
        ("velocity: 40 %, acceleration: 100 %, stages: 50 100 %", set()),  # a fifth of full speed
        ("velocity: 250 mm/s, acceleration: 100 %, stages: 100 %", set()),  # the reduced speed itself
        ("velocity: 100 %, acceleration: 100 %, stages: 10 60 100 %", {"hasty-stages"}),
    ],
)
def test_first_stage_is_slow_and_others_rise_in_steps(caps: str, codes: set[str], tmp_path: Path) -> None:
    assert _codes(tmp_path, "velocity: 100 %, acceleration: 100 %", caps) - {"first-motion-above-stage"} == codes


@pytest.mark.parametrize(
    ("old", "new", "codes"),
    [
        ("  /move_action:\n", "  /left/move_action:\n", {"unoffered-call"}),
        (_GROUP, _GROUP.replace("owner", "namespace: /left, owner"), {"unoffered-call"}),
        ("action/MoveGroup", "action/ExecuteTrajectory", {"unoffered-call"}),
        ("    server: move_group\n    client: task", "    server: task\n    client: move_group", {"unoffered-call"}),
        (_GROUP, _GROUP.replace("owner", "lifecycle: true, owner"), {"unmanaged-program"}),
    ],
)
def test_program_is_called_by_its_own_names_and_is_what_it_is(
    old: str, new: str, codes: set[str], tmp_path: Path
) -> None:
    assert codes <= _codes(tmp_path, old, new)


def test_group_in_a_namespace_is_called_there(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace(_GROUP, _GROUP.replace("owner", "namespace: /left, owner"))
    text = text.replace("  /move_action:\n", "  /left/move_action:\n")
    assert "unoffered-call" not in {one.code for one in diagnose(written(tmp_path, text))}


_SENSOR = "sensor_name: arm_tcp_fts_sensor"


@pytest.mark.parametrize(
    ("parameters", "codes"),
    [
        (f"frame_id: arm_tool0, {_SENSOR}", set()),
        (
            f"frame_id: arm_tool0, {_SENSOR}, interface_names.force.x: arm_tcp_fts_sensor/force.x",
            {"conflicting-parameters"},
        ),
    ],
)
def test_broadcaster_of_forces_names_a_sensor_or_interfaces(parameters: str, codes: set[str], tmp_path: Path) -> None:
    old = "    arm_trajectory:\n"
    force = f"    arm_force: {{type: force_torque_sensor_broadcaster, device: arm, parameters: {{{parameters}}}}}\n"
    assert _codes(tmp_path, old, force + old) == codes


@pytest.mark.parametrize(
    ("parameters", "codes"),
    [
        ("state_interfaces: [position]", set()),
        ("state_interfaces: [velocity]", {"parameter-out-of-range"}),
        ("command_joints: [arm_elbow_joint]", set()),
        ("command_joints: [elbow]", {"parameter-out-of-range"}),
    ],
)
def test_list_that_a_trajectory_controller_refuses_is_out_of_range(
    parameters: str, codes: set[str], tmp_path: Path
) -> None:
    old = "      client: move_group\n"
    assert _codes(tmp_path, old, f"{old}      parameters: {{{parameters}}}\n") == codes


@pytest.mark.parametrize(
    ("old", "new", "codes"),
    [
        ("goal_time: 1 s", "goal_time: 60 s", {"implausible-time"}),
        ("goal_time: 1 s", "goal_time: 5 s", set()),
        ("path_tolerance: 0.2 rad", "path_tolerance: 0.4 rad", set()),
        ("path_tolerance: 0.2 rad", "path_tolerance: 1 rad", {"implausible-tolerance"}),
        ("missed_cycles: 0", "missed_cycles: 500", {"implausible-amount"}),
        ("expect: canceled, within: 200 ms", "expect: canceled, within: 10 ms", {"cancel-bound-not-kept"}),
        ("      client: move_group\n", "      client: move_group\n      update_rate: 10 Hz\n", {"implausible-rate"}),
        ("firmware: polyscope 5.21.0", "firmware: polyscopex 10.8.0", {"firmware-outside-matrix"}),
        (
            "depth: 1}}\n    wants: newest\n    frame",
            "lifespan: 1 s, depth: 1}}\n    wants: newest\n    frame",
            {"policy-without-effect"},
        ),
        ("run: cell_tasks/pick_place", "run: cell_tasks/pick_place.launch.py", {"unknown-executable"}),
        ("run: moveit_ros_move_group/move_group", "run: moveit_ros_move_group/move_groups", {"unknown-executable"}),
        ("run: cell_tasks/pick_place", "run: cell_tasks/pick_places", set()),
    ],
)
def test_figure_or_name_that_no_cell_means_is_named(old: str, new: str, codes: set[str], tmp_path: Path) -> None:
    found = _codes(tmp_path, old, new)
    assert codes <= found if codes else not found


def test_wireless_card_between_hosts_is_named(tmp_path: Path) -> None:
    old = "cell: {address: 10.20.0.10/24, carries"
    new = old.replace("carries", "interface: wlan0, carries")
    assert _codes(tmp_path, old, new, "fr3_hand") == {"wireless-ros-card"}


@pytest.mark.parametrize(
    ("value", "codes"),
    [
        ("arm_speed_scaling/speed_scaling_factor", set()),
        ("speed_scaling/speed_scaling_factor", {"parameter-of-nothing"}),
    ],
)
def test_interface_that_a_parameter_names_is_exported(value: str, codes: set[str], tmp_path: Path) -> None:
    old = "      client: move_group\n"
    new = f"{old}      parameters: {{speed_scaling.state_interface: {value}}}\n"
    assert _codes(tmp_path, old, new) == codes
