"""The audit answers prompt A of the chapter: tuple, expectations, owners, command paths, questions."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.formats.markdown_table import table
from tests.cells import CORPUS, graph_of, spec_text
from tests.cli.run import MINIMAL, PICK, run
from tests.emit.cells import CELLS, artifacts_of, contract_data, emitted, emitted_graph
from tests.foreign_yaml import safe_load


def section(text: str, title: str) -> list[list[str]]:
    """Return the rows of a section's table, head and rule left out."""
    body = text.split(f"\n## {title}\n")[1].split("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in body.splitlines() if line.startswith("|")]
    return rows[2:]


def answers(tmp_path: Path, old: str, new: str) -> dict[tuple[str, str], str]:
    text = spec_text("ur5e_pick")
    assert old in text
    rows = section(emitted(tmp_path, text.replace(old, new))["audit.md"], "Version tuple")
    return {(of, part): answer for of, part, _, answer, _ in rows}


# versions.md: rows of the vendors' matrices and of rosdistro.
@pytest.mark.parametrize(
    ("old", "new", "part", "answer"),
    [
        ("polyscope 5.21.0", "polyscope 5.9.4", ("arm", "firmware"), "OK"),
        ("polyscope 5.21.0", "polyscope 5.9.3", ("arm", "firmware"), "INCOMPATIBLE"),
        ("polyscope 5.21.0", "polyscope 10", ("arm", "firmware"), "INCOMPATIBLE"),
        ("polyscope 5.21.0", "polyscope 10.7.0", ("arm", "firmware"), "INCOMPATIBLE"),
        ("polyscope 5.21.0", "somethingelse 1.0", ("arm", "firmware"), "UNKNOWN"),
        ("ur_robot_driver 3.8.0", "ur_robot_driver 2.14.0", ("arm", "driver"), "INCOMPATIBLE"),
        ("ur_robot_driver 3.8.0", "ur_robot_driver 3.9.0", ("arm", "driver"), "UNKNOWN"),
        ("ubuntu 24.04", "ubuntu 20.04", ("ur5e_pick", "os"), "INCOMPATIBLE"),
        ("ubuntu 24.04", "ubuntu 22.04", ("ur5e_pick", "os"), "UNKNOWN"),  # third tier of REP-2000
        ("moveit: 2.12.4", "moveit: 2.5.9", ("ur5e_pick", "moveit"), "INCOMPATIBLE"),
        ("moveit: 2.12.4", "moveit: 2.12.3", ("ur5e_pick", "moveit"), "UNKNOWN"),
        ("moveit: 2.12.4", "moveit: UNKNOWN", ("ur5e_pick", "moveit"), "UNKNOWN"),
        ("rmw_fastrtps_cpp 8.4.4", "rmw_other_cpp 1.0.0", ("ur5e_pick", "rmw"), "INCOMPATIBLE"),
    ],
)
def test_tuple_has_three_answers(tmp_path: Path, old: str, new: str, part: tuple[str, str], answer: str) -> None:
    assert answers(tmp_path, old, new)[part] == answer


def test_untested_version_is_a_question_to_the_supplier(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("ur_robot_driver 3.8.0", "ur_robot_driver 3.9.0")
    rows = section(emitted(tmp_path, text)["audit.md"], "Open questions")
    (row,) = (row for row in rows if row[2] == "`devices.arm.driver`")
    assert row[0] == "supplier Universal Robots"
    assert "3.9.0" in row[1]
    assert "rosdistro" in row[1]


def test_what_stands_on_the_device_is_asked_of_its_owner() -> None:
    rows = section(artifacts_of("ur5e_pick")["audit.md"], "Open questions")
    assert ["robot", "What is the serial of arm? See its nameplate or panel.", "`devices.arm.serial`"] in rows


def test_surroundings_that_are_open_are_asked_of_their_person_and_unstated_ones_of_the_author(tmp_path: Path) -> None:
    rows = section(artifacts_of("ur5e_pick")["audit.md"], "Open questions")
    asked = "Which brackets and cables are on the arms and beside them?"
    assert ["integration", f"{asked} Known by 2026-12-15.", "`surroundings.fittings`"] in rows
    text = spec_text("ur5e_pick").replace("  floor: {shapes: [floor]}\n", "")
    rows = section(emitted(tmp_path, text)["audit.md"], "Open questions")
    assert ["author of the spec", "Where is the floor?", "`surroundings.floor`"] in rows


def test_scene_says_what_a_touched_shape_rests_on(tmp_path: Path) -> None:
    """Four corners of a square of 1 m and its middle 2.5 mm higher: the mean is 0.5 mm up."""
    points = "[0 0 0 m, 1 0 0 m, 0 1 0 m, 1 1 0 m, 0.5 0.5 0.0025 m]"
    touched = f"touched: {{shape: plane, points: {points}, within: 3 mm, free: 0 0 1 m}}"
    text = spec_text("ur5e_pick").replace("plane: 4 m}", f"{touched}}}")
    rows = section(emitted(tmp_path, text)["audit.md"], "Scene")
    assert ["table", "box", "support", "figures of the spec"] in rows
    fit = "5 touched points, least squares: root mean square 1 mm, largest 2 mm"
    assert ["floor", "plane", "floor", fit] in rows


def test_every_command_interface_has_its_owner() -> None:
    rows = section(artifacts_of("ur5e_pick")["audit.md"], "Command owners")
    moved = [row for row in rows if row[1] != "arm_io"]
    assert len(moved) == 7  # six joints of the arm and the gripper's one
    assert ["`arm_gpio/standard_digital_output_cmd_[0..17]`", "arm_io", "task", "integration"] in rows
    assert ["`arm_elbow_joint/position`", "arm_trajectory", "move_group", "integration"] in rows


def test_command_path_states_what_the_chapter_asks_for() -> None:
    rows = section(artifacts_of("ur5e_pick")["audit.md"], "Command paths")
    (row,) = (row for row in rows if "follow_joint_trajectory" in row[0])
    path, frame, unit, rate, time, qos, watchdog, failure = row
    assert path == "move_group → `/arm_trajectory/follow_joint_trajectory` → arm_trajectory → arm_hardware"
    assert (frame, unit, rate, time) == ("joints", "rad", "500 Hz", "ros")
    assert "reliable" in qos
    assert "0.04 s" in watchdog  # robots.md: robot_receive_timeout
    assert failure.startswith("on violation abort_and_hold")


@pytest.mark.parametrize("cell", CELLS)
def test_audit_expects_the_interfaces_of_the_contract(cell: str) -> None:
    artifacts = artifacts_of(cell)
    kinds = {"topic": "Expected topics", "service": "Expected services", "action": "Expected actions"}
    for name, interface in contract_data(artifacts["contract.json"])["interfaces"].items():
        assert f"`{name}`" in [row[0] for row in section(artifacts["audit.md"], kinds[interface["kind"]])]


@pytest.mark.parametrize("cell", CELLS)
def test_every_table_is_as_wide_as_its_head(cell: str) -> None:
    width = 0
    for line in artifacts_of(cell)["audit.md"].splitlines():
        if not line.startswith("|"):
            width = 0
        elif width:
            assert line.replace("\\|", "").count("|") == width, line
        else:
            width = line.count("|")


@pytest.mark.parametrize("file", [PICK, MINIMAL])
def test_command_prints_what_is_built(file: str) -> None:
    ran = run("audit", file)
    assert ran.code == 0
    assert ran.out == artifacts_of(Path(file).parent.name)["audit.md"]


def test_command_reports_a_cell_that_cannot_be_linked(tmp_path: Path) -> None:
    assert run("audit", (tmp_path / "none.yaml").as_posix()).code == 1


def test_bar_in_a_cell_does_not_end_it() -> None:
    assert table(("a",), [("x|y",)]) == "| a |\n|---|\n| x\\|y |"


def test_section_without_rows_says_so() -> None:
    assert table(("a",), []) == "None."


def test_audit_says_the_whole_rate_of_transforms_and_of_what_is_latched() -> None:
    rows = {row[0].strip("`"): row[-1] for row in section(artifacts_of("ur5e_pick")["audit.md"], "Expected topics")}
    assert rows["/tf"].startswith("20 Hz, dynamic frames at their own rate; frame in each transform")
    assert rows["/tf_static"].startswith("once, latched; ")


def test_audit_says_where_the_planner_knows_nothing_around_the_devices(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    scene = text[text.index("scene:\n") : text.index("nodes:\n")]
    told = "`scene` is empty, so planned paths may pass through a table or fence"
    assert told in emitted(tmp_path, text.replace(scene, ""))["audit.md"]
    assert told not in artifacts_of("ur5e_pick")["audit.md"]


AUDIT: dict[str, list[list[str]]] = safe_load((Path(__file__).parent / "audit.yaml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("title", AUDIT)
def test_section_says_what_the_spec_means(title: str) -> None:
    text = emitted_graph(graph_of(CORPUS / "valid" / "complete.yaml"))["audit.md"]
    assert section(text, title) == AUDIT[title]
    assert ("None." in text.split(f"\n## {title}\n")[1].split("\n## ")[0]) is (AUDIT[title] == [])


def test_parameters_that_no_check_knows_are_named(tmp_path: Path) -> None:
    task = "  task: {run: cell_tasks/pick_place"
    text = spec_text("ur5e_pick")
    assert task in text
    own = text.replace(task, f"{task}, parameters: {{approach_speed: 0.1, use_sim_time: false}}")
    assert "- `/task`: `approach_speed`\n" in emitted(tmp_path, own)["audit.md"] + "\n"
    assert "No check knows" not in emitted(tmp_path, text)["audit.md"]
