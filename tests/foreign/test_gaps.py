"""What a vendor's file leaves out is a question and a closed real target; the mock runs with a careful figure."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import pytest

from tests.cli.run import run

_FULL = '<limit lower="-2" upper="2" velocity="1" effort="10"/>'
_GAPS = {
    "a velocity of 0": ('<limit lower="-2" upper="2" velocity="0" effort="10"/>', "velocity", "a velocity of 0"),
    "limits 0 to 0": ('<limit lower="0" upper="0" velocity="1" effort="10"/>', "position", "0 to 0 rad"),
    "no range": ('<limit velocity="1" effort="10"/>', "position", "no range"),
    "no velocity": ('<limit lower="-2" upper="2" effort="10"/>', "velocity", "no velocity"),
    "no effort": ('<limit lower="-2" upper="2" velocity="1"/>', "effort", "no effort"),
    "no limit": ("", "velocity", "no velocity"),
}


def _arm(limit: str, *more: str) -> str:
    links = ("base", "a", "b", "c", "d")
    joints = (
        f'<link name="{child}"/><joint name="j_{child}" type="revolute"><parent link="{parent}"/>'
        f'<child link="{child}"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>{limit if child == "b" else _FULL}</joint>'
        for parent, child in pairwise(links)
    )
    return f'<robot name="arm"><link name="base"/>{"".join((*joints, *more))}</robot>'


def _fixed(name: str, parent: str, rpy: str) -> str:
    ends = f'<parent link="{parent}"/><child link="{name}"/><origin rpy="{rpy}"/>'
    return f'<link name="{name}"/><joint name="{name}_fixed" type="fixed">{ends}</joint>'


def _imported(here: Path, text: str) -> str:
    (here / "arm.urdf").write_text(text, encoding="utf-8")
    ran = run("import", "arm.urdf", "--cell")
    assert ran.code == 0, ran.out + ran.err
    return (here / "arm" / "device.yaml").read_text(encoding="utf-8")


def _moves() -> None:
    assert run("build", "cell.yaml").code == 0
    assert run("mock", "generated/arm_cell").code == 0


@pytest.mark.parametrize("name", _GAPS)
def test_a_limit_that_is_left_out_is_asked_and_closes_the_real_target(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    limit, key, stated = _GAPS[name]
    text = _imported(tmp_path, _arm(limit))
    assert f"`limits: {key}` of `j_b`: the description states {stated}, " in text
    checked = run("check", "cell.yaml", "--select", "assumed-joint-limit")
    assert "limits of `arm` are assumed: " in checked.out
    assert f"`{key}` of `j_b`" in checked.out
    _moves()


def test_a_figure_with_a_source_opens_what_an_assumed_one_closed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = _imported(tmp_path, _arm(_GAPS["a velocity of 0"][0]))
    stated = text.replace("UNKNOWN, assumed by cellc import", "manual of the arm, page 7")
    (tmp_path / "arm" / "device.yaml").write_text(stated.replace("0.5 rad/s", "1.5 rad/s"), encoding="utf-8")
    assert "no findings" in run("check", "cell.yaml", "--select", "assumed-joint-limit").out
    _moves()
    (contract,) = tmp_path.glob("generated/arm_cell/contract.json")
    assert json.loads(contract.read_text(encoding="utf-8"))["joint_limits"]["arm_j_b"]["velocity"] == 1.5


def test_a_turned_flange_is_asked_and_closes_the_real_target(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    text = _imported(tmp_path, _arm(_FULL, _fixed("flange", "d", "0 0 0"), _fixed("tool0", "flange", "0 0 0")))
    assert "`tool0` is turned or shifted against `flange`: which way do tools point?" in text
    assert "blocker[broken-flange-convention]" in run("check", "cell.yaml").out
    _moves()


def test_no_joint_that_can_move_is_the_end_of_the_road(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.urdf").write_text('<robot name="box"><link name="base"/></robot>', encoding="utf-8")
    ran = run("import", "box.urdf")
    assert (ran.code, "refused: `box` has no joint that can move: it has no joints" in ran.out) == (1, True)
