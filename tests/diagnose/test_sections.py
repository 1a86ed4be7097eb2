"""Parts of a cell, where no symptom fits well: which one a text is of, what halves it, what a command cannot tell."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.tools.diagnose.classify import classify
from cellc.tools.diagnose.diagnose import Step, diagnose
from cellc.tools.diagnose.naming import NO_NODE
from cellc.tools.diagnose.sections import blind_to, placed, sections
from cellc.tools.diagnose.symptoms import LAYERS, knowledge
from tests.cells import ROOT, linked
from tests.cli.run import run

CELL = ROOT / "cells/ur5e_pick/cell.yaml"
SECTIONS = {section.name: section for section in sections().sections}

# A line or a sentence of our own → a piece of the name of its part, and whether a log or a device names it.
PLACES = {
    "[ros2_control_node-1] [ERROR] [1.2] [left_wheel]: SDO abort 0x06090011 of node 5": ("field bus", True),
    "kernel: usb 1-4: usbfs: process 812 did not claim interface 0 before use": ("on USB", True),
    "marker_length = 0,05000 in detector.ini": ("figures", True),
    "[ERROR] [1.2] [move_group]: Catastrophic": ("MoveIt", True),
    "[rmw_cyclonedds_cpp]: cannot set it up": ("middleware", True),
    "2,500 points of the cloud are tilted": ("picture", False),
    "the motor of j4 is inactive": ("field bus", False),
    "the tag is slightly off": ("picture", False),
    "one parameter of the yaml has no prefix": ("description", False),
}


@pytest.mark.parametrize("text", PLACES)
def test_part_is_that_of_what_a_log_names_and_else_of_the_words(text: str) -> None:
    place = placed(text)
    assert place is not None
    assert (PLACES[text][0] in place.section.name, place.is_named) == (True, PLACES[text][1])


def test_text_that_names_no_part_is_of_the_layer_of_the_first_proposal() -> None:
    assert placed("it is odd") is None
    for layer in LAYERS:
        place = placed("it is odd", [layer])
        assert place is not None
        assert layer in place.section.layers


def test_every_part_has_a_question_that_its_first_step_answers_and_public_sources() -> None:
    for section in SECTIONS.values():
        assert section.ask.endswith("?"), section.name
        assert re.search(r"https://|REP \d|docs/|\(\d\)", section.source), section.name
        for pattern in (*section.origins, *section.says):
            assert not re.search(pattern, "zq"), pattern


def test_every_pattern_of_what_commands_cannot_tell_is_of_some_observation() -> None:
    seen = [
        (observation.action, hypothesis.cause)
        for layer in knowledge()
        for symptom in layer.symptoms
        for hypothesis in symptom.hypotheses
        for observation in hypothesis.observations
    ]
    unused = [
        row.command
        for row in sections().blind
        if not any(action.startswith(row.command) and re.search(row.of, cause) for action, cause in seen)
    ]
    assert unused == []
    assert blind_to("uname -v", "the kernel is not preemptible") == ""


def steps(text: str) -> list[Step]:
    answer = diagnose(text, linked(CELL))
    return [step for each in answer.suspicions for cause in each.causes for step in cause.steps]


def test_listener_drops_and_one_shell_rule_out_nothing_that_they_do_not_see() -> None:
    by_action = {step.action: step.blind for step in steps("the host cannot reach the device")}
    assert "does not show that the device gets through" in by_action["ss -lntup"]
    shell = {step.action: step.blind for step in steps("nodes cannot see each other")}
    assert "/proc/PID/environ" in shell["printenv ROS_DOMAIN_ID"]
    out = run("diagnose", "nodes cannot see each other", CELL.as_posix()).out
    assert re.search(
        r"\$ printenv ROS_DOMAIN_ID\n       less likely if .*prints 42.*\n       not more than that: ", out
    )


def test_weak_fit_begins_with_the_part_and_a_good_one_ends_with_it() -> None:
    text = "a strange thing happened yesterday while our technician took a cup of tea: al status 0x24 of the third box"
    weak = run("diagnose", text, CELL.as_posix()).out
    assert weak.startswith("not sure, no known symptom fits well; the part is likely: field bus and its drives\n")
    assert weak.index("field bus and its drives, in this order") < weak.index("or, by their words alone, one of these:")
    good = run("diagnose", "octomap is not refreshed after the obstacle is removed", CELL.as_posix()).out
    assert good.index("obstacles stay in the map of the camera") < good.index("if none of these: from a request to a")
    assert "in this order" not in run("diagnose", "nodes cannot see each other").out


def test_what_works_is_compared_with_what_does_not() -> None:
    answer = diagnose("with MoveIt it moves, my own code does not move the arm", linked(CELL))
    assert answer.routes[0].name == "what the case that works and the case that fails do not share"
    assert "ros2_control" in answer.routes[-1].name
    assert "planning" not in {suspicion.layer for suspicion in answer.suspicions[:1]}


def test_question_is_the_one_that_tells_most_of_what_is_likely() -> None:
    refused = classify("tcp recv error : 192.168.5.1:30003 connect : Connection refused.", knowledge())
    assert refused.question is not None
    assert {match.symptom.name for match in refused.question.yes} == {"the host cannot reach the device"}
    kernel = classify("libfranka: unable to set realtime scheduling: Operation not permitted", knowledge())
    assert kernel.question is not None
    assert kernel.question.ask == SECTIONS["real time on the host"].ask
    assert {match.layer.layer for match in kernel.question.no} == {"realtime"}


def test_logger_is_no_node_unless_the_cell_has_it() -> None:
    line = "[x-4] [INFO] [1.5] [{}]: Didn't receive robot state (joint angles) with recent timestamp within 1 seconds."
    of_client = [step.action for step in steps(line.format("move_group_interface"))]
    assert "ros2 node list --no-daemon" in of_client
    assert f"ros2 param get {NO_NODE} use_sim_time" in of_client
    assert not any("move_group_interface" in action for action in of_client)
    of_node = [step.action for step in steps(line.format("move_group.moveit.current_state_monitor"))]
    assert "ros2 param get /move_group use_sim_time" in of_node
    assert not any(NO_NODE in action for action in of_node)


@pytest.mark.parametrize(
    "said", ["the drive cannot reach OP, al status 0x001b", "libfranka: Move command rejected: command not possible"]
)
def test_log_without_levels_is_answered_as_the_sentence_is(said: str, tmp_path: Path) -> None:
    (tmp_path / "a.log").write_text(f"{said}\n", encoding="utf-8")
    assert run("diagnose", "--log", tmp_path.as_posix()).out == run("diagnose", said).out


def test_log_of_no_gravity_is_no_failure_and_its_part_is_shown_nevertheless(tmp_path: Path) -> None:
    (tmp_path / "a.log").write_text("[INFO] [1.5] [UR_Client_Library]: Sent program to robot\n", encoding="utf-8")
    ran = run("diagnose", "--log", tmp_path.as_posix())
    assert ran.code == 0
    assert "if something is wrong nevertheless: the vendor's interface between driver and robot, in this" in ran.out
