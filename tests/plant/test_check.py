"""What is checked between the cells of a plant, and where it is reported."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cellc.compiler.pipeline import judge
from cellc.contract.limits import Limits, in_force
from tests.cells import ROOT
from tests.plant.hall import HALL, found, hall

PLANT, LINE_1, LINE_2 = "plant.yaml", "line_1/cell.yaml", "line_2/cell.yaml"
MOUNT_2 = "{parent: world, xyz: 5 0 0 m, rpy: 0 0 180 deg}"
CROSSING, PART_2, PART_1 = 10, 7, 6
"""Lines of the plant."""


def test_the_page_shows_this_plant() -> None:
    page = (ROOT / "docs" / "plant.md").read_text(encoding="utf-8")
    assert (HALL / PLANT).read_text(encoding="utf-8") in page


def test_two_cells_that_agree_have_no_findings(tmp_path: Path) -> None:
    assert found(tmp_path) == []


def test_what_is_wrong_in_a_cell_is_reported_in_its_file_with_the_line_of_the_plant(tmp_path: Path) -> None:
    spec = hall(tmp_path, (LINE_2, "model: ur5e", "model: ur5"))
    (error,) = judge(spec).diagnostics
    assert (error.code, error.span.file, error.span.line) == ("unknown-model", f"{tmp_path}/hall/{LINE_2}", 6)
    assert [(each.span.file, each.span.line) for each in error.related] == [(spec.as_posix(), PART_2)]


@pytest.mark.parametrize(
    ("edit", "code", "file", "line"),
    [
        # Of references.
        ((PLANT, "from: line_1/task", "from: line_3/task"), "unknown-part", PLANT, CROSSING),
        ((PLANT, "from: line_1/task", "from: task"), "unknown-part", PLANT, CROSSING),
        ((PLANT, "[line_2/task]", "[line_2/tusk]"), "unknown-node", PLANT, CROSSING),
        ((PLANT, "{parent: world}", "{parent: line_2/arm/tool9}"), "unknown-frame", PLANT, PART_1),
        ((PLANT, "{parent: world}", "{parent: line_2/arm/tool0}"), "mount-on-dynamic-frame", PLANT, PART_1),
        ((PLANT, "{parent: world}", "{parent: line_1/hand_over}"), "frame-cycle", PLANT, PART_1),
        # Of files.
        ((PLANT, "line_2/cell.yaml", "line_2/sell.yaml"), "file-not-found", PLANT, PART_2),
        ((PLANT, "line_2/cell.yaml", "../line_2/cell.yaml"), "include-escape", PLANT, PART_2),
        ((PLANT, "line_2/cell.yaml", "/etc/hostname"), "include-escape", PLANT, PART_2),
        ((PLANT, "line_2/cell.yaml", "plant.yaml"), "include-cycle", PLANT, PART_2),
        ((PLANT, "line_2/cell.yaml", '"line_2\\0"'), "control-character", PLANT, PART_2),
        # Of the shape.
        ((PLANT, "  line_2: {spec", "  line_1: {spec"), "duplicate-key", PLANT, PART_2),
        ((PLANT, ", owner: team_2", ""), "missing-key", PLANT, PART_2),
        ((PLANT, "owner: team_2", "owned: team_2"), "unknown-key", PLANT, PART_2),
        ((PLANT, "5 0 0 m", "5 0 0"), "missing-unit", PLANT, PART_2),
        ((PLANT, "rpy: 0 0 180 deg", "calibration: survey"), "unsupported-in-plant", PLANT, PART_2),
        ((PLANT, "\ninterfaces:", "nodes: {}\ninterfaces:"), "unsupported-in-plant", PLANT, 8),
        ((PLANT, "topic: geometry_msgs/msg/PoseStamped", "service: a/srv/B"), "unsupported-in-plant", PLANT, CROSSING),
        # Of what crosses.
        ((PLANT, "/line_1/part_ready", "/part_ready"), "crossing-not-declared", PLANT, CROSSING),
        ((PLANT, "[line_2/task]", "[line_1/task]"), "crossing-not-declared", PLANT, CROSSING),
        ((LINE_1, "  /part_ready:", "  /ready:"), "crossing-not-declared", PLANT, CROSSING),
        ((LINE_2, "  /line_1/part_ready:", "  /part_ready:"), "crossing-not-declared", PLANT, CROSSING),
        ((PLANT, "from: line_1/task", "from: line_1/line_1_to_line_2_11"), "crossing-not-declared", PLANT, CROSSING),
        ((LINE_2, "domain_bridge/domain_bridge", "line_tasks/relay"), "crossing-not-declared", PLANT, CROSSING),
        ((LINE_2, "domain_id: 12", "domain_id: 13"), "crossing-not-declared", PLANT, CROSSING),
        ((PLANT, "geometry_msgs/msg/PoseStamped", "std_msgs/msg/Bool"), "crossing-differs", PLANT, CROSSING),
        ((LINE_2, "rate: 2 Hz", "rate: 4 Hz"), "crossing-differs", PLANT, CROSSING),
        ((LINE_2, "_12: {reliability: reliable, depth: 5", "_12: {reliability: reliable, depth: 6"),
         "crossing-differs", PLANT, CROSSING),
        ((LINE_2, "frame: hand_over", "frame: world"), "crossing-differs", PLANT, CROSSING),
        ((LINE_2, "2.5 0 0.8 m", "2.502 0 0.8 m"), "crossing-frame-apart", PLANT, CROSSING),
        ((PLANT, "0 0 180 deg", "0 0 179.9 deg"), "crossing-frame-apart", PLANT, CROSSING),
        # Of what they share.
        ((LINE_2, "cell: line_2", "cell: line_1"), "output-shared", PLANT, PART_2),
        ((LINE_2, "{ros: jazzy}", "{ros: kilted}"), "mixed-distributions", PLANT, PART_2),
        ((LINE_2, "discovery: unicast, peers: [10.2.0.2]", "discovery: localhost"),
         "localhost-with-several-hosts", LINE_2, 5),
    ],
    ids=lambda value: value[2][:40] if isinstance(value, tuple) else "",
)  # fmt: skip
def test_a_mistake_between_cells_is_reported_once_at_its_line(
    edit: tuple[str, str, str], code: str, file: str, line: int, tmp_path: Path
) -> None:
    assert found(tmp_path, edit) == [(code, file, line)]


def test_a_spec_that_is_a_plant_itself_is_refused_at_its_cells(tmp_path: Path) -> None:
    spec = hall(tmp_path)
    (spec.parent / "line_2" / "cell.yaml").write_text(spec.read_text().replace("line_", "../line_"))
    assert [each.code for each in judge(spec).diagnostics] == ["unsupported-in-plant"]


def test_two_middlewares_are_reported_and_an_unknown_one_is_not(tmp_path: Path) -> None:
    first = (LINE_1, "{ros: jazzy}", "{ros: jazzy, rmw: rmw_fastrtps_cpp 8.4.4}")
    second = (LINE_2, "{ros: jazzy}", "{ros: jazzy, rmw: rmw_cyclonedds_cpp 2.2.3}")
    assert found(tmp_path / "a", second) == []
    assert found(tmp_path / "b", first, second) == [("mixed-distributions", PLANT, PART_2)]


def test_one_domain_of_two_cells_is_reported_though_no_packet_of_them_meets(tmp_path: Path) -> None:
    edits = [
        (LINE_2, "domain_id: 12", "domain_id: 11"),
        (LINE_2, "nodes:\n  task: {run: line_tasks/task, owner: team_2}\n  line_1_to_line_2_12:",
         "nodes:\n  task: {run: line_tasks/task, owner: team_2}\n  line_1_to_line_2_11:"),
        (LINE_2, "from: {line_1_to_line_2_12", "from: {line_1_to_line_2_11"),
    ]  # fmt: skip
    assert found(tmp_path, *edits) == [("shared-domain-id", PLANT, PART_2)]


def test_one_robot_in_two_cells_is_reported_by_its_serial_number(tmp_path: Path) -> None:
    arm = ("devices: {arm: {model: ur5e}}", "devices: {arm: {model: ur5e, serial: '20195501234'}}")
    assert found(tmp_path, (LINE_1, *arm), (LINE_2, *arm)) == [("duplicate-serial", PLANT, PART_2)]


def test_a_link_out_of_the_repository_is_not_followed(tmp_path: Path) -> None:
    spec = hall(tmp_path)
    outside = tmp_path / "line_2.yaml"
    (spec.parent / "line_2" / "cell.yaml").rename(outside)
    os.symlink(outside, spec.parent / "line_2" / "cell.yaml")
    assert [each.code for each in judge(spec).diagnostics] == ["include-escape"]


def test_a_cell_beside_the_folder_of_the_plant_is_read_in_the_same_repository(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    spec = hall(tmp_path)
    (tmp_path / "plant").mkdir()
    moved = tmp_path / "plant" / "cell.yaml"
    moved.write_text(spec.read_text().replace("spec: line_", "spec: ../hall/line_"))
    assert judge(moved).diagnostics == ()


def test_cells_beyond_the_limit_are_refused_before_one_is_read(tmp_path: Path) -> None:
    spec = hall(tmp_path, (LINE_1, "format: 1", "format: 9"))
    with in_force(Limits(plant_cells=1)):
        (error,) = judge(spec).diagnostics
    assert (error.code, error.span.line) == ("too-many-includes", 5)
    assert "--limit plant-cells" in error.help


class TestMeeting:
    """Two UR5e at the origins of their cells, whose shapes are known: a ball round each has less than 1.5 m."""

    NEAR = (PLANT, MOUNT_2, "{parent: world, xyz: 1 0 0 m, rpy: 0 0 180 deg}")
    HERE = (LINE_2, "xyz: 2.5 0 0.8 m", "xyz: -1.5 0 0.8 m")
    """The frame that both know stays where it is."""

    def area(self, box: str, more: str = "") -> tuple[str, str, str]:
        text = (
            f"areas: {{between: {{parent: line_1/arm/base_link, xyz: 0.5 0 0 m, box: {box}, granted_by: plc{more}}}}}"
        )
        return (PLANT, "\ninterfaces:", f"{text}\ninterfaces:")

    def test_arms_that_may_meet_are_reported_with_the_room_that_they_share(self, tmp_path: Path) -> None:
        spec = hall(tmp_path, self.NEAR, self.HERE)
        (error,) = judge(spec).diagnostics
        assert (error.code, error.span.line) == ("parts-may-meet", PART_2)
        assert error.message.startswith("`line_1/arm` and `line_2/arm` may meet: in `{parent: world, xyz: 0.5 0 ")

    def test_an_area_that_holds_what_they_share_answers_it(self, tmp_path: Path) -> None:
        assert found(tmp_path, self.NEAR, self.HERE, self.area("4 4 4 m")) == []

    def test_the_figures_of_the_message_are_an_area_that_answers_it(self, tmp_path: Path) -> None:
        spec = hall(tmp_path, self.NEAR, self.HERE)
        (error,) = judge(spec).diagnostics
        said = error.message.partition("`{")[2].rpartition("}`")[0]
        text = spec.read_text(encoding="utf-8")
        spec.write_text(f"{text}areas: {{between: {{{said}, granted_by: safety_plc}}}}\n", encoding="utf-8")
        assert judge(spec).diagnostics == ()

    def test_an_area_that_holds_only_a_part_of_it_does_not(self, tmp_path: Path) -> None:
        assert found(tmp_path, self.NEAR, self.HERE, self.area("4 1 4 m")) == [("parts-may-meet", PLANT, PART_2)]


class TestThings:
    """A post of line 2 that is 0.9 m beside the arm of line 1, and what line 1 says of it."""

    POST = (LINE_2, "nodes:", "scene: {post: {parent: world, xyz: 5 0.9 0.5 m, box: 100 100 1000 mm}}\nnodes:")

    @staticmethod
    def known(box: str, at: str = "0 -0.9 0.5 m") -> tuple[str, str, str]:
        return (LINE_1, "nodes:", f"scene: {{theirs: {{parent: world, xyz: {at}, box: {box}}}}}\nnodes:")

    def test_a_thing_in_reach_that_the_cell_does_not_know_is_a_warning_there(self, tmp_path: Path) -> None:
        checked = judge(hall(tmp_path, self.POST))
        (warning,) = checked.diagnostics
        assert (warning.code, warning.span.line, checked.ok) == ("shape-of-another-part", PART_1, True)
        assert [Path(each.span.file).parent.name for each in warning.related] == ["line_2"]

    def test_a_shape_that_holds_it_answers_it_and_a_smaller_one_does_not(self, tmp_path: Path) -> None:
        assert found(tmp_path / "a", self.POST, self.known("100 100 1000 mm")) == []
        half = self.known("100 100 1000 mm", "0 -0.92 0.5 m")  # two of its four edges are within
        for number, edit in enumerate((self.known("100 90 1000 mm"), half)):
            assert [code for code, *_ in found(tmp_path / f"{number}", self.POST, edit)] == ["shape-of-another-part"]

    def test_a_thing_of_the_first_cell_is_a_warning_at_the_second(self, tmp_path: Path) -> None:
        post = self.known("100 100 1000 mm", "5 -0.9 0.5 m")
        assert found(tmp_path, post) == [("shape-of-another-part", PLANT, PART_2)]

    def test_floors_are_not_compared(self, tmp_path: Path) -> None:
        floor = ("nodes:", "scene: {floor: {parent: world, plane: 12 m}}\nnodes:")
        assert found(tmp_path, (LINE_2, *floor)) == []
