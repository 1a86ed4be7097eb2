"""What a text states beside its symptom: questions it answers are not asked, and what it excludes is not proposed."""

from __future__ import annotations

import pytest

from cellc.tools.diagnose.diagnose import Answer, diagnose
from cellc.tools.diagnose.evidence import stated
from cellc.tools.diagnose.sections import sections
from cellc.tools.diagnose.symptoms import evidence, knowledge, questions
from tests.cells import ROOT, linked

CELL = ROOT / "cells/ur5e_pick/cell.yaml"

STATEMENTS = {
    # One text that says it, and one that says the contrary or something else.
    "ping reaches the device": ("I can ping the robot, the driver times out", "I cannot ping the robot"),
    "the device is on USB or a serial line": ("gripper on /dev/ttyUSB0 is silent", "driver waits for 192.168.56.101"),
    "the topic is listed": ("the topic is listed but echo prints nothing", "the topic is not listed"),
    "the program on the device runs": ("program is running on the pendant", "the program is not running"),
    "brakes are open and the drives are on": ("brakes are released, nothing moves", "arm drops when brakes release"),
    "it works in simulation or with mock hardware": ("it works in gazebo", "it does not work in gazebo"),
    "it works with the maker's own tool or panel": ("moves from the pendant", "not even the pendant moves it"),
    "it works on the host and not in the container": ("works on the host, not in docker", "docker is slow"),
    "it works with sudo": ("it works with sudo", "it does not work with sudo either"),
    "it works the first time and not again": ("the first goal moves, the second hangs", "the first goal hangs"),
    "it works with another cable, port or computer": ("works with another cable", "same with another cable"),
    "the cable, port or computer was exchanged and it stays": ("tried another cable", "a new cable fixed it"),
    "the controller is active": ("the controller is active", "the controller is inactive"),
    "the value is off by the factor of a unit": ("joints are 57 times too large", "joints are too large"),
    "one program works and another does not": ("it works fine, but when using this node it fails", "it fails"),
    "the robot moves with the planner": ("with MoveIt it moves", "it does not move with MoveIt"),
    "it began with an update or another version": ("after the update it stutters", "the update rate is 500 Hz"),
    "it happens sometimes or after a while": ("sometimes it stops", "it never moves"),
    "it runs in a container": ("the driver runs in docker", "without docker it is slow"),
}


def test_every_statement_is_tried() -> None:
    assert sorted(STATEMENTS) == sorted(row.stated for row in evidence().evidence)


@pytest.mark.parametrize("name", STATEMENTS)
def test_statement_is_read_and_its_contrary_is_not(name: str) -> None:
    says, denies = STATEMENTS[name]
    assert name in stated(says).names
    assert name not in stated(denies).names


def test_what_a_statement_speaks_of_is_there() -> None:
    symptoms = [symptom for layer in knowledge() for symptom in layer.symptoms]
    names = {symptom.name for symptom in symptoms}
    compared = {stated for each in sections().contrasts for stated in each.stated}
    assert compared <= {row.stated for row in evidence().evidence}
    causes = [each.cause for symptom in symptoms for each in symptom.hypotheses]
    seen = [
        " ".join((observation.run or observation.look or "", observation.refuted))
        for symptom in symptoms
        for each in symptom.hypotheses
        for observation in each.observations
    ]
    asked = str(questions()) + " ".join(symptom.ask or "" for symptom in symptoms)
    for row in evidence().evidence:
        assert {*row.strengthens, *row.weakens} <= names, row.stated
        assert row.answers or row.rules_out or row.likelier or row.clears or row.stated in compared, row.stated
        for piece in (*row.rules_out, *row.likelier):
            assert any(piece in cause for cause in causes), (row.stated, piece)
        for piece in row.leaves_out:
            assert any(piece in text for text in seen), (row.stated, piece)
        for piece in row.answers:
            assert piece in asked, (row.stated, piece)


def _all(answer: Answer) -> str:
    steps = (step for each in answer.suspicions for cause in each.causes for step in cause.steps)
    return "\n".join((answer.ask, *(f"{step.action} {step.refuted}" for step in steps)))


def test_who_can_ping_is_not_asked_to_ping() -> None:
    assert "ping" in _all(diagnose("the driver does not connect to the robot", linked(CELL)))
    assert "ping" not in _all(diagnose("I can ping the robot, the driver does not connect to it", linked(CELL)))


def test_device_on_a_serial_line_has_no_network() -> None:
    said = _all(diagnose("gripper on /dev/ttyUSB0 does not answer", linked(CELL)))
    assert "/dev/ttyUSB0" in said
    assert "subnet" not in said
    assert "not stated" not in said


def test_command_is_for_the_topic_that_the_text_names() -> None:
    said = _all(diagnose("ros2 topic echo /left/joint_states prints nothing", linked(CELL)))
    assert "ros2 topic info --verbose /left/joint_states" in said
    assert "/object_pose" not in said
