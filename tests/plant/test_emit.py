"""The package of a plant, read as the bridge and colcon read it; and what a plant does to the packages of its cells."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml

from cellc.compiler.pipeline import check_buildable, compile_cell
from tests.cells import compiled, there
from tests.cli.run import run
from tests.plant.hall import HALL, hall


def _files(spec: Path) -> dict[str, str]:
    return {artifact.path: artifact.text for artifact in there(compile_cell(check_buildable(spec)).value)}


def test_a_bridge_has_the_topic_of_each_graph_and_the_profile_of_the_publisher() -> None:
    assert yaml.safe_load(_files(HALL / "plant.yaml")["config/line_1_to_line_2.yaml"]) == {
        "name": "line_1_to_line_2",
        "from_domain": 11,
        "to_domain": 12,
        "topics": {
            "part_ready": {
                "type": "geometry_msgs/msg/PoseStamped",
                "remap": "line_1/part_ready",
                "qos": {
                    "reliability": "reliable",
                    "durability": "volatile",
                    "history": "keep_last",
                    "depth": 5,
                    "deadline": "auto",
                    "lifespan": "auto",
                },
            }
        },
    }


def test_cells_are_where_their_mounts_are_in_the_frame_of_another_too(tmp_path: Path) -> None:
    mount = ("plant.yaml", "parent: world, xyz: 5 0 0 m, rpy: 0 0 180 deg", "parent: line_1/hand_over, "
             "xyz: 2.5 0 -0.8 m, rpy: 0 0 180 deg")  # fmt: skip
    for spec in (hall(tmp_path / "a"), hall(tmp_path / "b", mount)):
        cells = yaml.safe_load(_files(spec)["config/cells.yaml"])["cells"]
        assert [cells[key]["package"] for key in cells] == ["line_1", "line_2"]
        assert cells["line_1"]["xyz"] == cells["line_1"]["rpy"] == [0.0, 0.0, 0.0]
        assert cells["line_2"]["xyz"] == [5.0, 0.0, 0.0]
        assert math.isclose(cells["line_2"]["rpy"][2], math.pi, abs_tol=1e-9)


def test_the_launch_file_starts_one_bridge_for_each_two_cells_and_no_node() -> None:
    files = _files(HALL / "plant.yaml")
    launch = ElementTree.fromstring(files["launch/plant.launch.xml"])
    (bridge,) = launch
    assert bridge.tag == "executable"
    program, _, config = bridge.attrib["cmd"].rpartition(" $(find-pkg-share hall)/")
    assert program == "$(find-pkg-prefix domain_bridge)/lib/domain_bridge/domain_bridge"
    assert config in files


def test_the_package_depends_on_the_bridge_and_the_types_that_it_loads() -> None:
    package = ElementTree.fromstring(_files(HALL / "plant.yaml")["package.xml"])
    needed = [each.text for each in package.iter("exec_depend")]
    assert package.findtext("name") == "hall"
    assert needed == ["domain_bridge", "geometry_msgs", "ros2launch"]


def test_the_page_names_the_command_that_builds_each_cell() -> None:
    page = _files(HALL / "plant.yaml")["README.md"]
    assert all(f"`cellc build line_{number}/cell.yaml`" in page for number in (1, 2))


def test_a_plant_without_crossings_starts_nothing(tmp_path: Path) -> None:
    spec = hall(tmp_path)
    spec.write_text(spec.read_text(encoding="utf-8").partition("interfaces:")[0], encoding="utf-8")
    files = _files(spec)
    assert list(ElementTree.fromstring(files["launch/plant.launch.xml"])) == []
    assert "domain_bridge" not in files["package.xml"]


def test_a_cell_builds_the_same_with_and_without_a_plant_beside_it(tmp_path: Path) -> None:
    spec = hall(tmp_path)
    with_plant = compiled(spec.parent / "line_1" / "cell.yaml").texts
    spec.unlink()
    assert compiled(spec.parent / "line_1" / "cell.yaml").texts == with_plant


def test_the_package_of_a_cell_does_not_start_the_bridge_and_depends_on_it() -> None:
    for number in (1, 2):
        texts = compiled(HALL / f"line_{number}" / "cell.yaml").texts
        launch = ElementTree.fromstring(texts["launch/cell.launch.xml"])
        assert [node.attrib["name"] for node in launch.iter("node") if node.get("pkg") == "domain_bridge"] == []
        assert "nodes.line_1_to_line_2" in texts["launch/cell.launch.xml"]


def test_build_writes_the_plant_alone_and_is_then_up_to_date(tmp_path: Path) -> None:
    spec, out = hall(tmp_path).as_posix(), (tmp_path / "out").as_posix()
    assert run("build", spec, "-o", out).code == 0
    assert [folder.name for folder in Path(out).iterdir()] == ["hall"]
    assert run("build", spec, "-o", out, "--check").code == 0
    edited = Path(out, "hall", "config", "cells.yaml")
    edited.write_text(edited.read_text(encoding="utf-8").replace("team_2", "team_3"), encoding="utf-8")
    assert run("build", spec, "-o", out, "--check").code == 1


def test_a_plant_with_errors_is_not_written(tmp_path: Path) -> None:
    spec = hall(tmp_path, ("line_2/cell.yaml", "rate: 2 Hz", "rate: 4 Hz"))
    assert run("build", spec.as_posix(), "-o", (tmp_path / "out").as_posix()).code == 1
    assert not (tmp_path / "out").exists()


def test_a_plant_and_its_cells_are_checked_in_one_call(tmp_path: Path) -> None:
    ran = run("check", *(each.as_posix() for each in (hall(tmp_path), *sorted((tmp_path / "hall").rglob("cell.yaml")))))
    assert ran.code == 0, ran.out


def test_what_a_plant_does_not_do_yet_says_so_and_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = (HALL / "plant.yaml").as_posix()
    for command in (
        ("show", spec),
        ("view", spec),
        ("audit", spec),
        ("compare", spec, spec),
        ("upgrade", spec, "--ros", "kilted"),
    ):
        ran = run(*command)
        assert ran.code in (1, 2), command
        assert "not supported in a plant yet" in ran.out + ran.err, command
        assert not list(tmp_path.iterdir()), command
