"""Checklists, audit and recording: complete, in order, and without a command that moves anything."""

from __future__ import annotations

import json
import re
from os import environ, utime
from pathlib import Path
from subprocess import run

import pytest

from tests.emit.cells import CELLS, artifacts_of, unbroken
from tests.foreign_yaml import safe_load

# What a checklist may tell people to type: reading commands, and starting what its gate releases.
_ALLOWED = (
    "cat ",
    "cellc attempt ",
    "cellc build ",
    "cellc gates ",
    "cellc mock ",
    "git -C src/ros2_robotiq_gripper rev-parse HEAD",
    "grep ",
    "id -nG",
    "ip ",
    "ping -c ",
    "printenv ",
    "ros2 action info ",
    "ros2 bag info ",
    "ros2 bag record ",
    "ros2 control list_",
    "ros2 launch ",
    "ros2 lifecycle get ",
    "ros2 node list",
    "ros2 param get ",
    "ros2 run minimal observe ",  # tests/consumers/test_observe.py: it makes nothing that could change a graph
    "ros2 run tf2_ros tf2_",
    "ros2 run ur5e_pick observe ",
    "ros2 security list_enclaves ",
    "ros2 service info ",
    "ros2 service type ",
    "ros2 topic delay ",
    "ros2 topic echo ",
    "ros2 topic hz ",
    "ros2 topic info ",
    "sha256sum ",
    "sudo ping ",
    "ulimit -r -l",
    "uname -r",
    "uname -v",
    "xacro ",
)
# What may take their output: it is looked at, and appended to the evidence.
_AFTER_A_PIPE = (
    "check_urdf /dev/stdin",
    "grep ",
    "head -n ",
    "tail -n ",
    'tee -a "$E/',
    "tee /dev/stderr",
    "xargs -r -d '\\n' grep ",
    "xargs -r -d '\\n' ls -l",
    "xargs -r -d '\\n' ls -t",
)
# What ends motion and starts none: action_msgs/srv/CancelGoal with no goal and no time cancels every goal of an action.
_CANCEL = re.compile(r"ros2 service call (/\S+)/_action/cancel_goal action_msgs/srv/CancelGoal(?= 2>&1|$)")


# What runs is asked of the node itself.
_DESCRIBED = re.compile(r"ros2 service call (/\S+)/get_parameters rcl_interfaces/srv/GetParameters ")


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(("page", "letter", "numbers"), [("promotion", "G", range(8)), ("network", "L", range(1, 7))])
def test_gates_stand_in_order_with_evidence_and_stop(page: str, letter: str, numbers: range, cell: str) -> None:
    sections = re.split(r"^## ", artifacts_of(cell)[f"gates/{page}.md"], flags=re.MULTILINE)[1:]
    assert [section.split()[0] for section in sections] == [f"{letter}{number}" for number in numbers]
    for section in sections:
        assert "- [ ] " in section
        assert re.search(rf"Evidence: `{section.split()[0]}-[\w.-]+`\. Signed by: ", section)
        assert re.search(r"\*\*Stop on:\*\* \S", section)


def test_inventory_asks_for_a_commit_where_the_source_lies_that_the_workspace_imports() -> None:
    page = artifacts_of("ur5e_pick")["gates/promotion.md"]
    assert "git -C src/ros2_robotiq_gripper rev-parse HEAD" in page
    assert "  ros2_robotiq_gripper:\n" in artifacts_of("ur5e_pick")["sources.repos"]
    # Its number never moved: no package could agree with the pin.
    assert "ros2 pkg xml -t version robotiq_driver" not in page


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("page", ["gates/promotion.md", "gates/network.md"])
def test_commands_only_read(page: str, cell: str) -> None:
    blocks = re.findall(r"```sh\n(.*?)```", unbroken(artifacts_of(cell)[page]), flags=re.DOTALL)
    lines = "\n".join(blocks).splitlines()
    commands = [line.strip().removeprefix("{ ") for line in lines if not re.match(r"\s*(\{|\(set -x|[)}].*)?$", line)]
    assert len(commands) > 10
    for command in commands:
        first, *others = re.sub(r"^timeout \d+ ", "", command).split(" | ")
        assert first.startswith(_ALLOWED) or _CANCEL.match(first) or _DESCRIBED.match(first), command
        assert all(other.startswith(_AFTER_A_PIPE) for other in others), command


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("page", ["gates/promotion.md", "gates/network.md"])
def test_no_tool_of_ros_is_waited_for_without_end(page: str, cell: str) -> None:
    # ../shared/facts/bring_up.md: `ros2 control list_controllers` can wait for ever beside a live manager.
    text = artifacts_of(cell)[page]
    blocks = "\n".join(re.findall(r"```sh\n(.*?)```", text, flags=re.DOTALL)).replace("\\\n", " ")
    lines = [line.strip().removeprefix("{ ") for line in blocks.splitlines()]
    asked = [line for line in lines if re.match(r"(timeout \d+ )?ros2 ", line)]
    ends_itself = ("ros2 launch ", "ros2 bag record ", "ros2 pkg xml ", "ros2 security ", f"ros2 run {cell} observe ")
    assert asked
    assert not [line for line in asked if not line.startswith(("timeout ", *ends_itself))]


