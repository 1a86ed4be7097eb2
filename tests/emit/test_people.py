"""Checklists, audit and recording: complete, in order, and without a command that moves anything."""

from __future__ import annotations

import json
import re
from xml.etree import ElementTree

import pytest
import yaml

from tests.emit.cells import CELLS, artifacts_of

# What a checklist may tell people to type: reading commands, and starting what its gate releases.
_ALLOWED = (
    "cat ",
    "cellc build ",
    "cellc mock ",
    "chronyc tracking",
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
    "ros2 service type ",
    "ros2 topic delay ",
    "ros2 topic echo ",
    "ros2 topic hz ",
    "ros2 topic info ",
    "sha256sum ",
    "uname -r",
    "xacro ",
)


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(("page", "letter", "numbers"), [("promotion", "G", range(8)), ("network", "L", range(1, 7))])
def test_gates_stand_in_order_with_evidence_and_stop(page: str, letter: str, numbers: range, cell: str) -> None:
    sections = re.split(r"^## ", artifacts_of(cell)[f"gates/{page}.md"], flags=re.MULTILINE)[1:]
    assert [section.split()[0] for section in sections] == [f"{letter}{number}" for number in numbers]
    for section in sections:
        assert "- [ ] " in section
        assert re.search(rf"Evidence: `evidence/<attempt_id>/{section.split()[0]}-[\w.-]+`", section)
        assert re.search(r"\*\*Stop, and do not go on, on:\*\* \S", section)


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("page", ["gates/promotion.md", "gates/network.md", "README.md"])
def test_commands_only_read(page: str, cell: str) -> None:
    text = artifacts_of(cell)[page].rpartition("## The walk")[2]
    blocks = re.findall(r"```sh\n(.*?)```", text, flags=re.DOTALL)
    lines = "\n".join(blocks).replace("\\\n", " ").splitlines()
    commands = [line.strip() for line in lines if line.strip() and not re.match(r"\s*(#|\{|\})", line)]
    assert commands
    for command in commands:
        assert re.sub(r"^timeout \d+ ", "", command).startswith(_ALLOWED), command


def test_first_motion_is_said_with_all_its_bounds() -> None:
    text = artifacts_of("ur5e_pick")["gates/promotion.md"]
    assert "joint arm/wrist_3_joint, direction +, at most 5 deg, 5 deg/s, ends within 5 s" in text
    assert "on:** wrong direction; overshoot; unexpected sound." in text


def test_every_unknown_of_the_spec_stands_in_audit_and_readme() -> None:
    artifacts = artifacts_of("ur5e_pick")
    for path in ("devices.arm.revision", "devices.gripper.firmware", "versions.rollback.image"):
        assert f"`{path}`" in artifacts["audit.md"]
        assert f"`{path}`" in artifacts["README.md"]
    assert "`devices.arm.firmware`" not in artifacts["audit.md"]


def test_recording_holds_the_motion_path_with_profiles_that_match_every_publisher() -> None:
    profiles = yaml.safe_load(artifacts_of("ur5e_pick")["config/recording_qos.yaml"])
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


@pytest.mark.parametrize("cell", [*CELLS, "fr3_hand"])
@pytest.mark.parametrize("sheet", ["responsibility.svg", "responsibility.phone.svg"])
def test_picture_labels_every_arrow_and_keeps_its_text_inside(cell: str, sheet: str) -> None:
    text = artifacts_of(cell)[f"graph/{sheet}"]
    picture = ElementTree.fromstring(text)
    space = "{http://www.w3.org/2000/svg}"
    said = [entry.text or "" for entry in picture.iter(f"{space}text")]
    arrows = len(list(picture.iter(f"{space}line")))
    contract = json.loads(artifacts_of(cell)["contract.json"])
    assert set(contract["interfaces"]) <= set(said)
    claiming = [c for m in contract["managers"].values() for c in m["controllers"].values() if c["command_interfaces"]]
    driven = [device for device in contract["devices"].values() if device["driver"]]
    assert arrows == len(contract["interfaces"]) + len(claiming) + len(driven) + 1  # and the physical stop
    assert sum(entry.startswith("owner ") for entry in said) == arrows
    width, height = (float(value) for value in picture.attrib["viewBox"].split()[2:])
    letter = 8.0 * float(picture.attrib["font-size"]) / 13.0
    for entry in picture.iter(f"{space}text"):
        # 8 units a character of 13 is wider than any sans-serif sets on average.
        assert float(entry.attrib["x"]) + letter * len(entry.text or "") <= width
        assert float(entry.attrib["y"]) <= height
    bold = [rect for rect in picture.iter(f"{space}rect") if rect.get("stroke-width") == "5"]
    assert len(bold) == 2
    assert "<script" not in text
    assert "href" not in text


def test_sheets_and_diagram_say_the_same_of_every_arrow() -> None:
    artifacts = artifacts_of("ur5e_pick")
    space = "{http://www.w3.org/2000/svg}"
    sheets = [
        " ".join(entry.text or "" for entry in ElementTree.fromstring(artifacts[f"graph/{name}"]).iter(f"{space}text"))
        for name in ("responsibility.svg", "responsibility.phone.svg")
    ]
    labels = re.findall(r'"([^"]+)"', artifacts["graph/responsibility.mmd"].split("  end\n")[-1])
    facts = [fact for label in labels if label.count("<br/>") > 1 for fact in label.split("<br/>")]
    assert len(facts) > 30
    for fact in facts:
        assert all(fact in sheet for sheet in sheets), fact


@pytest.mark.parametrize("cell", [*CELLS, "fr3_hand"])
def test_nothing_that_is_known_of_an_arrow_is_called_not_stated(cell: str) -> None:
    diagram = artifacts_of(cell)["graph/responsibility.mmd"]
    for name in ("/tf", "/tf_static", "/robot_description", "/joint_states"):
        (label,) = re.findall(rf'"({name}<br/>[^"]+)"', diagram)
        assert "not stated" not in label.replace("owner not stated", ""), label
    assert "/tf<br/>topic tf2_msgs/msg/TFMessage, 20 Hz" in diagram


@pytest.mark.parametrize("cell", CELLS)
def test_graph_draws_vendor_control_and_physical_safety_bold_and_apart(cell: str) -> None:
    diagram = artifacts_of(cell)["graph/responsibility.mmd"]
    for boundary in ("vendor", "safety"):
        assert re.search(rf"^  subgraph {boundary}\[", diagram, re.MULTILINE)
        assert re.search(rf"^  style {boundary} stroke-width:5px", diagram, re.MULTILINE)
    boxes = re.findall(r"^ *(\w+)\[\"", diagram, re.MULTILINE)
    assert len(boxes) == len(set(boxes))
    for start, end in re.findall(r"^  (\w+) (?:--|==|-\.->).*?(\w+)$", diagram, re.MULTILINE):
        assert {start, end} <= set(boxes), (start, end)
