"""A part that is too heavy, too slippery, too wide or missing: four names, with forces that are worked out by hand.

The 2F-85 of `ur5e_pick` closes with 235 N over 85 mm, on a joint that turns by 0.793 rad: 235 * 0.085 / 0.793 =
25.2 N m. With 77 mm between them its pads are at 0.0886 rad, where each moves 0.0434 cos + 0.0372 sin = 46.5 mm for a
radian, so that both together press with 25.2 / 0.0465 = 541 N. At a friction of 0.5 that holds 271 N, at 0.003 1.6 N.
"""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry
from cellc.mock import MockCell
from cellc.mock.cell import cell_of, read_to_run
from cellc.mock.result import RehearsalResult
from cellc.robot.physics.scene import Scene
from tests.cells import built, generated

_PADS_N = 541.0
_SCENE = "sim/scene.xml"


def _cell(*changes: tuple[str, str]) -> MockCell:
    text = built("ur5e_pick").texts[_SCENE]
    for before, after in changes:
        assert text.count(before) == 1
        text = text.replace(before, after)
    return cell_of(replace(read_to_run(generated("ur5e_pick"), physics=True), scene=Scene(text, {})))


def _held(result: RehearsalResult) -> tuple[float, float, float]:
    """Return what a reason says of a grip: what the pads hold, what the part weighs, and what they press with, N."""
    found = re.search(r"pads hold (\S+) N of the (\S+) N that object weighs: they press with (\S+) N", result.reason)
    assert found is not None, result.reason
    held, weight, pads = (float(number) for number in found.groups())
    return held, weight, pads


def _with_mass(kg: float) -> tuple[str, str]:
    moment = f"{kg * 0.077**2 / 6.0:.12f}"
    return (
        'mass="0.2" diaginertia="0.000229354167 0.000229354167 0.000197633333"',
        f'mass="{kg}" diaginertia="{moment} {moment} {moment}"',
    )


def test_a_part_that_weighs_more_than_pads_hold_is_too_heavy() -> None:
    """30 kg weigh 294 N, and the pads hold 271 N."""
    result = _cell(_with_mass(30.0)).run("pick_and_place")
    assert result.outcome == "grip_failure"
    assert re.match(r"step \d `[^`]+`: too heavy: ", result.reason), result.reason
    assert _held(result) == pytest.approx((0.5 * _PADS_N, 30.0 * 9.81, _PADS_N), rel=0.05)


def test_a_part_that_weighs_less_is_held() -> None:
    """2 kg weigh 20 N."""
    result = _cell(_with_mass(2.0)).run("pick_and_place")
    assert result.outcome == "succeeded", result.reason


def test_a_part_with_less_friction_than_its_weight_needs_is_too_slippery() -> None:
    """0.2 kg weigh 1.962 N: at a friction of 0.003 the pads hold 1.6 N, at 0.005 2.7 N."""
    result = _cell(('friction="0.5 ', 'friction="0.003 ')).run("pick_and_place")
    assert result.outcome == "grip_failure"
    assert re.match(r"step \d `[^`]+`: too slippery: ", result.reason), result.reason
    assert _held(result) == pytest.approx((0.003 * _PADS_N, 1.962, _PADS_N), rel=0.05)


def test_a_part_that_is_wider_than_fingers_open_is_too_wide() -> None:
    """77 mm and 12 mm are 89 mm, and the fingers open 85 mm."""
    cell = _cell()
    entry = cell.entry("pick_and_place")
    fault = FaultEntry(kind=FaultKind.WRONG_PART, target="object", size_m=0.012, at_s=0.0)
    result = cell.rehearse(entry.model_copy(update={"faults": (fault,)}))
    assert result.outcome == "grip_failure"
    assert "too wide: object is 89 mm wide, fingers of gripper open 85 mm" in result.reason


def test_where_a_part_is_missing_fingers_close_on_nothing() -> None:
    result = _cell().run("no_part")
    assert result.outcome == "grip_failure"
    assert re.match(r"step \d `[^`]+`: empty: ", result.reason), result.reason
