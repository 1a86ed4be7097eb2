"""``cellc diagnose`` as a user meets it."""

from __future__ import annotations

from pathlib import Path

from tests.cli.run import PICK, run


def test_diagnosis_tells_layer_command_shortcut_and_owner() -> None:
    ran = run("diagnose", "nodes cannot see each other", PICK)
    assert ran.code == 0
    assert ran.out.startswith("network and discovery: nodes cannot see each other\n")
    assert "$ printenv ROS_DOMAIN_ID" in ran.out
    assert "do not: disable the firewall as a whole" in ran.out
    assert "who decides: network" in ran.out


def test_diagnosis_without_a_cell_has_placeholders() -> None:
    assert "ros2 topic hz <topic>" in run("diagnose", "topic exists, no data").out


def test_unknown_symptom_is_told_with_the_layers_and_exit_code_1() -> None:
    ran = run("diagnose", "the coffee is cold", PICK)
    assert ran.code == 1
    assert ran.out.startswith("UNKNOWN")
    assert "safety state" in ran.out


def test_cell_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    ran = run("diagnose", "slow", (tmp_path / "none.yaml").as_posix())
    assert ran.code == 1
    assert "file-not-found" in ran.out


def test_hostile_log_line_cannot_steer_the_terminal() -> None:
    line = "Could not initialize the controller named 'a\x1b[2Jb'"
    assert "\x1b" not in run("diagnose", line, PICK).out
