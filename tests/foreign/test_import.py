"""A robot as its vendor ships it becomes a device folder that checks, and a cell that moves it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from tests.cli.run import run

_LIMIT = '<limit lower="-2" upper="2" velocity="1" effort="10"/>'
_BODY = '<inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'


def _joint(name: str, parent: str, child: str, kind: str = "revolute", inside: str = _LIMIT) -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{inside}</joint>'


def _links(*names: str) -> str:
    return "".join(f'<link name="{name}">{_BODY}</link>' for name in names)


def _robot(*parts: str) -> str:
    return f'<robot name="Odd-Arm">{"".join(parts)}</robot>'


ARM = (_links("a", "b", "c"), _joint("j1", "a", "b"), _joint("j2", "b", "c"))


@pytest.fixture(name="here")
def here_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _import(here: Path, text: str, *options: str, name: str = "arm.urdf") -> tuple[int, str]:
    (here / name).write_text(text, encoding="utf-8")
    ran = run("import", name, *options)
    assert "Traceback" not in ran.out + ran.err
    assert "bug of cellc" not in ran.out + ran.err
    assert ran.code == 0 or "next:" not in ran.out
    return ran.code, ran.out + ran.err


def test_imported_robot_moves_in_its_first_cell(here: Path) -> None:
    slide = '<limit lower="0" upper="1" velocity="1" effort="10"/>'
    parts = (_links("rail", "a", "b"), _joint("slide", "rail", "a", "prismatic", slide), _joint("turn", "a", "b"))
    code, out = _import(here, _robot(*parts), "--cell")
    assert code == 0, out
    assert "wrote odd_arm: 3 files" in out
    assert "away: {arm_group: 0.05 m 0.2 rad}" in (here / "cell.yaml").read_text(encoding="utf-8")
    assert run("build", "cell.yaml").code == 0
    ran = run("mock", "generated/odd_arm_cell")
    assert (ran.code, "first_move: succeeded" in ran.out) == (0, True)


def test_origins_at_the_poles_of_pitch_are_built_as_their_vendor_rounded_them(here: Path) -> None:
    parts = [_links("a", "b"), _joint("turn", "a", "b")]
    for place, pitch in enumerate(("-1.570796", "1.5708", "1.57079632679", "-1.5707963267948966", "1.57")):
        turned = f'<parent link="b"/><child link="p{place}"/><origin rpy="0 {pitch} 0"/>'
        parts += [_links(f"p{place}"), f'<joint name="f{place}" type="fixed">{turned}</joint>']
    code, out = _import(here, _robot(*parts), "--cell")
    assert code == 0, out
    built = run("build", "cell.yaml")
    assert (built.code, "verify-frames" in built.out) == (0, False), built.out


def test_links_with_a_slash_in_their_names_are_named_behind_the_first_slash(here: Path) -> None:
    # As Interbotix and ALOHA write them: `vx300s/base_link`.
    text = _robot(*ARM)
    for link in "abc":
        text = text.replace(f'"{link}"', f'"side/{link}_link"')
    code, out = _import(here, text, "--cell")
    assert (code, "next:" in out) == (0, True), out
    cell = here / "cell.yaml"
    spec = cell.read_text(encoding="utf-8")
    assert "{base: arm/side/a_link, tip: arm/side/c_link}" in spec
    camera = "frames:\n  eye: {parent: arm/side/c_link, xyz: 0 0 10 mm}\n"
    cell.write_text(spec.replace("control:\n", f"{camera}control:\n", 1), encoding="utf-8")
    built = run("build", "cell.yaml")
    assert built.code == 0, built.out + built.err
    (urdf,) = here.glob("generated/*/urdf/*.mock.urdf")
    assert '<parent link="arm_side/c_link"/>' in urdf.read_text(encoding="utf-8")
    ran = run("mock", "generated/odd_arm_cell")
    assert (ran.code, "first_move: succeeded" in ran.out) == (0, True)
    assert run("view", "cell.yaml", "-o", "page.html").code == 0


@pytest.mark.parametrize("names", [("n", "o"), ("o", "n")], ids=["leaders first", "leaders last"])
def test_chain_of_followers_moves_in_every_order_of_their_names(names: tuple[str, str], here: Path) -> None:
    first, second = names
    links = (_links("d", "e"), _joint(first, "c", "d", inside=f'{_LIMIT}<mimic joint="j2" multiplier="0.5"/>'))
    last = _joint(second, "d", "e", inside=f'{_LIMIT}<mimic joint="{first}" multiplier="-0.5" offset="0.1"/>')
    code, out = _import(here, _robot(*ARM, *links, last), "--cell")
    assert code == 0, out
    assert run("build", "cell.yaml").code == 0
    (urdf,) = here.glob("generated/*/urdf/*.mock.urdf")
    assert '<mimic joint="arm_j2" multiplier="-0.25" offset="0.1"/>' in urdf.read_text(encoding="utf-8")
    ran = run("mock", "generated/odd_arm_cell")
    assert (ran.code, "first_move: succeeded" in ran.out) == (0, True), ran.out


def test_import_does_not_end_with_a_build_that_fails(here: Path) -> None:
    (here / "cell.yaml").write_text("format: 1\ncell: mine\nversions: {ros: jazy}\n", encoding="utf-8")
    code, out = _import(here, _robot(*ARM), "--cell")
    assert (code, "next:" in out, "missing-key" in out) == (1, False, True), out
    (here / "cell.yaml").unlink()
    bad = _robot(*ARM).replace('<mass value="1"/>', '<mass value="-1"/>')
    code, out = _import(here, bad, "--cell", "-o", "bad")
    assert (code, "negative-mass" in out) == (1, True), out


def test_first_motion_goes_round_what_stands_on_its_straight_way(here: Path) -> None:
    # A bar 10 mm wide turns past a post 10 mm wide, 0.3 m out at 0.1 rad: it touches from 0.07 to 0.13 rad.
    bar = '<collision><origin xyz="0.25 0 0.1"/><geometry><box size="0.5 0.01 0.01"/></geometry></collision>'
    post = '<collision><origin xyz="0.2985 0.03 0.4"/><geometry><box size="0.01 0.01 0.1"/></geometry></collision>'
    links = f'<link name="a">{post}</link><link name="b"/><link name="c">{bar}</link>'
    spin = _joint("spin", "a", "b").replace("0 1 0", "0 0 1")
    code, out = _import(here, _robot(links, spin, _joint("nod", "b", "c").replace("0 0 0.3", "0 0 0")), "--cell")
    assert code == 0, out
    assert "away: {arm_group: -0.2 0.2 rad}" in (here / "cell.yaml").read_text(encoding="utf-8")


def test_joint_that_mimics_an_absent_one_is_a_joint_of_its_own_that_stands(here: Path) -> None:
    finger = (_links("d"), _joint("finger", "c", "d", inside=f'{_LIMIT}<mimic joint="thumb"/>'))
    code, out = _import(here, _robot(*ARM, *finger), "--cell")
    assert code == 0, out
    assert "excused: {mimic-of-nothing: 'UNKNOWN" in (here / "odd_arm" / "device.yaml").read_text(encoding="utf-8")
    assert run("build", "cell.yaml").code == 0
    (urdf,) = here.glob("generated/*/urdf/*.mock.urdf")
    assert "<mimic" not in urdf.read_text(encoding="utf-8")
    assert run("mock", "generated/odd_arm_cell").code == 0


def test_follower_without_interfaces_is_how_vendors_write_it(here: Path) -> None:
    # As in example-robot-data's TIAGo Pro: ros2_control takes the factors from parameters, or from `<mimic>`.
    tag = (
        '<ros2_control name="arm" type="system"><hardware><plugin>vendor_driver/Arm</plugin></hardware>'
        '<joint name="j1"><command_interface name="position"/><state_interface name="position"/></joint>'
        '<joint name="j3"><param name="mimic">j2</param><param name="multiplier">1</param></joint></ros2_control>'
    )
    finger = (_links("d"), _joint("j3", "c", "d", inside=f'{_LIMIT}<mimic joint="j2"/>'))
    code, out = _import(here, _robot(*ARM, *finger, tag))
    assert code == 0, out


def test_second_import_leaves_what_a_person_wrote_and_tells_what_changed(here: Path) -> None:
    assert _import(here, _robot(*ARM))[0] == 0
    assert run("import", "--check", "odd_arm").code == 0
    device = here / "odd_arm" / "device.yaml"
    device.write_text(device.read_text(encoding="utf-8").replace("vendor: UNKNOWN", "vendor: Us"), encoding="utf-8")
    (here / "odd_arm" / "robot.urdf").write_text("changed", encoding="utf-8")
    checked = run("import", "--check", "odd_arm")
    assert (checked.code, "changed: robot.urdf" in checked.out) == (1, True)
    refused = _import(here, _robot(*ARM))
    assert (refused[0], "error[edited-by-hand]: `robot.urdf`" in refused[1]) == (1, True)
    code, out = _import(here, _robot(*ARM), "--force")
    assert (code, "odd_arm/device.yaml is unchanged" in out) == (0, True)
    assert "vendor: Us" in device.read_text(encoding="utf-8")
    assert run("import", "--check", "odd_arm").code == 0


def test_second_import_brings_what_the_vendor_changed_and_keeps_what_a_person_wrote(here: Path) -> None:
    slide = '<limit lower="0" upper="1" velocity="1" effort="10"/>'
    assert _import(here, _robot(*ARM))[0] == 0
    device = here / "odd_arm" / "device.yaml"
    text = device.read_text(encoding="utf-8")
    text = text.replace("vendor: UNKNOWN", "vendor: Us  # asked on the phone").replace("2 rad/s^2", "7 rad/s^2", 1)
    device.write_text(text, encoding="utf-8")
    changed = _robot(_links("a", "b", "c", "d"), *ARM[1:], _joint("j3", "c", "d", "prismatic", slide))
    code, out = _import(here, changed)
    assert code == 0, out
    assert "changes of the vendor: summary, frames, tool_frame, limits" in out
    merged = yaml.safe_load(device.read_text(encoding="utf-8"))
    assert "vendor: Us  # asked on the phone\n" in device.read_text(encoding="utf-8")
    assert (merged["summary"], merged["tool_frame"]) == ("Odd-Arm, 3 joints", "d")
    acceleration = {name: one["value"] for name, one in merged["limits"]["acceleration"].items()}
    assert acceleration == {"*": "7 rad/s^2", "j3": "0.5 m/s^2"}
    assert "is unchanged" in _import(here, changed)[1]


def test_pair_that_a_person_took_out_stays_out(here: Path) -> None:
    near = '<collision><origin xyz="0 0 {}"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    shapes = {"a": 0.0, "c": -0.6, "d": -0.9}  # in one place where every joint is at zero
    links = "".join(
        f'<link name="{name}">{near.format(shapes[name]) if name in shapes else ""}</link>' for name in "abcd"
    )
    robot = _robot(links, *ARM[1:], _joint("j3", "c", "d"))
    assert _import(here, robot)[0] == 0
    device = here / "odd_arm" / "device.yaml"
    facts = yaml.safe_load(device.read_text(encoding="utf-8"))
    assert [collision["links"] for collision in facts["allowed_collisions"]] == [["a", "c"], ["a", "d"]]
    facts["allowed_collisions"] = facts["allowed_collisions"][:1]
    device.write_text(yaml.safe_dump(facts), encoding="utf-8")
    code, out = _import(here, robot)
    assert (code, "pose-in-self-collision" in out or "start-in-collision" in out) == (1, True)
    facts = yaml.safe_load(device.read_text(encoding="utf-8"))
    assert [collision["links"] for collision in facts["allowed_collisions"]] == [["a", "c"]]


def test_what_the_files_do_not_say_is_a_question(here: Path) -> None:
    assert _import(here, _robot(*ARM))[0] == 0
    head = (here / "odd_arm" / "device.yaml").read_text(encoding="utf-8").partition("format:")[0]
    assert "what does the vendor allow?" in head
    assert "which plugin drives the robot" in head
    assert "may the description be kept" in head


def test_plugin_and_interfaces_are_those_of_ros2_control(here: Path) -> None:
    tag = (
        '<ros2_control name="x" type="system"><hardware><plugin>vendor_driver/Arm</plugin>'
        '<param name="robot_ip">10.0.0.2</param></hardware><joint name="j1"><command_interface name="position"/>'
        '<command_interface name="velocity"/><state_interface name="position"/></joint></ros2_control>'
    )
    _import(here, _robot(*ARM, tag))
    text = (here / "odd_arm" / "device.yaml").read_text(encoding="utf-8")
    assert "plugin: vendor_driver/Arm" in text
    assert "robot_ip: 10.0.0.2" in text
    assert "command: [position, velocity]" in text


def test_pairs_of_an_srdf_may_touch_and_say_why(here: Path) -> None:
    pair = '<disable_collisions link1="c" link2="a" reason="Never"/><disable_collisions link1="a" link2="nobody"/>'
    (here / "arm.srdf").write_text(f'<robot name="Odd-Arm">{pair}</robot>', encoding="utf-8")
    assert _import(here, _robot(*ARM), "--srdf", "arm.srdf", "--cell")[0] == 0
    assert "because: arm.srdf says Never" in (here / "odd_arm" / "device.yaml").read_text(encoding="utf-8")
    assert run("build", "cell.yaml").code == 0
    assert "is not looked for: arm.srdf says Never" in run("audit", "cell.yaml").out


def test_srdf_and_controllers_beside_a_description_are_read_by_themselves(here: Path) -> None:
    pair = '<disable_collisions link1="a" link2="c" reason="Never"/>'
    near = {
        "package.xml": "<package><name>odd_arm_description</name></package>",
        "srdf/arm.srdf": f'<robot name="Odd-Arm">{pair}</robot>',
        "urdf/arm.srdf": f'<robot name="Other">{pair.replace("Never", "Adjacent")}</robot>',
        "config/other.yaml": "/**: {hand: {ros__parameters: {joints: [j9], constraints: {goal_time: 9.0}}}}",
        "config/broken.yaml": "a: [",
        "config/ros2_controllers.yaml": "controller_manager: {ros__parameters: {update_rate: 250}}\n"
        "arm_controller: {ros__parameters: {joints: [j2, j1], constraints: {goal_time: 0.6}}}\n",
    }
    for name, text in near.items():
        (here / name).parent.mkdir(exist_ok=True)
        (here / name).write_text(text, encoding="utf-8")
    code, out = _import(here, _robot(*ARM), "--cell", name="urdf/arm.urdf")
    assert code == 0, out
    assert f"read {here}/srdf/arm.srdf\nread {here}/config/ros2_controllers.yaml\n" in out
    assert "because: arm.srdf says Never" in (here / "odd_arm" / "device.yaml").read_text(encoding="utf-8")
    cell = (here / "cell.yaml").read_text(encoding="utf-8")
    assert ("update_rate: 250 Hz" in cell, "goal_time: 0.6 s" in cell) == (True, True)
    wrong = _import(here, _robot(*ARM), "--controllers", "config/other.yaml", name="urdf/arm.urdf")
    assert (wrong[0], "has no controller of j1, j2" in wrong[1]) == (2, True)


def test_files_of_other_folders_are_nobody_s_where_there_is_no_package(here: Path) -> None:
    told = "arm_controller: {ros__parameters: {joints: [j2, j1], constraints: {goal_time: 0.6}}}\n"
    (here / "somebody").mkdir()
    (here / "somebody" / "controllers.yaml").write_text(told, encoding="utf-8")
    (here / "urdf").mkdir()
    code, out = _import(here, _robot(*ARM), "--cell", name="urdf/arm.urdf")
    assert code == 0, out
    assert "controllers.yaml" not in out
    assert "goal_time: 0.6 s" not in (here / "cell.yaml").read_text(encoding="utf-8")


def test_aliases_of_a_file_of_parameters_are_followed_once(here: Path) -> None:
    laughs = "a0: &a0 {x: {y: 1}}\n" + "".join(
        f"a{n}: &a{n} {{{', '.join(f'k{k}: *a{n - 1}' for k in range(9))}}}\n" for n in range(1, 12)
    )
    (here / "laughs.yaml").write_text(f"# ros__parameters\n{laughs}", encoding="utf-8")
    assert _import(here, _robot(*ARM), "--cell")[0] == 0


def test_meshes_of_collision_shapes_come_along_and_no_others(here: Path) -> None:
    package = here / "vendor_description"
    (package / "meshes").mkdir(parents=True)
    (package / "package.xml").write_text("<package><license>BSD</license></package>", encoding="utf-8")
    triangle = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n"
    for name in ("hull", "pretty"):
        (package / "meshes" / f"{name}.stl").write_text(f"solid a\n{triangle}endsolid a\n", encoding="utf-8")
    mesh = '<geometry><mesh filename="package://vendor_description/meshes/{}.stl"/></geometry>'
    seen = f"<visual>{mesh.format('pretty')}</visual><collision>{mesh.format('hull')}</collision>"
    text = _robot(*ARM).replace('<link name="a">', f'<link name="a">{seen}')
    (package / "arm.urdf").write_text(text, encoding="utf-8")
    assert run("import", "vendor_description", "-o", "mine").code == 0
    lock = json.loads((here / "mine" / "import.lock.json").read_text(encoding="utf-8"))
    assert sorted(lock["files"]) == ["robot.urdf", "vendor_description/meshes/hull.stl"]
    assert "license BSD" in (here / "mine" / "device.yaml").read_text(encoding="utf-8")
    written = [file for file in (here / "mine").rglob("*") if file.is_file()]
    assert len(written) == 4
    assert [file for file in written if file.stat().st_mode & 0o111] == []  # nothing of a stranger's can be run


@pytest.mark.parametrize("named", ["hull.stl", "meshes/hull.stl", "assets/left/hull.stl"])
def test_a_mesh_that_is_named_from_the_file_comes_along(named: str, here: Path) -> None:
    # As in the SO-100, whose repository is not a package.
    triangle = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n"
    names = (named, "assets/right/hull.stl")
    for name in names:
        mesh = here / "urdf" / name
        mesh.parent.mkdir(parents=True, exist_ok=True)
        mesh.write_text(f"solid a\n{triangle}endsolid {name}\n", encoding="utf-8")
    shapes = (f'<collision><geometry><mesh filename="{name}"/></geometry></collision>' for name in names)
    text = _robot(*ARM).replace('<link name="a">', f'<link name="a">{"".join(shapes)}')
    (here / "urdf/arm.urdf").write_text(text, encoding="utf-8")
    assert run("import", "urdf/arm.urdf", "-o", "mine").code == 0
    copies = {file.read_text(encoding="utf-8").split()[-1] for file in (here / "mine").rglob("*.stl")}
    assert copies == set(names)
    assert "are missing" not in (here / "mine/device.yaml").read_text(encoding="utf-8")


def test_package_behind_three_slashes_is_the_package(here: Path) -> None:
    # As in example-robot-data's TALOS.
    (here / "talos_data").mkdir()
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n"
    (here / "talos_data" / "a.stl").write_text(f"solid a\n{facet}endsolid a\n", encoding="utf-8")
    mesh = '<collision><geometry><mesh filename="package:///talos_data/a.stl"/></geometry></collision>'
    assert _import(here, _robot(*ARM).replace('<link name="a">', f'<link name="a">{mesh}'))[0] == 0
    assert (here / "odd_arm" / "talos_data" / "a.stl").is_file()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("model: odd_arm", "model: odd arm"),
        ('component: "{device}_hardware"', 'component: "{device} hardware"'),
        ("state: [position, velocity]", "state: [position, my velocity]"),
        ("plugin: mock_components/GenericSystem", "plugin: mock components/GenericSystem"),
        ("tool_frame: c", "tool_frame: the c"),
    ],
)
def test_name_with_a_space_is_refused_at_its_line(old: str, new: str, here: Path) -> None:
    assert _import(here, _robot(*ARM), "--cell")[0] == 0
    file = here / "odd_arm" / "device.yaml"
    text = file.read_text(encoding="utf-8").replace("'{device}_hardware'", '"{device}_hardware"')
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    line = text.partition(old)[0].count("\n") + 1
    out = run("check", "cell.yaml").out
    assert "error[catalog-entry-invalid]" in out
    assert f"odd_arm/device.yaml:{line}:" in out


_TURNING = "".join(
    _joint(f"j{number}", f"l{number}", f"l{number + 1}", "fixed" if number % 4 else "revolute")
    for number in range(200)
)  # fmt: skip
NASTY = {
    "reversed limits": (
        _robot(_links("a", "b"), _joint("j", "a", "b", inside=_LIMIT.replace('"-2"', '"3"'))),
        "`Odd-Arm` has no joint that can move: `j` has the range 3 to 2",
    ),
    "a speed below zero": (
        _robot(_links("a", "b", "c"), _joint("i", "a", "b", "continuous", '<limit velocity="-1" effort="1"/>'),
               _joint("j", "b", "c", inside=_LIMIT.replace('"1"', '"-1"'))),
        "`i` has a velocity of -1, and 1 more",
    ),
    "two roots": (_robot(_links("a", "b", "lone"), _joint("j", "a", "b")), "must have one root, got a, lone"),
    "a name with a space": (_robot(_links("a", "the tool"), _joint("j", "a", "the tool")), "got `the tool`"),
    "a name that is a number": (
        _robot(_links("a", "b"), _joint("0", "a", "b")),
        "must begin with a letter and hold letters, digits and `_./-`, got `0`; rename it in the description,"
        " to `joint_0` for one",
    ),
    "a name beyond ASCII": (_robot(_links("a", "grüße"), _joint("j", "a", "grüße")), "got `grüße`"),
    "degrees for radians": (
        _robot(_links("a", "b"), _joint("j", "a", "b", inside=_LIMIT.replace("-2", "-180").replace('"2"', '"180"'))),
        "degrees-as-radians",
    ),
    "zero mass": (
        _robot(*ARM).replace('<mass value="1"/>', '<mass value="-1"/>'),
        "negative-mass",
    ),
    "mimic in a circle": (
        _robot(_links("a", "b", "c"), _joint("j0", "a", "b", inside=f'{_LIMIT}<mimic joint="j1"/>'),
               _joint("j1", "b", "c", inside=f'{_LIMIT}<mimic joint="j0"/>')),
        "no joint that can move: its joints are fixed, or mimic each other",
    ),
    "mimic of a fixed joint": (
        _robot(*ARM, _links("f", "g"), _joint("x", "a", "f", "fixed", ""),
               _joint("y", "a", "g", inside=f'{_LIMIT}<mimic joint="x"/>')),
        "mimic-of-fixed-joint",
    ),
    "a closed loop": (_robot(*ARM, _joint("back", "c", "b")), "link-with-two-parents"),
    "nothing that moves": (
        _robot(_links("a", "b"), _joint("j", "a", "b", "fixed", "")),
        "no joint that can move: its joints are fixed",
    ),
    "a wheel that is fixed": (
        _robot(_links("a", "b", "c"), _joint("i", "a", "b", "fixed", ""), _joint("wheel", "b", "c", "fixed")),
        "`wheel` is fixed and has a `<limit>`, correct its type",
    ),
    "not a robot": ("<sdf/>", "urdf-not-a-robot"),
    "not closed": ("<robot name='x'>", "xml-not-well-formed"),
}  # fmt: skip


@pytest.mark.parametrize("case", NASTY)
def test_nasty_description_is_refused_for_its_own_reason(case: str, here: Path) -> None:
    text, reason = NASTY[case]
    code, out = _import(here, text)
    assert code == 1
    assert reason in out


def test_missing_package_and_two_hundred_joints_are_no_reason_to_refuse(here: Path) -> None:
    mesh = '<collision><geometry><mesh filename="package://absent/a.stl"/></geometry></collision>'
    links = "".join(f'<link name="l{number}">{mesh if number < 3 else ""}</link>' for number in range(201))
    code, out = _import(here, _robot(links, _TURNING))
    assert code == 0, out
    assert "meshes that are missing, package://absent/a.stl: where" in (here / "odd_arm" / "device.yaml").read_text(
        encoding="utf-8"
    )


@pytest.mark.parametrize("named", ["nowhere", "nowhere.urdf", "."])
def test_robot_that_is_not_there_is_refused_in_one_line(named: str, here: Path) -> None:
    ran = run("import", named)
    assert (ran.code, ran.out.count("\n")) == (1, 1)


def test_follower_without_limits_is_excused(here: Path) -> None:
    finger = (_links("d"), _joint("finger", "c", "d", inside='<limit effort="1" velocity="1"/><mimic joint="j2"/>'))
    assert _import(here, _robot(*ARM, *finger), "--cell")[0] == 0
    text = (here / "odd_arm" / "device.yaml").read_text(encoding="utf-8")
    assert "excused: {missing-joint-limits: 'UNKNOWN" in text
    assert "`missing-joint-limits` of its description is excused" in run("audit", "cell.yaml").out
    assert run("build", "cell.yaml").code == 0
    assert run("mock", "generated/odd_arm_cell").code == 0


def test_home_at_a_limit_of_many_digits_stays_within_it(here: Path) -> None:
    limit = _LIMIT.replace('"-2"', '"-2.77507351"').replace('"2"', '"-0.61086523819"')
    code, out = _import(here, _robot(_links("a", "b"), _joint("knee", "a", "b", inside=limit)))
    assert code == 0, out


def test_wheel_that_turns_without_limits_is_described_without_them(here: Path) -> None:
    wheel = _joint("caster", "a", "wheel", "continuous", "")
    code, out = _import(here, _robot(*ARM, _links("wheel"), wheel), "--cell")
    assert code == 0, out
    ran = run("build", "cell.yaml")
    assert ran.code == 0, ran.out
    (urdf,) = here.glob("generated/*/urdf/*.mock.urdf")
    joint = urdf.read_text(encoding="utf-8").partition('name="arm_caster"')[2].partition("</joint>")[0]
    assert "continuous" in joint
    assert "<limit" not in joint