def test_each_action_that_promises_how_soon_a_cancel_holds_has_the_command_that_cancels_it() -> None:
    gate = unbroken(artifacts_of("ur5e_pick")["gates/promotion.md"]).split("\n## G7")[1].replace("\\", "")
    # The first goals cancel at the controller; nothing else sends it a goal.
    assert [found[1] for found in _CANCEL.finditer(gate)] == ["/move_action"]
    assert "UNKNOWN: whether a canceled goal of `/gripper_action/gripper_cmd` holds within 0.2 s" in gate
    assert "The printed time runs from the request to standstill. It must be at most 0.2 s." in gate
    assert "then:=cancel" in gate
    assert not _CANCEL.search(artifacts_of("ur5e_pick")["gates/promotion.md"].split("\n## G7")[0])


def test_ends_that_are_observed_are_those_that_the_driver_and_the_stopper_add() -> None:
    # Universal_Robots_ROS2_Driver 3.8.0, robot_state_helper.cpp: it hears the three modes and asks for a resend.
    ends = json.loads(artifacts_of("ur5e_pick")["config/observe.json"])["real"]["ends"]
    for mode in ("robot_mode", "safety_mode", "robot_program_running"):
        assert ends[f"/arm_io/{mode}"] == {
            "sources": {"/arm_io": ""},
            "sinks": {"/arm_state_helper": "", "/claim_watch": ""},
        }
    assert ends["/arm_speed/speed_scaling"]["sinks"] == {"/claim_watch": ""}
    assert "/arm_state_helper" in ends["/arm_io/resend_robot_program"]["sinks"]


def test_motion_past_every_controller_is_looked_for_twice_and_stands_in_the_audit() -> None:
    # franka_ros2 v3.4.0 franka_action_server.cpp:46: every goal of ptp_motion is accepted, whoever sends it.
    artifacts = artifacts_of("fr3_hand")
    layer = artifacts["gates/network.md"].split("\n## L3")[1]
    gate = artifacts["gates/promotion.md"].split("\n## G5")[1].split("\n## ")[0]
    for name in ("/action_server/ptp_motion", "/hand_gripper/grasp", "/hand_gripper/move", "/hand_gripper/homing"):
        assert f"timeout 30 ros2 action info {name}" in layer
        assert f"`{name}` has no client" in gate
    paths = artifacts["audit.md"].split("\n## Command paths\n")[1].split("\n## ")[0]
    assert "no client in the cell → `/action_server/ptp_motion` → arm" in paths


def test_line_of_the_log_is_that_of_the_newest_launch_with_a_controller_manager(tmp_path: Path) -> None:
    started = "process started: ros2_control_node-1\n"
    logs = {"old": started + "Calibration checked successfully\n", "new": started, "claim": "a release\n"}
    for age, (name, text) in enumerate(logs.items()):
        (tmp_path / name).mkdir()
        (tmp_path / name / "launch.log").write_text(text, encoding="utf-8")
        utime(tmp_path / name / "launch.log", (1000.0 + age, 1000.0 + age))
    page = artifacts_of("ur5e_pick")["gates/promotion.md"]
    (block,) = (
        element for element in re.findall(r"```sh\n(.*?)```", page, flags=re.DOTALL) if "Calibration checked" in element
    )
    command = block.replace("E/G4-transitions.md", "E/evidence")
    env = {"ROS_LOG_DIR": str(tmp_path), "E": str(tmp_path), "PATH": environ["PATH"]}
    said = run(["sh", "-c", command], env=env, capture_output=True, text=True, check=True).stdout
    assert "new/launch.log" in said  # its time stands beside it
    assert "successfully" not in said


