"""`packages:` names the folders of the repository in which packages of descriptions and meshes lie."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.mock import load
from tests.cells import CORPUS, build_into, compiled, diagnose, linked, linking, there, written
from tests.cli.run import run

_LIMIT = '<limit lower="-2" upper="2" velocity="1" effort="10"/>'
_ARM = f"""<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="$(find arm_parts)/hand.xacro"/>
<link name="base"/><joint name="turn" type="revolute"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/>
{_LIMIT}</joint></robot>"""
_HAND = """<robot><link name="hand"><collision><geometry>
<mesh filename="package://arm_parts/NAME"/>
</geometry></collision></link></robot>"""
CELL = """format: 1
cell: bench
versions: {ros: jazzy}
packages: [PLACES]
devices:
  arm: {model: ./arm}
control:
  update_rate: 100 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
    arm_trajectory:
      {type: joint_trajectory, device: arm, goal_time: 1 s, path_tolerance: 0.1 rad, goal_tolerance: 0.1 rad}
motion:
  groups: {all: {base: arm/base, tip: arm/hand}}
  poses: {home: {all: 0 rad}, away: {all: 0.2 rad}}
rehearsals: {wave: {steps: [move: away]}}
"""
DEVICE = """format: 1
model: arm
vendor: UNKNOWN
summary: an arm of one joint
kind: arm
as_of: 2026-01-01
description: {file: arm.xacro}
sources: [made up]
base: base
frames: {base: base, hand: hand}
tool_frame: hand
limits:
  acceleration: {turn: {value: 2 rad/s^2, source: made up}}
  jerk: {turn: {value: 20 rad/s^3, source: made up}}
packages: {driver: null, sdk: null, description: null}
control:
  component: "{device}_hardware"
  hardware: {mock: {plugin: mock_components/GenericSystem, source: made up}}
  joints: {turn: {command: [position], state: [position, velocity]}}
"""
CUBE = """solid cube
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 0.1 0 0
vertex 0 0.1 0.1
endloop
endfacet
endsolid
"""


@pytest.fixture(name="repository")
def repository_fixture(tmp_path: Path) -> Path:
    """A repository with the cell in `cells/bench` and a package of the arm in `vendor/src/repo/arm_parts`."""
    (tmp_path / ".git").mkdir()
    parts = tmp_path / "vendor" / "src" / "repo" / "arm_parts"
    parts.mkdir(parents=True)
    (parts / "hand.xacro").write_text(_HAND.replace("NAME", "hand.stl"))
    (parts / "hand.stl").write_text(CUBE)
    device = tmp_path / "cells" / "bench" / "arm"
    device.mkdir(parents=True)
    (device / "arm.xacro").write_text(_ARM)
    (device / "device.yaml").write_text(DEVICE)
    return tmp_path


def _spec(repository: Path, places: str = "../../vendor") -> Path:
    return written(repository / "cells" / "bench", CELL.replace("PLACES", places))


def test_xacro_and_mesh_of_a_named_folder_are_found_by_check_build_and_mock(repository: Path) -> None:
    spec = _spec(repository)
    assert "mesh-not-found" not in {diagnosis.code for diagnosis in diagnose(spec)}
    cell = load(build_into(repository / "generated" / "bench", spec))
    assert cell.run("wave").outcome == "succeeded"


def test_without_the_folder_its_package_is_not_found_and_the_help_names_the_key(repository: Path) -> None:
    (found,) = diagnose(_spec(repository, ""))
    assert found.code == "xacro-package-not-found"
    assert "`packages:`" in found.help


def test_answer_follows_the_folder_that_is_named_first(repository: Path) -> None:
    shutil.copytree(repository / "vendor", repository / "other")
    hand = repository / "other" / "src" / "repo" / "arm_parts" / "hand.stl"
    hand.unlink()
    # The description of the first folder names a mesh that the second has.
    assert "mesh-not-found" not in {
        diagnosis.code for diagnosis in diagnose(_spec(repository, "../../other, ../../vendor"))
    }
    assert "mesh-not-found" in {diagnosis.code for diagnosis in diagnose(_spec(repository, "../../other"))}


def test_vendors_shapes_are_taken_from_a_named_folder(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    (tmp_path / "cell").mkdir()
    shutil.copytree(CORPUS / "invalid" / "base" / "vendored_arm", tmp_path / "cell" / "vendored_arm")
    package = "vendored_arm_description"
    (tmp_path / "cell" / "vendored_arm" / package).rename(tmp_path / package)
    text = CELL.partition("motion:")[0].replace("./arm", "./vendored_arm").partition("    arm_tra")[0]
    for places, found in (("", False), ("..", True)):
        (device,) = linked(written(tmp_path / "cell", text.replace("PLACES", places))).devices
        vendor = there(device.body.vendor_description)
        assert (vendor.description is not None) is found


@pytest.mark.parametrize("place", ["../../..", "/usr", "leaving"])
def test_folder_out_of_the_repository_is_refused(
    repository: Path, tmp_path_factory: pytest.TempPathFactory, place: str
) -> None:
    (repository / "cells" / "bench" / "leaving").symlink_to(tmp_path_factory.mktemp("elsewhere"))
    (found,) = linking(_spec(repository, place)).diagnostics
    assert (found.code, found.span.line) == ("include-escape", 4)


def test_without_version_control_the_spec_and_its_packages_are_one_folder(repository: Path) -> None:
    (repository / ".git").rmdir()
    (found,) = linking(_spec(repository)).diagnostics
    assert found.code == "include-escape"


def test_folder_that_is_not_there_is_named(repository: Path) -> None:
    (found,) = linking(_spec(repository, "../../vendors")).diagnostics
    assert found.code == "file-not-found"
    assert "vendors`" in found.message


def test_link_in_a_named_folder_leads_to_no_file_out_of_the_repository(
    repository: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    hand = repository / "vendor" / "src" / "repo" / "arm_parts" / "hand.xacro"
    outside = tmp_path_factory.mktemp("elsewhere") / "secret.xacro"
    hand.rename(outside)
    hand.symlink_to(outside)
    assert {diagnostic.code for diagnostic in linking(_spec(repository)).diagnostics} == {"xacro-outside-root"}


def test_contract_names_the_folders_from_the_spec(repository: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spec = _spec(repository)
    monkeypatch.chdir(repository / "cells")
    assert compiled(Path("bench/cell.yaml")).texts == compiled(spec).texts
    assert '"packages": ["../../vendor"]' in compiled(spec).texts["contract.json"]


def test_init_and_import_write_the_folder_where_they_find_a_package(
    repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    (repository / "src" / "ur_description").mkdir(parents=True)
    assert run("init", "two", "ur5e").code == 0
    assert "packages: [../..]\n" in (repository / "cells" / "two" / "cell.yaml").read_text(encoding="utf-8")
    look = '<visual><geometry><mesh filename="package://arm_parts/hand.stl"/></geometry></visual>'
    text = _ARM.replace(_ARM.splitlines()[1], f'<link name="hand">{look}</link>')
    (repository / "vendor" / "src" / "repo" / "arm_parts" / "package.xml").write_text("<name>arm_parts</name>")
    (repository / "vendor" / "src" / "repo" / "arm_parts" / "arm.urdf").write_text(text)
    ran = run("import", "vendor/src/repo/arm_parts/arm.urdf", "-o", "cells/own/robot", "--cell")
    assert ran.code == 0, ran.out
    assert "packages: [../../vendor]\n" in (repository / "cells" / "own" / "cell.yaml").read_text(encoding="utf-8")
