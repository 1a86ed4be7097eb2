"""Constructs of vendors' descriptions are read as ROS reads them, and stay in the folder that they came in."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cellc.robot.description.meshes import identify
from cellc.robot.description.model import Description, Mesh
from cellc.robot.description.packages import find_package, root_of
from cellc.robot.description.read_description import read_description
from tests.cli.run import run

_HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
_LINK = '<link name="{0}"><collision><geometry><mesh filename="{1}"/></geometry></collision></link>'


def _read(folder: Path, body: str, **arguments: str) -> Description:
    file = folder / "robot.urdf.xacro"
    file.write_text(f"{_HEAD}{body}</robot>", encoding="utf-8")
    read = read_description(file, arguments, folder)
    assert read.value is not None, read.diagnostics
    return read.value


def _mesh(description: Description) -> str:
    shape = description.links[0].collisions[0].geometry
    assert isinstance(shape, Mesh)
    return shape.filename


@pytest.mark.parametrize("written", ["file:///$(find arm_description)", "file://$(find arm_description)",
                                     "$(find arm_description)", "package://arm_description"])  # fmt: skip
def test_mesh_named_by_the_folder_of_its_package_is_in_the_package(
    written: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # UFACTORY's xarm_description names meshes as `file:///$(find xarm_description)/meshes/…`.
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm_description").mkdir()
    for root in (tmp_path, Path(".")):
        read = _read(root, _LINK.format("a", f"{written}/meshes/a.stl"))
        assert _mesh(read) == "package://arm_description/meshes/a.stl"


@pytest.mark.parametrize(
    ("expression", "value"),
    [("1 + 2 * 3", "7"), ("joints - 1", "5"), ("joints == 6", "True"), ("side == 'left' or joints > 7", "False")],
)
def test_eval_of_arithmetic_and_comparisons_of_arguments_is_computed(
    expression: str, value: str, tmp_path: Path
) -> None:
    body = '<xacro:arg name="joints" default="6"/><xacro:arg name="side" default="right"/>'
    read = _read(tmp_path, f'{body}<link name="x_$(eval {expression})"/>')
    assert read.links[0].name == f"x_{value}"


def test_eval_decides_what_is_in_the_robot(tmp_path: Path) -> None:
    body = '<xacro:arg name="hand" default="false"/><link name="a"/>'
    body += '<xacro:if value="$(eval hand == True)"><link name="b"/></xacro:if>'
    assert [link.name for link in _read(tmp_path, body).links] == ["a"]
    assert [link.name for link in _read(tmp_path, body, hand="true").links] == ["a", "b"]


def test_variable_of_the_environment_is_its_default_whatever_the_machine_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # clearpath's husky_description asks for forty of them.
    monkeypatch.setenv("LASER", "1")
    file = tmp_path / "r.xacro"
    file.write_text(f'{_HEAD}<link name="a_$(optenv LASER 0)"/><link name="b$(optenv LASER)"/></robot>', "utf-8")
    read = read_description(file, {}, tmp_path)
    assert read.value is not None
    assert [link.name for link in read.value.links] == ["a_0", "b"]
    assert ["`$(optenv LASER)`" in diagnostic.message for diagnostic in read.diagnostics] == [True, True]


def test_argument_that_is_used_and_not_declared_is_asked_for_and_can_be_given(tmp_path: Path) -> None:
    # As the AR4's description, whose launch file gives `ar_model`.
    file = tmp_path / "r.xacro"
    file.write_text(f'{_HEAD}<link name="base_$(arg ar_model)"/></robot>', "utf-8")
    (missing,) = read_description(file, {}, tmp_path).diagnostics
    assert (missing.code, missing.message) == ("xacro-missing-argument", "argument `ar_model` has no value")
    assert "`ar_model:=VALUE`" in missing.help
    given = read_description(file, {"ar_model": "mk3"}, tmp_path).value
    assert given is not None
    assert given.links[0].name == "base_mk3"
    (misspelt,) = read_description(file, {"ar_model": "mk3", "ar_modle": "mk2"}, tmp_path).diagnostics
    assert (misspelt.code, misspelt.help) == ("xacro-unknown-argument", "did you mean `ar_model`?")


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("[x * 2 for x in range(3) if x != 1]", "[0, 4]"),
        ("[a + b for a, b in zip_of]", "[3, 7]"),
        ("sorted([-x for x in [1, 2]])[0]", "-2"),
        ("'%s_%02d' % ('link', 7)", "link_07"),
        ("' '.join(['a', 'b']).replace('a', 'c')", "c b"),
        ("5 &amp; 4 | 2", "6"),
        ("python.isinstance('a', str) and not python.isinstance(1, str)", "True"),
        ("list(parts.values())[0] + parts.inner", "16"),
    ],
)
def test_expression_of_vendors_has_the_value_that_python_gives_it(expression: str, value: str, tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text("{pairs: [[1, 2], [3, 4]], parts: {inner: 8}}\n", "utf-8")
    body = '<xacro:property name="p" value="${xacro.load_yaml(\'p.yaml\')}"/>'
    body += '<xacro:property name="zip_of" value="${p.pairs}"/><xacro:property name="parts" value="${p.parts}"/>'
    read = _read(tmp_path, f'{body}<link name="${{{expression}}}"/>')
    assert read.links[0].name == value


def test_aliases_in_a_file_of_parameters_are_written_out(tmp_path: Path) -> None:
    # As franka_description's hand: one block of limits, used for both fingers.
    text = "left: &finger {mass: 0.01, size: [1, 2]}\nright: *finger\nthird: {<<: *finger, mass: 0.02}\n"
    (tmp_path / "hand.yaml").write_text(text, encoding="utf-8")
    body = '<xacro:property name="h" value="${xacro.load_yaml(\'hand.yaml\')}"/>'
    read = _read(tmp_path, body + "<link name=\"m_${h['right']['mass']}_${h['third']['size'][1]}\"/>")
    assert read.links[0].name == "m_0.01_2"


def test_continuous_joint_has_no_ends_whatever_its_limit_says(tmp_path: Path) -> None:
    # Kinova's j2s6s200 writes lower="-6.28" at its continuous joints.
    limit = '<limit lower="-6.28" upper="6.28" effort="30" velocity="0.6"/>'
    joint = f'<joint name="j" type="continuous"><parent link="a"/><child link="b"/>{limit}</joint>'
    read = _read(tmp_path, f'<link name="a"/><link name="b"/>{joint}').joints[0].limit
    assert read is not None
    assert (read.lower, read.upper, read.effort, read.velocity) == (None, None, 30.0, 0.6)


@pytest.mark.parametrize("place", ["src/vendor/arm_description", "my_arm/arm_description", "share/arm_description"])
def test_package_lies_in_a_workspace_or_in_the_folder_of_a_device(place: str, tmp_path: Path) -> None:
    (tmp_path / place / "meshes").mkdir(parents=True)
    (tmp_path / "my_arm").mkdir(exist_ok=True)
    (tmp_path / "my_arm" / "device.yaml").touch()
    (tmp_path / place / "meshes" / "a.stl").write_bytes(b"solid a")
    assert find_package("arm_description", str(tmp_path)) == str(tmp_path / place)
    found = identify("package://arm_description/meshes/a.stl", (tmp_path,), ())
    assert found.path == str(tmp_path / place / "meshes" / "a.stl")


def test_repository_that_is_a_package_of_another_name_is_found_by_its_manifest(tmp_path: Path) -> None:
    # As Universal_Robots_ROS2_Description, whose package is ur_description.
    (tmp_path / "src" / "Vendor_Repository").mkdir(parents=True)
    (tmp_path / "src" / "Vendor_Repository" / "package.xml").write_text("<package>\n <name>arm_description</name>\n")
    assert find_package("arm_description", str(tmp_path)) == str(tmp_path / "src" / "Vendor_Repository")
    assert find_package("Vendor", str(tmp_path)) is None


@pytest.mark.parametrize("deep", ["src/repository/group", "src/repository/group/inner", "group/inner"])
def test_package_in_a_folder_of_a_repository_is_found_as_colcon_finds_it(deep: str, tmp_path: Path) -> None:
    # As Yaskawa's and Dobot's repositories, whose packages lie in folders of one series.
    for name in ("arm_description", "arm_moveit"):
        (tmp_path / deep / name).mkdir(parents=True)
        (tmp_path / deep / name / "package.xml").write_text(f"<package><name>{name}</name></package>", "utf-8")
    assert find_package("arm_description", str(tmp_path)) == str(tmp_path / deep / "arm_description")
    if deep.startswith("src/repository/group") and not deep.endswith("inner"):
        assert root_of(tmp_path / deep / "arm_moveit" / "robot.xacro") == tmp_path


@pytest.mark.parametrize("ignored", ["COLCON_IGNORE", "AMENT_IGNORE", ".hidden", "package.xml"])
def test_package_that_colcon_leaves_out_is_not_found(ignored: str, tmp_path: Path) -> None:
    above = tmp_path / "src" / "repository" / (ignored if ignored.startswith(".") else "group")
    package = above / "arm_description"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm_description</name></package>", "utf-8")
    if not ignored.startswith("."):
        assert find_package("arm_description", str(tmp_path)) == str(package)
        (above / ignored).write_text("<package><name>other</name></package>", "utf-8")
    assert find_package("arm_description", str(tmp_path)) is None


def test_a_link_to_itself_ends_no_search_for_packages(tmp_path: Path) -> None:
    (tmp_path / "neighbor").mkdir()
    (tmp_path / "neighbor" / "cell.yaml").symlink_to("cell.yaml")
    assert find_package("arm_description", str(tmp_path)) is None


def test_packages_are_those_that_the_call_names_and_none_of_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    there = tmp_path / "prefix" / "share" / "hand_description"
    there.mkdir(parents=True)
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n"
    (there / "a.stl").write_text(f"solid a\n{facet}endsolid a\n", encoding="utf-8")
    (there / "a.xacro").write_text(f"{_HEAD}{_LINK.format('a', 'package://hand_description/a.stl')}</robot>", "utf-8")
    cell = tmp_path / "cell"
    cell.mkdir()
    (cell / "arm.urdf.xacro").write_text(
        f'{_HEAD}<xacro:include filename="$(find hand_description)/a.xacro"/></robot>', encoding="utf-8"
    )
    monkeypatch.chdir(cell)
    for name in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.setenv(name, str(tmp_path / "prefix"))
    ran = run("check", "arm.urdf.xacro")
    assert "error[xacro-package-not-found]" in ran.out
    assert "--package-path" in ran.out
    ran = run("check", "arm.urdf.xacro", "--package-path", f"{tmp_path}{os.pathsep}{tmp_path / 'prefix'}")
    assert ran.out == "no findings in arm.urdf.xacro\n"
    assert run("check", "arm.urdf.xacro", "--package-path", "absent").code == 2


def test_link_within_the_repository_is_followed(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    (tmp_path / "vendor" / "arm_description").mkdir(parents=True)
    (tmp_path / "vendor" / "arm_description" / "a.stl").write_bytes(b"solid a")
    (tmp_path / "vendor" / "arm_description" / "a.xacro").write_text(f'{_HEAD}<link name="a"/></robot>', "utf-8")
    cell = tmp_path / "cells" / "mine"
    cell.mkdir(parents=True)
    (cell / "arm_description").symlink_to("../../vendor/arm_description")
    found = identify("package://arm_description/a.stl", (cell,), ())
    assert found.path == str(tmp_path / "vendor" / "arm_description" / "a.stl")
    read = _read(cell, '<xacro:include filename="$(find arm_description)/a.xacro"/>')
    assert [link.name for link in read.links] == ["a"]