def test_first_motion_is_read_at_both_ends_and_by_the_name_of_its_joint() -> None:
    gate = artifacts_of("ur5e_pick")["gates/promotion.md"].split("\n## G6")[1].split("\n## ")[0]
    assert gate.count("ros2 topic echo --once /joint_states") == 3
    assert "arm_wrist_3_joint must have changed by + 0.0873 rad" in re.sub(r"\\", "", gate)  # 5 deg


def test_first_motion_of_a_robot_whose_driver_holds_it_is_read_at_its_panel() -> None:
    # libfranka, overview.rst:58: Desk cannot jog while FCI is active, and without FCI there are no states.
    gate = artifacts_of("fr3_hand")["gates/promotion.md"].split("\n## G6")[1].split("\n## ")[0]
    released, guided, again = (gate.index(text) for text in ("Release FCI in Desk", "Guide the joint", "/joint_states"))
    assert released < guided < again
    assert "ros2 bag record" not in gate


def test_recovery_tells_of_a_manager_a_network_and_a_controller_that_are_gone() -> None:
    for cell, distro in (("ur5e_pick", "jazzy"), ("fr3_hand", "humble")):
        audit = artifacts_of(cell, distro)["audit.md"].split("\n## Recovery\n")[1].replace("\\", "")
        for title in ("If a controller manager ended:", "arm, network_lost:", "arm, controller_rebooted:"):
            steps = audit.split(f"\n{title}\n\n")[1].split("\n\n")[0]
            assert re.search("[Rr]epeat from gate G3", steps), title


def test_ending_gives_claims_back_before_the_driver_ends_and_tools_come_before_what_carries_them() -> None:
    def steps(cell: str, distro: str) -> str:
        return artifacts_of(cell, distro)["audit.md"].split("\n## Shutdown\n")[1].split("\n## ")[0]

    for cell, distro, words in (
        (
            "ur5e_pick",
            "jazzy",
            ("--deactivate arm", "gripper: Make sure that no part is held", "Stop the program", "Ctrl-C"),
        ),
        ("fr3_hand", "humble", ("--deactivate arm", "with Ctrl-C", "Release FCI", "Close the brakes")),
    ):
        places = [steps(cell, distro).replace("\\", "").index(word) for word in words]
        assert places == sorted(places)
    assert "arm_io" not in steps("ur5e_pick", "jazzy")  # it claims no joint


def test_calibration_is_read_off_a_robot_that_is_powered_into_a_file_whose_folder_exists() -> None:
    # Universal_Robots_ROS2_Driver, robot_setup.rst:20-41; calibration_correction.cpp:85-130: the folder must be there.
    artifacts = artifacts_of("ur5e_pick")
    layer = artifacts["gates/network.md"].split("\n## L2")[1].split("\n## ")[0]
    assert 'target_filename:="$(pwd)"/cells/ur5e_pick/arm_calibration.yaml' in layer
    assert "robot powered on and idle with its brakes closed, its drives disabled" in layer
    assert "ros2 launch ur_calibration" not in artifacts["gates/promotion.md"]
    assert "<exec_depend>ur_calibration</exec_depend>" in artifacts["package.xml"]


def test_what_no_distribution_releases_is_built_before_the_package_that_needs_it() -> None:
    for cell, distro in (("ur5e_pick", "jazzy"), ("fr3_hand", "humble")):
        page = artifacts_of(cell, distro)["README.md"]
        words = (f"vcs import src < generated/{cell}/sources.repos", "rosdep install --from-paths src")
        places = [page.index(word) for word in (*words, "--base-paths src", f"--packages-select {cell}")]
        assert places == sorted(places)


