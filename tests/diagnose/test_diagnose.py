"""Symptoms and log lines are classified by layer, and every step only looks."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import ValidationError

from cellc.compiler.cell.cell import Cell
from cellc.compiler.pipeline import check
from cellc.tools.diagnose.classify import classify
from cellc.tools.diagnose.diagnose import Step, diagnose
from cellc.tools.diagnose.symptoms import LAYERS, Observation, Symptom, knowledge
from tests.cells import ROOT
from tests.foreign_yaml import safe_load
from tests.oracles import RECORDED

SECTIONS = {
    line[3:].lower().replace(" ", "-")
    for line in (ROOT / "docs" / "principles.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("## ")
}
EVERY_SYMPTOM = [symptom for layer in knowledge() for symptom in layer.symptoms]

# The rows of the chapter's table "Symptom-driven troubleshooting", and where its "first layer" stands in prompt C.
CHAPTER = [
    ("Nodes cannot see each other", "network", "firewall"),
    ("Topic exists, no data", "qos", "queue"),
    ("TF extrapolation", "time", "latest"),
    ("Plan succeeds, execute fails", "ownership", "force"),
    ("Trajectory unexpectedly slow", "vendor", "timing"),
    ("Repeated protective stop", "tool", "safety limits"),
    ("Motion after reconnect", "ownership", "watchdog"),
    ("RViz TCP differs from real", "time", "offset"),
]

# Lines as the real programs wrote them (tests/oracles; rclcpp and tf2 sources), with the layer of their cause.
LINES = [
    (
        "[WARN] [controller_manager]: Unable to activate controller 'arm_controller' since the command interface "
        "'joint1/position' is currently claimed by another controller.",
        "ownership",
        {("controller", "arm_controller"), ("interface", "joint1/position")},
    ),
    (
        "[ERROR] [controller_manager]: The 'type' param was not defined for 'joint_state_broadcaster'.",
        "lifecycle",
        {("controller", "joint_state_broadcaster")},
    ),
    (
        "[ERROR] [controller_manager]: Error importing joint limiters: no 'ros2_control' tag found in the URDF",
        "lifecycle",
        {("reason", "no 'ros2_control' tag found in the URDF")},
    ),
    (
        "[ERROR] [arm_controller] Incoming joint jointX doesn't match the controller's joints.",
        "ownership",
        {("joint", "jointX")},
    ),
    ("[INFO] [arm_controller.speed_scaling] New scaling factor will be 0.500000", "vendor", {("factor", "0.500000")}),
    (
        "New subscription discovered on topic '/chatter', requesting incompatible QoS. No messages will be sent to it. "
        "Last incompatible policy: RELIABILITY",
        "qos",
        {("topic", "/chatter"), ("policy", "RELIABILITY")},
    ),
    (
        "Lookup would require extrapolation into the future.  Requested time 12.1 but the latest data is at time 12.0, "
        "when looking up transform from frame [object] to frame [world]",
        "time",
        {("frame", "object"), ("target", "world")},
    ),
]


@pytest.fixture(scope="module")
def cell() -> Cell:
    graph = check(ROOT / "cells/ur5e_pick/cell.yaml").graph
    assert graph is not None
    return graph.cell


def steps(text: str, cell: Cell | None) -> Iterator[Step]:
    for suspicion in diagnose(text, cell).suspicions:
        for cause in suspicion.causes:
            yield from cause.steps


@pytest.mark.parametrize(("text", "layer", "shortcut"), CHAPTER)
def test_rows_of_the_chapters_table_are_classified(text: str, layer: str, shortcut: str) -> None:
    best = classify(text, knowledge()).matches[0]
    assert best.layer.layer == layer
    assert shortcut in best.symptom.never


@pytest.mark.parametrize(("line", "layer", "named"), LINES)
def test_line_of_a_real_program_is_recognised(line: str, layer: str, named: set[tuple[str, str]]) -> None:
    best = classify(line, knowledge()).matches[0]
    assert best.layer.layer == layer
    assert set(best.named) == named


def test_errors_of_the_recorded_runs_are_recognised() -> None:
    # Two warnings of the recordings have no cause in a cell: a resized buffer and a deprecated call.
    harmless = ("Trajectory to stop on cancel exceeds", "Casting bool to double")
    lines = {line for file in sorted(RECORDED.rglob("*.yaml")) for line in _lines(file)}
    problems = [line for line in lines if re.search(r"\[(WARN|ERROR|FATAL)\]", line)]
    assert len(problems) > 100
    unknown = [line for line in problems if not classify(line, knowledge()).fits]
    assert [line for line in unknown if not any(text in line for text in harmless)] == []


def test_log_line_is_not_distracted_by_words_that_happen_to_fit() -> None:
    line = "slow topic, no data: Could not initialize the controller named 'arm'"
    assert classify(line, knowledge()).matches[0].layer.layer == "lifecycle"


def test_symptom_that_fits_in_more_words_comes_first() -> None:
    found = classify("stale image, and the plan succeeds but execute fails", knowledge())
    assert [match.layer.layer for match in found.matches][:2] == ["ownership", "qos"]


def test_every_layer_of_the_chapter_is_there_once() -> None:
    assert tuple(layer.layer for layer in knowledge()) == LAYERS


def test_names_of_the_cell_stand_in_the_commands(cell: Cell) -> None:
    best = diagnose("no data on /object_pose", cell).suspicions[0]
    actions = {step.action for cause in best.causes for step in cause.steps}
    assert "ros2 topic info --verbose /object_pose" in actions
    assert not any("/camera" in action for action in actions)


def test_expected_values_come_from_the_cell(cell: Cell) -> None:
    refuted = " ".join(step.refuted for step in steps("nodes cannot see each other", cell))
    assert "prints 42" in refuted
    assert "rmw_fastrtps_cpp" in refuted


def test_owner_is_the_one_of_the_cells_approval_area(cell: Cell) -> None:
    assert diagnose("tf extrapolation", cell).suspicions[0].owner == "perception"


def test_controller_that_the_cell_does_not_have_is_told(cell: Cell) -> None:
    (suspicion, *_) = diagnose("Could not initialize the controller named 'other_arm'", cell).suspicions
    assert suspicion.unknown == ("controller `other_arm`",)


def test_unknown_symptom_is_unknown(cell: Cell) -> None:
    answer = diagnose("the coffee is cold", cell)
    assert (answer.fits, answer.suspicions) == (False, ())
    assert (answer.yes, answer.no)[0][0] == "camera and perception"
    assert {*answer.yes, *answer.no} == {layer.title for layer in knowledge()}


@pytest.mark.parametrize("symptom", EVERY_SYMPTOM, ids=lambda symptom: symptom.name)
def test_every_symptom_has_a_source_a_way_to_be_found_and_a_warning(symptom: Symptom) -> None:
    assert symptom.source
    assert "chapter" not in symptom.source
    for section in re.findall(r"docs/principles\.md#([\w-]+)", symptom.source):
        assert section in SECTIONS
    assert symptom.never
    assert symptom.said or symptom.logged


def test_nothing_is_left_to_fill_in_where_the_cell_is_known(cell: Cell) -> None:
    for symptom in EVERY_SYMPTOM:
        for step in steps(symptom.name, cell):
            assert not re.search(r"[<{}]", step.action + step.refuted), step


@pytest.mark.parametrize(
    "command",
    [
        "ros2 control switch_controllers --activate arm",
        "ros2 param set /arm use_sim_time true",
        "ros2 topic pub /x std_msgs/msg/Empty",
        "ros2 service call /unlock std_srvs/srv/Trigger",
        "ros2 lifecycle set /perception activate",
        "ros2 topic echo /joint_states",
        "ros2 node list; systemctl stop ufw",
        "ros2 node list && ros2 action send_goal /a b c",
        "ufw disable",
    ],
)
def test_command_that_acts_is_no_observation(command: str) -> None:
    with pytest.raises(ValidationError, match="only reads"):
        Observation(of="cell", run=command, refuted="never")


@pytest.mark.parametrize("action", [{}, {"run": "ros2 node list", "look": "the panel"}])
def test_observation_runs_one_command_or_looks_at_one_thing(action: dict[str, str]) -> None:
    with pytest.raises(ValidationError, match="either runs a command or looks"):
        Observation.model_validate({"of": "cell", "refuted": "never", **action})


def test_field_that_the_scope_does_not_have_is_refused() -> None:
    with pytest.raises(ValidationError, match="has no frame"):
        Observation(of="topic", run="ros2 topic hz {frame}", refuted="never")


def _lines(file: Path) -> Iterator[str]:
    def walk(data: object) -> Iterator[str]:
        if isinstance(data, dict):
            for key, value in data.items():
                texts = value if isinstance(value, list) else [value]
                if key in ("log", "messages"):
                    yield from (text for text in texts if isinstance(text, str))
                else:
                    yield from walk(value)
        elif isinstance(data, list):
            for item in data:
                yield from walk(item)

    yield from walk(safe_load(file.read_text(encoding="utf-8")))
