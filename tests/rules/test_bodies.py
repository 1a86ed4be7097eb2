"""Figures of own descriptions that no machine has, each reported at its own line."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.pipeline import judge

ARM = """<robot name="arm">
<link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
<link name="arm"><inertial><origin xyz="0 0 0.1"/><mass value="2"/>INERTIA</inertial>SHAPE</link>
<link name="rod"><visual><geometry><mesh filename="rod.stl" scale="0.001 0.001 0.001"/></geometry></visual>ROD</link>
<joint name="turn" type="revolute">TURN<limit lower="-2" upper="2" velocity="3" effort="50"/></joint>
<joint name="slide" type="prismatic">SLIDE<limit lower="0" upper="0.5" velocity="1" effort="99"/></joint>
</robot>
"""
INERTIA = '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>'
SHAPE = '<collision><geometry><cylinder radius="0.04" length="0.2"/></geometry></collision>'
ROD = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
for name, part in (
    ("INERTIA", INERTIA),
    ("SHAPE", SHAPE),
    ("ROD", ROD),
    ("TURN", '<parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><origin xyz="0 0 0.267"/>'),
    ("SLIDE", '<parent link="arm"/><child link="rod"/><axis xyz="0 0 1"/><origin xyz="0 0 0.3"/>'),
):
    ARM = ARM.replace(name, part)

CASES = {
    # What is replaced, by what, the line, and what is said.
    "degrees a second": ('velocity="3"', 'velocity="180"', 5, "the velocity must be from 1e-05 rad/s to 50 rad/s"),
    "millimeters a second": (
        'upper="0.5" velocity="1"',
        'upper="0.5" velocity="250"',
        6,
        "must be from 1e-05 m/s to 15 m/s",
    ),
    "travel in millimeters": ('upper="0.5"', 'upper="500"', 6, "the range must be from 0.0001 m to 100 m"),
    "offset in millimeters": ('xyz="0 0 0.267"', 'xyz="0 0 267"', 5, "the way from its parent must be at most 15 m"),
    "mass in milligrams": ('mass value="2"', 'mass value="2000000"', 3, "the mass must be at most 5000 kg"),
    # sqrt(10 / 2) = 2.236 m.
    "inertia of a lorry": (
        'ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"',
        'ixx="10" ixy="0" ixz="0" iyy="10" iyz="0" izz="10"',
        3,
        "got 2236 mm",
    ),
    "center in millimeters": (
        '<origin xyz="0 0 0.1"/>',
        '<origin xyz="0 0 100"/>',
        3,
        "the distance of the center of mass",
    ),
    "box in millimeters": ('box size="0.2 0.2 0.1"', 'box size="200 200 100"', 2, "a measure of the shape must be"),
    "radius of nothing": ('radius="0.04"', 'radius="0.00001"', 3, "a measure of the shape must be"),
    "scale of nothing": ("0.001 0.001 0.001", "0.0000001 0.001 0.001", 4, "the scale of the mesh must be"),
    # Within 80 by 80 by 200 mm, 1.28 liters: 78 times as dense as water, and a thousandth of it.
    "mass of another link": (
        'mass value="2"',
        'mass value="100"',
        3,
        "the density must be from 2 kg/m^3 to 20000 kg/m^3",
    ),
    # 0.12 by 0.12 by 0.2 mm: a shape in mm that was scaled once more, and that no collision check would meet.
    "shape scaled twice": (
        'radius="0.04" length="0.2"',
        'radius="0.00006" length="0.0002"',
        3,
        "the density must be from 2 kg/m^3 to 20000 kg/m^3",
    ),
    "mass in tons": ('mass value="2"', 'mass value="0.002"', 3, "got 1.56 kg/m^3"),
    # sqrt(0.00001 / 2) = 2.24 mm; 8 % of 200 mm.
    "inertia of a screw": (
        'ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"',
        'ixx="0.00001" ixy="0" ixz="0" iyy="0.00001" iyz="0" izz="0.00001"',
        3,
        "from 16 mm to 700 mm, link `arm`, within its body, which is 200 mm long, got 2.24 mm",
    ),
    "effort of nothing": ('effort="50"', 'effort="0"', 5, "joint `turn` must have an effort above zero, got 0"),
    "range of nothing": ('lower="-2" upper="2"', 'lower="0" upper="0"', 5, "joint `turn` must have a range"),
    "without ends": (
        'name="turn" type="revolute"',
        'name="turn" type="continuous"',
        5,
        "its limits of -2 and 2 rad are not held",
    ),
    "without shape": (
        '<collision><geometry><cylinder radius="0.04" length="0.2"/></geometry></collision>',
        "",
        3,
        "has no shape that can collide",
    ),
    "only to look at": (
        '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>',
        "",
        4,
        "has no shape that can collide",
    ),
}
CODES = {"implausible-description", "continuous-with-limits", "limits-of-nothing", "moving-link-without-shape"}


def said_of(tmp_path: Path, text: str) -> list[tuple[int, str]]:
    file = tmp_path / "arm.urdf"
    file.write_text(text, encoding="utf-8")
    return [(item.span.line, item.message) for item in judge(file) if item.code in CODES]


def test_a_sound_arm_has_no_finding(tmp_path: Path) -> None:
    assert said_of(tmp_path, ARM) == []


@pytest.mark.parametrize("name", CASES)
def test_a_figure_that_no_machine_has_is_reported_at_its_line(name: str, tmp_path: Path) -> None:
    old, new, line, said = CASES[name]
    assert ARM.count(old) == 1
    found = said_of(tmp_path, ARM.replace(old, new))
    assert [(at, said in message) for at, message in found] == [(line, True)], found


def test_a_figure_of_a_part_of_several_lines_is_reported_at_its_element(tmp_path: Path) -> None:
    text = ARM.replace('<limit lower="-2"', '\n<limit lower="-2"').replace('velocity="3"', 'velocity="180"')
    text = text.replace("<inertial><origin", "\n<inertial><origin").replace('mass value="2"', 'mass value="100"')
    assert sorted(line for line, _ in said_of(tmp_path, text)) == [4, 7]


def test_a_mesh_of_millimeters_is_reported_at_its_element(tmp_path: Path) -> None:
    # One triangle that reaches 250 from its origin, which is 250 m unless it is scaled.
    corners = "".join(f"vertex {corner}\n" for corner in ("0 0 0", "250 0 0", "0 100 0"))
    stl = f"solid rod\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\nendsolid rod\n"
    (tmp_path / "rods").mkdir()
    (tmp_path / "rods" / "rod.stl").write_text(stl, encoding="utf-8")
    shape = '<collision><geometry>\n<mesh filename="package://rods/rod.stl"{}/></geometry></collision>'
    assert said_of(tmp_path, ARM.replace(ROD, shape.format(' scale="0.001 0.001 0.001"'))) == []
    ((line, message),) = said_of(tmp_path, ARM.replace(ROD, shape.format("")))
    assert (line, "the reach of the mesh must be from" in message, "got 250 m" in message) == (5, True, True)


def test_a_fast_joint_is_judged_by_what_it_moves(tmp_path: Path) -> None:
    # 45 rad/s is slow for a spindle; a link 0.9 m away would have 40 m/s, 25 m/s are the bound.
    fast = ARM.replace('velocity="3"', 'velocity="45"')
    assert said_of(tmp_path, fast) == []  # 45 * 0.3 = 13.5 m/s
    ((line, message),) = said_of(tmp_path, fast.replace('xyz="0 0 0.3"', 'xyz="0 0 0.9"'))
    assert (line, "the speed of the farthest link must be at most 25 m/s" in message) == (5, True)


def test_a_chain_of_thousands_of_links_is_no_trouble(tmp_path: Path) -> None:
    links = "".join(f'<link name="l{number}"/>' for number in range(3000))
    joints = "".join(
        f'<joint name="j{number}" type="fixed"><parent link="l{number}"/><child link="l{number + 1}"/></joint>'
        for number in range(2999)
    )
    assert said_of(tmp_path, f'<robot name="arm">{links}{joints}</robot>') == []
