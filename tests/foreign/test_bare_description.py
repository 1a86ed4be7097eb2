"""`cellc check` of a URDF or xacro alone finds what is wrong in it, at its line, and nothing in a clean one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.run import run

_CLEAN = """<robot name="arm">
<link name="base"/>
<link name="upper"><inertial><mass value="1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
<link name="jaw"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" velocity="1" effort="10"/></joint>
<joint name="grip" type="prismatic"><parent link="upper"/><child link="jaw"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.04" velocity="0.1" effort="10"/></joint>
<ros2_control name="arm" type="system">
<hardware><plugin>vendor/Arm</plugin><param name="ip">10.0.0.2</param></hardware>
<joint name="turn"><command_interface name="position"><param name="min">-2</param><param name="max">2</param>
</command_interface><state_interface name="position"/><state_interface name="velocity"/></joint>
<joint name="grip"><command_interface name="position"/><state_interface name="position"/></joint>
<gpio name="io"><command_interface name="out_0"/><state_interface name="in_0"/></gpio>
</ros2_control>
</robot>
"""
_CONTROL = "unusable-ros2-control"
_SECOND = '<ros2_control name="{}" type="system"><hardware><plugin>a/B</plugin></hardware>{}</ros2_control></robot>'
_TURNS = '<joint name="turn"><command_interface name="position"/></joint>'

# what is replaced, by what, the code, the line
FAULTS = {
    "reversed limits": ('lower="-2" upper="2"', 'lower="2" upper="-2"', "reversed-limits", 7),
    "degrees": ('lower="-2" upper="2"', 'lower="-180" upper="180"', "degrees-as-radians", 7),
    "no limit": ('<limit lower="-2" upper="2" velocity="1" effort="10"/>', "", "missing-joint-limits", 6),
    "zero axis": ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>', "zero-axis", 6),
    "long axis": ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 3"/>', "non-unit-axis", 6),
    "negative mass": ('mass value="1"', 'mass value="-1"', "negative-mass", 3),
    "impossible tensor": ('izz="0.01"', 'izz="1"', "impossible-inertia", 3),
    "unknown parent": ('<parent link="upper"/>', '<parent link="uper"/>', "joint-of-unknown-link", 8),
    "two parents": ('<child link="jaw"/>', '<child link="upper"/>', "link-with-two-parents", 8),
    "a link twice": ('<link name="jaw"/>', '<link name="jaw"/><link name="jaw"/>', "duplicate-model-name", 5),
    "two roots": ('<link name="jaw"/>', '<link name="jaw"/><link name="lone"/>', "several-root-links", 5),
    "mimic of nothing": ('<axis xyz="1 0 0"/>', '<axis xyz="1 0 0"/><mimic joint="x"/>', "mimic-of-nothing", 8),
    "unknown type": ('type="prismatic"', 'type="linear"', "urdf-unknown-joint-type", 8),
    "no number": ('velocity="0.1"', 'velocity="fast"', "urdf-bad-number", 9),
    "hardware without a plugin": ("<plugin>vendor/Arm</plugin>", "", _CONTROL, 10),
    "unknown type of hardware": ('name="arm" type="system"', 'name="arm" type="sytem"', _CONTROL, 10),
    "hardware of no joint": ('<joint name="grip"><command', '<joint name="grp"><command', _CONTROL, 14),
    "misspelt interface": ('state_interface name="velocity"', 'state_interface name="velocty"', _CONTROL, 12),
    "reversed command limits": ('<param name="min">-2', '<param name="min">3', _CONTROL, 12),
    "text for a command limit": ('<param name="max">2', '<param name="max">{pi}', "skipped-command-limit", 12),
    "text for an initial value": (
        '"velocity"/>',
        '"velocity"><param name="initial_value">a</param></state_interface>',
        _CONTROL,
        12,
    ),
    "joint commanded twice": ("</robot>", _SECOND.format("more", _TURNS), _CONTROL, 17),
    "component named twice": ("</robot>", _SECOND.format("arm", ""), _CONTROL, 10),
    "commanded follower": ('<axis xyz="1 0 0"/>', '<axis xyz="1 0 0"/><mimic joint="turn"/>', _CONTROL, 14),
}


def _found(folder: Path, text: str, name: str = "arm.urdf") -> list[tuple[str, int]]:
    (folder / name).write_text(text, encoding="utf-8")
    ran = run("check", (folder / name).as_posix(), "--format", "json")
    assert "Traceback" not in ran.err
    return [(diagnostic["code"], diagnostic["line"]) for diagnostic in json.loads(ran.out)["diagnostics"]]


def test_clean_description_has_no_finding(tmp_path: Path) -> None:
    assert _found(tmp_path, _CLEAN) == []


@pytest.mark.parametrize("fault", FAULTS)
def test_single_fault_is_found_at_its_line(fault: str, tmp_path: Path) -> None:
    old, new, code, line = FAULTS[fault]
    assert old in _CLEAN
    assert (code, line) in _found(tmp_path, _CLEAN.replace(old, new, 1))


def test_xacro_is_judged_at_the_line_it_was_written_on(tmp_path: Path) -> None:
    text = _CLEAN.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    text = text.replace('mass value="1"', 'mass value="${1 - 2}"')
    assert _found(tmp_path, text, "arm.urdf.xacro") == [("negative-mass", 3)]


def test_meshes_of_the_package_that_the_description_stands_in_are_found(tmp_path: Path) -> None:
    package = tmp_path / "arm_description"
    for folder in ("urdf", "meshes"):
        (package / folder).mkdir(parents=True)
    (package / "package.xml").write_text("<package/>", encoding="utf-8")
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n"
    (package / "meshes" / "base.stl").write_text(f"solid a\n{facet}endsolid a\n", encoding="utf-8")
    shape = (
        '<link name="base"><collision><geometry><mesh filename="package://arm_description/meshes/{}.stl"/></geometry>'
    )
    box = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    text = _CLEAN.replace('<link name="base"/>', shape.format("base") + "</collision></link>")
    text = text.replace("</inertial></link>", f"</inertial>{box}</link>")
    assert _found(package / "urdf", text) == []
    assert _found(package / "urdf", text.replace("/base.stl", "/absent.stl")) == [("mesh-not-found", 2)]
