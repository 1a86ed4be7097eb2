"""What a reader who knows the vendors missed in the gates: lines at their place, and in the words of each device."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import pytest

from cellc.compiler.catalog.compiled import CATALOG
from cellc.compiler.catalog.load import device_names
from tests.cells import EVERY_CELL, built, compiled, device_of, spec_text, written

_WALKED = ("ur5e_pick", "fr3_hand", "gen3_2f", "openarm_bimanual")
_ARMS = tuple(name for name in device_names() if device_of(name).model.kind == "arm")


@cache
def _gates(cell: str) -> Mapping[str, str]:
    return _by_gate(built(cell).texts["gates/promotion.md"])


def _by_gate(page: str) -> Mapping[str, str]:
    parts = re.split(r"^## ([GL]\d) ", page.replace("\\", ""), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def _in_order(text: str, *words: str) -> bool:
    places = [text.index(word) for word in words]
    return places == sorted(places)


def test_a_driver_that_commands_from_its_start_on_is_started_after_the_test_of_the_stop() -> None:
    # kortex_driver/src/hardware_interface.cpp:211: loaded, it clears faults and takes low-level control.
    gates = _gates("gen3_2f")
    before = (
        "Place the observer",
        "With the power of the",
        "trip the stop",
        "power the drives again",
        "Payload of arm",
    )
    assert _in_order(gates["G3"], *before, "Complete layers L1", "launch gen3_2f cell.launch.xml")
    assert "trip the stop" not in gates["G5"]
    assert not [code for code in ("G3", "G4") if "rives disabled" in gates[code]]


@pytest.mark.parametrize("cell", ["fr3_hand", "hybrid_sdk"])
def test_the_stop_of_a_robot_that_may_need_open_brakes_is_tested_before_its_program_connects(cell: str) -> None:
    # libfranka@0.20.4 docs/getting_started.rst:144,155 does not say whether Desk grants FCI with closed brakes.
    gates = _gates(cell)
    before = ("Place the observer", "Payload of arm", "Open the brakes", "trip the stop", "power the drives again")
    assert _in_order(gates["G3"], *before, "activate FCI", f"launch {cell} cell.launch.xml")
    assert "trip the stop" not in gates["G5"]
    assert not [code for code in ("G3", "G4") if "rives disabled" in gates[code]]
    assert "people at the cell enable the drives (G3)" in built(cell).texts["README.md"].replace("\n", " ")


def test_an_axis_is_homed_after_the_stop_was_tested_and_again_after_its_power_was_off(tmp_path: Path) -> None:
    order = (
        "Power the axis. It must not move",
        "trip the stop",
        "Home the axis",
        "power of the axis off",
        "home it again",
    )
    assert _in_order(_driven_rail(tmp_path)["G5"], *order)
    assert "UNKNOWN: stopping time and stopping distance of rail" in _driven_rail(tmp_path)["G5"]


def test_gates_of_a_closed_real_target_have_one_line_and_no_command() -> None:
    # The catalog has no driver of the rail, and the package no launch file that claims or sends a goal.
    gates = _gates("rail_arm")
    for code in ("G3", "G4", "G5", "G6", "G7"):
        assert len(re.findall(r"^- \[ \]", gates[code], re.MULTILINE)) == 1
        assert "The real target is closed, because no plugin in the catalog moves rail_carriage_joint" in gates[code]
        assert "```" not in gates[code]
    assert "cellc mock generated/rail_arm" in gates["G2"]


def _driven_rail(folder: Path) -> Mapping[str, str]:
    """Return the gates of the cell with a rail whose drive has a plugin."""
    device = (
        shutil.copytree(CATALOG / "devices" / "linear_axis", folder / "linear_axis", dirs_exist_ok=True) / "device.yaml"
    )
    shutil.copy(CATALOG / "devices" / "shapes.xacro", device.parent)
    xacro = device.parent / "linear_axis.urdf.xacro"
    xacro.write_text(xacro.read_text(encoding="utf-8").replace("../shapes", "shapes"), encoding="utf-8")
    facts = device.read_text(encoding="utf-8")
    effects = "{activate: {motion: none, does: nothing moves, source: made up}}"
    real = f"real: {{plugin: demo_axis/DemoAxis, source: made up, effects: {effects}}}"
    device.write_text(facts.replace("  hardware:\n", f"  hardware:\n    {real}\n"), encoding="utf-8")
    spec = written(folder, spec_text("rail_arm").replace("model: linear_axis", "model: ./linear_axis"))
    return _by_gate(compiled(spec).texts["gates/promotion.md"])


@pytest.mark.parametrize("name", device_names())
def test_a_step_that_powers_drives_for_the_test_of_the_stop_moves_nothing(name: str) -> None:
    for step in device_of(name).model.commissioning:
        assert not (step.powers and re.search(r"[Hh]ome the|on and off by hand|must close and open", step.does))


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_a_state_that_no_topic_reports_is_looked_for_at_the_device(cell: str) -> None:
    text = "".join(_gates(cell).values())
    reported = "\n".join(re.findall(r"reports none of these states: (.*)", text))
    for device in built(cell).graph.cell.devices:
        safety = device_of(device.model).model.safety
        for state in () if safety is None else safety.states:
            if state.stops and state.seen is not None:
                assert f"At {device.name}, check that it is not in state {state.name}, which no topic reports" in text
                assert f"({state.seen})" not in reported


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_no_sentence_of_a_checklist_has_more_than_25_words(cell: str) -> None:
    for gate in _gates(cell).values():
        for line in re.findall(r"^- \[ \] (.*)", gate, re.MULTILINE):
            for sentence in re.split(r"(?<=[.!?:;])\s+", re.sub(r"`[^`]*`", "it", line)):
                assert len(sentence.split()) <= 25, sentence


def test_a_drill_that_restarts_hardware_activates_what_a_person_activated() -> None:
    again = "as in G4, and repeat the activation of"
    assert f"Start the launch again {again} left and right in G5 with its checks." in _gates("openarm_bimanual")["G5"]
    assert "Start the launch again as in G4, with the drives as they are." in _gates("fr3_hand")["G5"]
    # A gripper that its person has not activated yet needs no second activation, and every later restart needs one.
    assert _in_order(_gates("ur5e_pick")["G5"], "Start the launch again as", "launch ur5e_pick activate.launch.xml")
    assert f"Start the cell again {again} gripper in G5 with its checks." in _gates("hybrid_sdk")["G6"]


def test_a_robot_behind_an_adapter_has_no_driver_to_start() -> None:
    assert "Start the cell again" in _gates("hybrid_sdk")["G6"]
    assert "he driver" not in _gates("hybrid_sdk")["G6"]


@pytest.mark.parametrize("cell", sorted(set(_WALKED) - {"gen3_2f", "fr3_hand"}))
def test_any_other_driver_is_started_with_its_drives_disabled(cell: str) -> None:
    gates = _gates(cell)
    assert "trip the stop" in gates["G5"]
    assert "trip the stop" not in gates["G3"]
    assert "Drives disabled" in gates["G3"]


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_evidence_of_the_stop_test_is_attached_after_it(cell: str) -> None:
    for text in _gates(cell).values():
        assert "Attach the evidence" not in text or _in_order(text, "trip the stop", "Attach the evidence")


@pytest.mark.parametrize("name", _ARMS)
def test_an_arm_says_what_slows_it_down_or_that_nothing_does(name: str) -> None:
    control = device_of(name).model.speed_control
    assert control is not None
    assert control.source


@pytest.mark.parametrize("cell", sorted(set(EVERY_CELL) - {"rail_arm"}))
def test_only_a_robot_with_a_slider_is_slowed_by_one(cell: str) -> None:
    text = "".join(_gates(cell).values())
    models = {device.model for device in built(cell).graph.cell.devices}
    has = any(device_of(model).model.vendor == "Universal Robots" for model in models)
    assert ("speed slider" in text) is has
    assert "vendor's speed control" not in text
    assert "reduced mode" not in text


@pytest.mark.parametrize("cell", ["fr3_hand", "gen3_2f", "openarm_bimanual"])
def test_payload_is_asked_for_once_in_the_words_of_its_robot(cell: str) -> None:
    text = "".join(_gates(cell).values())
    assert "by its installation" not in text
    assert "rotation vector" not in text
    assert not re.findall(r"set (mass|the end effector)", text)


def test_a_gripper_gets_its_first_goal_when_it_is_claimed() -> None:
    claim = "Authorize the claims"
    assert _in_order(_gates("ur5e_pick")["G7"], claim, "Keep all hands clear. Send two goals", "fingers of gripper")
    hand = _gates("fr3_hand")["G7"]
    # fr3_hand states `grip: {force: 20 N}`; the goal of a GripperCommand carries it.
    assert _in_order(hand, claim, "Send two goals", "position 0.02 m, then position 0.036 m. Set max_effort to 20 N.")


@pytest.mark.parametrize("cell", _WALKED)
def test_no_line_says_run_this_without_a_command(cell: str) -> None:
    assert not re.search(r"in the build workspace that[^\n]*\n(?!\n  ```sh)", _gates(cell)["G0"])


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_each_computer_is_read_by_its_name_where_there_are_several(cell: str) -> None:
    hosts = [node.host for node in built(cell).graph.cell.nodes]
    for host in set(hosts) if len(set(hosts)) > 1 else ():
        assert f"On {host}: Compare the installed versions" in _gates(cell)["G0"]


def test_words_that_are_no_figure_are_gone() -> None:
    for cell in EVERY_CELL:
        text = built(cell).texts["gates/promotion.md"]
        assert "stay fresh" not in text
        assert "slider low" not in text
        assert not re.search(r"arrives at \d+ Hz, (?!at most)", text)
        assert "Send a short goal" not in text


def test_the_brakes_of_a_ur_are_closed_before_its_driver_is_started_and_while_it_reads() -> None:
    gates = _gates("ur5e_pick")
    assert _in_order(gates["G3"], "the brakes are closed", "Authorize the hardware launch")
    assert _in_order(
        gates["G4"], "the brakes are closed", "Authorize the hardware launch again", "the states of devices"
    )
    readings = json.loads(built("ur5e_pick").texts["config/observe.json"])["real"]["readings"]
    (mode,) = [reading for reading in readings if reading["interface"] == "/arm_io/robot_mode"]
    assert mode["expected"]["G4"] == ["POWER_OFF", "IDLE"]


@pytest.mark.parametrize("cell", ["fr3_hand", "gen3_2f", "openarm_bimanual"])
def test_gate_g6_stops_and_starts_the_launches_once_for_all_arms(cell: str) -> None:
    # One launch has the controller manager of every arm: a start for each would move an arm beside a person.
    gate = _gates(cell)["G6"]
    assert gate.count("Stop every launch of the cell") == gate.count("Start the cell again") == 1
    assert _in_order(
        gate, "Stop every launch", "Record the angle", "by + ", "back to its first angle", "Start the cell"
    )


@pytest.mark.parametrize(
    ("motor", "firmware"), [("DM4310", "V5017_04"), ("DM4340", "V5117_04"), ("DM8009", "V6417_04")]
)
def test_each_motor_of_an_openarm_has_its_own_firmware(motor: str, firmware: str) -> None:
    # enactic/openarm@1080ae9 website/docs/setup/openarm-setup/6-motor-firmware-update.mdx:40-42
    gates = _gates("openarm_bimanual")
    assert f"{firmware} on a {motor}" in gates["G5"].replace("\n", " ")
    # A motor answers with its 24 V on, which G0 does not have.
    assert "firmware" not in gates["G0"]
    assert _in_order(gates["G5"], "Switch its 24 V supply on", "trip the stop", "Read left.firmware at the device")


def test_a_repeated_gate_gets_an_evidence_folder_of_its_own_which_each_new_shell_finds(tmp_path: Path) -> None:
    texts = built("ur5e_pick").texts
    assert "`mkdir evidence/attempt-002`, then set up each shell again" in texts["gates/promotion.md"]
    for page in ("promotion", "network"):
        place = tmp_path / f"generated/ur5e_pick/gates/{page}.md"
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text("printed", encoding="utf-8")
    setup = texts["README.md"].partition("## Set up each shell")[2].partition("```sh\n")[2].partition("```")[0]
    lines = [line for line in setup.splitlines() if "evidence/attempt" in line or '"$E"' in line]
    for newest in ("attempt-001", "attempt-002"):
        (tmp_path / "evidence" / newest).mkdir(parents=True)
        script = "\n".join([*lines, 'echo "$E"'])
        ran = subprocess.run(["bash", "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert ran.stdout == f"evidence/{newest}\n"
        (tmp_path / "evidence" / newest / "promotion.md").write_text("ticked", encoding="utf-8")
        subprocess.run(["bash", "-c", script], cwd=tmp_path, capture_output=True, check=False)
        kept = [(tmp_path / "evidence" / newest / f"{page}.md").read_text("utf-8") for page in ("promotion", "network")]
        assert kept == ["ticked", "printed"]


@pytest.mark.parametrize("cell", _WALKED)
def test_stopping_distance_is_read_where_it_is_published_and_unknown_elsewhere(cell: str) -> None:
    text = "".join(_gates(cell).values())
    published = cell == "ur5e_pick"  # UR5e Hardware Manual (2022), p. 65; no other source was found
    assert ("Look up the stopping time and the stopping distance of arm" in text) is published
    assert ("UNKNOWN: stopping time and stopping distance of" in text) is not published


@pytest.mark.parametrize("cell", sorted(set(EVERY_CELL) - {"rail_arm"}))
def test_area_and_observer_are_looked_at_again_before_anything_moves_after_people_were_in_reach(cell: str) -> None:
    gate = _gates(cell)["G7"]
    for release in ("Authorize the claims", "Authorize the motion clients"):
        if release in gate:
            before = gate[: gate.index(release)]
            assert "no person and no loose object is within reach" in before
            assert "Place the observer" in before


@pytest.mark.parametrize("cell", ["ur5e_pick", "dual_ur"])
def test_no_stage_runs_at_the_low_speed_of_the_first_goals(cell: str) -> None:
    for stage in re.findall(r"Stage \d+ %[^\n]*", _gates(cell)["G7"]):
        if "Check that" in stage:
            assert "Set the speed slider of" in stage
            assert "to 100 %, so that only the cap limits the speed" in stage


def test_description_with_a_login_is_parsed_without_it_and_not_recorded() -> None:
    # kortex_driver has its login in the description; xacro fails where a variable is not set.
    assert "GEN3_USERNAME=none GEN3_PASSWORD=none xacro " in _gates("gen3_2f")["G1"]
    assert "/robot_description" not in _gates("gen3_2f")["G7"]
    assert "/robot_description" in _gates("ur5e_pick")["G7"]


def test_firmware_that_shows_only_with_power_is_unknown_until_then() -> None:
    gates = _gates("gen3_2f")
    assert "arm.firmware" not in gates["G0"]
    assert _in_order(gates["G3"], "switch its power on", "trip the stop", "Read arm.firmware at the device")
    assert _in_order(gates["G4"], "no person controls the arm from the Web App", "launch gen3_2f cell.launch.xml")


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_arms_that_fall_are_supported_before_any_launch_is_stopped(cell: str) -> None:
    # openarm_hardware/src/v10_simple_hardware.cpp:230; robotiq_driver/src/hardware_interface.cpp:252 lets go.
    recovery = built(cell).texts["audit.md"].split("\n## Recovery\n")[1].split("\n## ")[0]
    lost = built(cell).texts["audit.md"].split("\n## After a crash")[1].split("\n## ")[0]
    for text in (recovery, lost):
        assert ("place a stand just below each of left and right" in text) == (cell == "openarm_bimanual")
        assert ("that gripper may hold" in text) == (
            "robotiq_driver/" in built(cell).texts["urdf/" + f"{cell}.real.urdf"]
        )
    assert "Power off at the teach pendant" in lost or "ur" not in cell