def test_what_the_mock_alone_has_is_told_and_not_recorded_on_the_real_target() -> None:
    artifacts = artifacts_of("fr3_hand")
    assert "position_controllers/GripperActionController | control_pc (mock) |" in artifacts["audit.md"].replace(
        "\\", ""
    )
    gate = artifacts["gates/promotion.md"].split("\n## G7")[1]
    record = gate.split("ros2 bag record")[1].split("```")[0]
    assert "/hand_action/" not in record
    assert "/hand_gripper/gripper_action/_action/status" in record


def test_goals_of_a_gripper_have_the_units_of_its_joint() -> None:
    # franka_gripper 2.5.0, gripper_action_server.cpp:167,173: a goal is half of the width that the result has.
    actions = artifacts_of("fr3_hand")["audit.md"].split("\n## Expected actions\n")[1].split("\n## ")[0]
    (row,) = (line for line in actions.splitlines() if "gripper" in line and "(real target)" in line)
    assert "half the width" in row
    assert "rad" not in row


@pytest.mark.parametrize("cell", CELLS)
def test_command_path_is_shown_by_runs_that_cancel_and_violate(cell: str) -> None:
    # Declared rehearsals need not do either; the campaign behind `cellc gates` does both to every controller.
    section = artifacts_of(cell)["gates/network.md"].split("## L6")[1]
    assert f"cellc gates generated/{cell} 2>&1" in section


def test_first_motion_is_said_with_all_its_bounds() -> None:
    text = artifacts_of("ur5e_pick")["gates/promotion.md"]
    assert "joint arm/wrist_3_joint, direction +, at most 5 deg, 5 deg/s, ends within 5 s" in text
    assert "Stop on:** wrong direction; overshoot; unexpected sound." in text


def test_every_unknown_of_the_spec_stands_in_audit_and_readme() -> None:
    artifacts = artifacts_of("ur5e_pick")
    for path in ("devices.arm.revision", "devices.gripper.firmware", "versions.rollback.image"):
        assert f"`{path}`" in artifacts["audit.md"]
        assert f"`{path}`" in artifacts["README.md"]
    assert "`devices.arm.firmware`" not in artifacts["audit.md"]


def test_recording_holds_the_motion_path_with_profiles_that_match_every_publisher() -> None:
    profiles = safe_load(artifacts_of("ur5e_pick")["config/recording_qos.yaml"])
    assert {"/object_pose", "/tf", "/tf_static", "/joint_states", "/diagnostics"} <= set(profiles)
    assert "/arm_trajectory/follow_joint_trajectory/_action/status" in profiles
    assert not any("image" in name for name in profiles)
    # qos.md: the static broadcaster is latched, the dynamic one volatile; a reader must not ask for more.
    assert profiles["/tf_static"]["durability"] == "transient_local"
    assert profiles["/tf"]["durability"] == "volatile"


def test_recorder_keeps_what_comes_while_it_waits_for_its_disk() -> None:
    profiles = safe_load(artifacts_of("ur5e_pick")["config/recording_qos.yaml"])
    # A second of joint states at 500 Hz; one static transform of each of a hundred publishers, as tf2's listeners keep.
    assert {name: profiles[name]["depth"] for name in ("/joint_states", "/tf_static")} == {
        "/joint_states": 500,
        "/tf_static": 100,
    }


def test_data_flow_names_everyone_on_the_way_to_the_drives() -> None:
    readme = artifacts_of("ur5e_pick")["README.md"]
    flow = readme.partition("\n## Data flow\n")[2].partition("\n## ")[0]
    steps = [
        "perception publishes",
        "task sends goals to move_group",
        "move_group sends goals to arm_trajectory",
        "writes to arm",
    ]
    steps += ["vendor controller of arm", "safety_plc stops the cell"]
    places = [flow.index(step) for step in steps]
    assert places == sorted(places)


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("page", ["gates/promotion.md", "gates/network.md"])
def test_commands_are_as_wide_as_paper_and_read_by_a_shell_as_one(page: str, cell: str) -> None:
    blocks = re.findall(r"^  ```sh\n(.*?)^  ```$", artifacts_of(cell)[page], flags=re.DOTALL | re.MULTILINE)
    for block in blocks:
        run(["bash", "-n"], input=block, text=True, check=True, capture_output=True)
        for line in block.splitlines():
            assert len(line) <= 82 or len(line.split()) <= 2, line
