"""What an imported robot is and where its tool is, by the evidence of its description; what is not certain is asked."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from cellc.robot.description.urdf_reader import read_urdf
from cellc.tools.importing.role import Role, role_of
from tests.cli.run import run

_LIMIT = '<limit lower="-1" upper="1" velocity="1" effort="10"/>'


def _joint(
    name: str,
    parent: str,
    child: str,
    kind: str = "revolute",
    *,
    at: str = "0 0 0.3",
    axis: str = "0 1 0",
    more: str = "",
) -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="{at}"/><axis xyz="{axis}"/>'
    limit = "" if kind == "fixed" else _LIMIT
    return f'<link name="{child}"/><joint name="{name}" type="{kind}">{ends}{limit}{more}</joint>'


def _chain(count: int, name: str = "j", root: str = "base", kind: str = "revolute") -> str:
    links = [root, *(f"{name}_link{number}" for number in range(1, count + 1))]
    return "".join(_joint(f"{name}{number + 1}", links[number], links[number + 1], kind) for number in range(count))


def _fingers(count: int, joints: int, palm: str = "base") -> str:
    text = ""
    for finger in range(count):
        links = [palm, *(f"f{finger}_{number}" for number in range(joints))]
        for number in range(joints):
            text += _joint(f"f{finger}{number}", links[number], links[number + 1], at="0.02 0 0.03")
    return text


def _mimic(joint: str) -> str:
    return f'<mimic joint="{joint}"/>'


_WHEELS = _joint("left", "base", "l", "continuous", at="0 0.2 0") + _joint(
    "right", "base", "r", "continuous", at="0 -0.2 0"
)
_JAWS = _joint("left", "base", "l", "prismatic", at="0 0 0.1") + _joint(
    "right", "base", "r", "prismatic", at="0 0 0.1", more=_mimic("left")
)
_TWO_JAWS = _JAWS.replace(_mimic("left"), "")
_ROBOTS = {
    "six joints": (_chain(6), "arm", True),
    "six joints and two jaws": (_chain(6) + _JAWS.replace('"base"', '"j_link6"'), "arm", True),
    "two chains": (_chain(6) + _chain(6, "k"), "arm", False),
    "an arm on wheels": (_chain(6) + _WHEELS, "arm", False),
    "two joints": (_chain(2), "arm", False),
    "jaws of which one mimics the other": (_JAWS, "gripper", True),
    "jaws that move on their own": (_TWO_JAWS, "gripper", False),
    "one joint named as a part of a gripper": (_joint("vacuum", "base", "cup", "prismatic"), "gripper", False),
    "four fingers of four joints": (_fingers(4, 4), "hand", True),
    "five fingers of four joints on a wrist": (_chain(2) + _fingers(5, 4, "j_link2"), "hand", True),
    "three fingers of two joints": (_fingers(3, 2), "hand", False),
    "a slide on a slide": (_chain(2, kind="prismatic"), "axis", True),
    "a turntable": (_joint("turn", "base", "table", axis="0 0 1"), "axis", False),
    "two wheels": (_WHEELS, "base", True),
}


def _role(text: str) -> Role:
    read = read_urdf(f'<robot name="odd"><link name="base"/>{text}</robot>', "odd.urdf")
    assert read.value is not None, read.diagnostics
    return role_of(read.value)


@pytest.mark.parametrize("name", _ROBOTS)
def test_kind_is_what_the_joints_show(name: str) -> None:
    text, kind, certain = _ROBOTS[name]
    role = _role(text)
    assert (role.kind.kind, role.kind.certain) == (kind, certain), role.kind.because
    assert any("`kind` may be wrong" in question for question in role.questions()) is not certain


@pytest.mark.parametrize("name", ["tool0", "left_tcp", "ee_link", "gripper_frame_link", "flange", "arm/tool_link"])
def test_tip_is_the_link_with_the_name_of_a_tool_frame(name: str) -> None:
    camera, tool = _joint("c", "j_link6", "camera_link", "fixed"), _joint("t", "j_link6", name, "fixed")
    role = _role(_chain(6) + camera + tool)
    assert (role.tool_frame, list(role.questions())) == (name, [])


def test_tip_without_a_name_is_asked_for() -> None:
    role = _role(_chain(6))
    assert role.tool_frame == "j_link6"
    assert list(role.questions()) == ["no link is named as a tool frame: is `j_link6` where tools are mounted?"]


def test_one_jaw_at_the_end_of_an_arm_is_not_its_tip() -> None:
    by_name = _role(_chain(5) + _joint("gripper", "j_link5", "moving_part"))
    by_frame = _role(_chain(6) + _joint("t", "j_link5", "gripper_frame_link", "fixed"))
    for role, tip in ((by_name, "j_link5"), (by_frame, "gripper_frame_link")):
        assert ([joint.name for joint in role.chain.joints], role.tool_frame) == (["j1", "j2", "j3", "j4", "j5"], tip)


def test_tip_of_a_gripper_is_on_its_palm_and_carries_nothing() -> None:
    role = _role(_JAWS + _joint("t", "base", "grasp_link", "fixed"))
    assert (role.tool_frame, role.frames) == (None, {"tcp": "grasp_link"})
    (question,) = _role(_JAWS).questions()
    assert "the point that the fingers close about" in question


def _import(here: Path, text: str, *options: str) -> str:
    (here / "odd.urdf").write_text(f'<robot name="odd"><link name="base"/>{text}</robot>', encoding="utf-8")
    ran = run("import", "odd.urdf", *options)
    assert ran.code == 0, ran.out + ran.err
    return ran.out


def _device(here: Path) -> tuple[str, dict[str, object]]:
    text = (here / "odd" / "device.yaml").read_text(encoding="utf-8")
    return text, yaml.safe_load(text)


def test_kind_is_told_asked_and_stated_by_a_person(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    out = _import(tmp_path, _TWO_JAWS)
    assert "kind: gripper (two fingers, and 2 joints that mimic none; not certain, `--kind` decides)\n" in out
    text, device = _device(tmp_path)
    assert device["kind"] == "gripper"
    assert "#   1. `kind` may be wrong, the evidence is two fingers, and 2 joints that mimic none" in text
    assert "kind: hand (as it was stated)\n" in _import(tmp_path, _TWO_JAWS, "--kind", "hand")
    assert _device(tmp_path)[1]["kind"] == "hand"
    assert "kind: hand (as it was stated)\n" in _import(tmp_path, _TWO_JAWS)
    assert run("import", "odd.urdf", "--kind", "spoon").code == 2


def test_imported_gripper_moves_alone_and_on_an_arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    _import(tmp_path, _JAWS, "--cell")
    assert "\n  gripper: {model: ./odd, mount: {parent: world}}\n" in Path("cell.yaml").read_text(encoding="utf-8")
    assert run("build", "cell.yaml").code == 0
    assert run("mock", "generated/odd_cell").code == 0
    assert run("init", "bench", "ur5e", "./odd", "-o", "bench.yaml").code == 0
    assert "    model: ./odd\n    mount: {parent: arm/tool0}\n" in Path("bench.yaml").read_text(encoding="utf-8")
    assert run("build", "bench.yaml").code == 0
    assert run("mock", "generated/bench").code == 0
