"""Checklists, audit and recording: complete, in order, and without a command that moves anything."""

from __future__ import annotations

import re

import pytest

from tests.emit.cells import CELLS, artifacts_of
from tests.foreign_yaml import safe_load

# What a checklist may tell people to type: reading commands, and starting what its gate releases.
_ALLOWED = (
    "cat ",
    "cellc build ",
    "cellc mock ",
    "chronyc tracking",
    "git -C src/ros2_robotiq_gripper rev-parse HEAD",
    "grep ",
    "ip ",
    "lsb_release -ds",
    "ping -c ",
    "printenv ",
    "ros2 action info ",
    "ros2 bag record ",
    "ros2 control list_",
    "ros2 launch ",
    "ros2 lifecycle get ",
    "ros2 node list",
    "ros2 param get ",
    "ros2 pkg xml -t version ",
    "ros2 run tf2_ros tf2_",
    "ros2 security list_enclaves ",
    "ros2 service type ",
    "ros2 topic delay ",
    "ros2 topic echo ",
    "ros2 topic hz ",
    "ros2 topic info ",
    "sha256sum ",
    "uname -r",
    "xacro ",
)
# What may take their output: it is looked at, and appended to the evidence.
_AFTER_A_PIPE = (
    "check_urdf /dev/stdin",
    "grep ",
    "head -n ",
    "tail -n ",
    'tee -a "$E/',
    "xargs -r -d '\\n' grep ",
    "xargs -r -d '\\n' ls -t",
)


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(("page", "letter", "numbers"), [("promotion", "G", range(8)), ("network", "L", range(1, 7))])
def test_gates_stand_in_order_with_evidence_and_stop(page: str, letter: str, numbers: range, cell: str) -> None:
    sections = re.split(r"^## ", artifacts_of(cell)[f"gates/{page}.md"], flags=re.MULTILINE)[1:]
    assert [section.split()[0] for section in sections] == [f"{letter}{number}" for number in numbers]
    for section in sections:
        assert "- [ ] " in section
        assert re.search(rf"Evidence `{section.split()[0]}-[\w.-]+`, signed by ", section)
        assert re.search(r"\*\*Stop on:\*\* \S", section)


def test_inventory_asks_for_a_commit_where_the_source_lies_that_the_workspace_imports() -> None:
    page = artifacts_of("ur5e_pick")["gates/promotion.md"]
    assert "gripper.driver is `robotiq_driver 3b6cf8f`, a commit" in page
    assert "git -C src/ros2_robotiq_gripper rev-parse HEAD" in page
    assert "  ros2_robotiq_gripper:\n" in artifacts_of("ur5e_pick")["sources.repos"]
    # Its number never moved: no package could agree with the pin.
    assert "ros2 pkg xml -t version robotiq_driver" not in page


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("page", ["gates/promotion.md", "gates/network.md"])
def test_commands_only_read(page: str, cell: str) -> None:
    blocks = re.findall(r"```sh\n(.*?)```", artifacts_of(cell)[page], flags=re.DOTALL)
    lines = "\n".join(blocks).replace("\\\n", " ").splitlines()
    commands = [line.strip().removeprefix("{ ") for line in lines if not re.match(r"\s*(\{|\}.*)?$", line)]
    assert len(commands) > 10
    for command in commands:
        first, *others = re.sub(r"^timeout \d+ ", "", command).split(" | ")
        assert first.startswith(_ALLOWED), command
        assert all(other.startswith(_AFTER_A_PIPE) for other in others), command


@pytest.mark.parametrize("cell", CELLS)
def test_command_path_is_shown_by_runs_that_cancel_and_violate(cell: str) -> None:
    # Declared rehearsals need not do either; the campaign behind --gates does both to every controller.
    section = artifacts_of(cell)["gates/network.md"].split("## L6")[1]
    assert f"cellc mock generated/{cell} --gates 2>&1" in section


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


def test_sentence_names_everyone_on_the_way_to_the_drives() -> None:
    readme = artifacts_of("ur5e_pick")["README.md"]
    (sentence,) = (line for line in readme.splitlines() if line.startswith("Camera publishes"))
    steps = [
        "perception publishes",
        "task asks move_group",
        "move_group sends goals to arm_trajectory",
        "writes to arm",
    ]
    steps += ["vendor controller of arm", "safety_plc stops the cell"]
    places = [sentence.index(step) for step in steps]
    assert places == sorted(places)
