"""What a sweep draws of arms, and of what lies where nobody looks: each with the statement that it rests on."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from cellc.compiler.emit.contract.uncertainty import uncertainty
from cellc.contract.limits import limits
from cellc.contract.uncertainty import UncertainQuantity, Uncertainty
from cellc.mock.sweep.draws import draw, reality_of
from tests.cells import ROOT, linked, spec_of, spec_text, written


def _drawn(path: Path) -> Uncertainty:
    cell = linked(path)
    assert cell.uncertainty is not None
    return uncertainty(cell, cell.uncertainty, {})


def _of(found: Uncertainty, kind: str) -> list[UncertainQuantity]:
    return [quantity for quantity in found.quantities if quantity.kind == kind]


def test_draws_of_a_tip_have_the_repeatability_that_the_catalog_tells() -> None:
    found = _of(_drawn(spec_of("ur5e_pick")), "repeatability")
    assert {(finding.target, finding.source) for finding in found} == {("tcp", "devices.arm.model")}
    drawn = [list(draw(found, 7, run).values()) for run in range(4000)]
    lengths = np.linalg.norm(np.array(drawn), axis=1)
    # ISO 9283:1998, 7.2.2: the mean distance and three deviations of it; 0.03 mm is that of a UR5e.
    assert float(lengths.mean() + 3.0 * lengths.std(ddof=1)) == pytest.approx(0.03e-3, rel=0.03)


def test_a_repeatability_that_was_measured_stands_in_place_of_the_catalogs(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("  tolerances: {pick", "  repeatability: {arm: 0.12 mm}\n  tolerances: {pick")
    found = _of(_drawn(written(tmp_path, text)), "repeatability")
    four_times = [4.0 * element.spread for element in _of(_drawn(spec_of("ur5e_pick")), "repeatability")]
    assert [finding.spread for finding in found] == pytest.approx(four_times, rel=1e-3)
    assert {finding.source for finding in found} == {"uncertainty.repeatability.arm"}


def test_two_devices_that_move_one_tip_are_told_apart_and_add_up(tmp_path: Path) -> None:
    text = spec_text("rail_arm").replace("uncertainty: {", "uncertainty: {repeatability: {rail: 0.1 mm}, ")
    found = _drawn(written(tmp_path, text))
    tips = [element.name for element in _of(found, "repeatability")]
    assert tips == [f"rail_and_arm tip by {device} {axis}" for device in ("rail", "arm") for axis in "xyz"]
    values = {quantity.name: 0.0 for quantity in found.quantities}
    values |= {"rail_and_arm tip by rail x": 1e-3, "rail_and_arm tip by arm x": 2e-3}
    assert reality_of(found.quantities, values, 0, 0).links["tcp"].position == pytest.approx((3e-3, 0.0, 0.0))


def test_two_frames_of_one_calibration_and_an_object_of_its_name_are_told_apart(tmp_path: Path) -> None:
    text = spec_text("rail_arm").replace("calibration: deburring", "calibration: press")
    found = _drawn(written(tmp_path, text))
    assert [
        element.name for element in _of(found, "calibration") if element.source == "calibrations.press.residual"
    ] == [f"press of frame {frame} {axis}" for frame in ("press", "deburring") for axis in "xyz"]
    text = spec_text("ur5e_pick").replace("calibration: fixture_a", "calibration: object")
    names = [
        quantity.name
        for quantity in _drawn(written(tmp_path, text.replace("\n  fixture_a: {rev", "\n  object: {rev"))).quantities
    ]
    assert len(set(names)) == len(names)
    assert {"object of frame object x", "object of frame object rz"} <= set(names)


def test_what_is_too_small_for_the_mock_is_not_drawn(tmp_path: Path) -> None:
    text = spec_text("rail_arm").replace("box: 6 6 0 mm, yaw: 6 deg", "box: 6 0.000001 0 mm, yaw: 0.00000001 deg")
    found = _drawn(written(tmp_path, text))
    assert [element.name for element in _of(found, "place")] == ["part at press x"]
    Uncertainty.model_validate_json(found.model_dump_json(), context=limits())


def test_what_lies_on_a_calibrated_frame_adds_to_where_that_frame_stands() -> None:
    found = _drawn(spec_of("fr3_hand"))
    assert {element.target for element in (*_of(found, "place"), *_of(found, "calibration"))} >= {"tray"}
    values = dict.fromkeys((quantity.name for quantity in found.quantities), 0.0)
    values |= {"tray x": 1e-3, "part at tray x": 2e-3, "part at tray y": -1e-3, "part at tray rz": 0.01}
    moved = reality_of(found.quantities, values, 0, 0).links["tray"]
    assert moved.position == pytest.approx((3e-3, -1e-3, 0.0))
    assert moved.quaternion == pytest.approx((0.0, 0.0, math.sin(0.005), math.cos(0.005)))


def test_the_checklist_of_the_mock_asks_for_the_sweep_of_each_rate_that_is_expected() -> None:
    sections = {
        cell: (ROOT / "generated" / cell / "gates/promotion.md").read_text(encoding="utf-8").split("## G2 ")[1]
        for cell in ("ur5e_pick", "minimal")
    }
    section = sections["ur5e_pick"].split("\n## ")[0]
    assert "pick_and_place succeeds in at least 99 % of its runs, with confidence 0.95" in section
    assert '  cellc gates generated/ur5e_pick --sweep 10000 2>&1 | tee -a "$E/G2-mock.md"\n' in section
    assert "--sweep" not in sections["minimal"].split("\n## ")[0]


def test_loads_are_drawn_as_the_spec_says_and_change_what_the_arm_holds(tmp_path: Path) -> None:
    text = spec_text("fr3_hand").replace("{part: 10 g}", "{part: 20 g, compensation: 2 %}")
    found = _drawn(written(tmp_path, text))
    loads = [
        (quantity.name, quantity.kind, quantity.target, quantity.axis, quantity.unit, quantity.spread)
        for quantity in found.quantities[-2:]
    ]
    assert loads == [
        ("part of arm", "part", "arm", "mass", "kg", 0.02),
        ("compensation of arm", "compensation", "arm", "share", "1", 0.02),
    ]
    masses = np.array([draw(found.quantities, 3, run)["part of arm"] for run in range(2000)])
    assert float(masses.std()) == pytest.approx(0.02, rel=0.05)
    real = reality_of(found.quantities, draw(found.quantities, 3, 0), 3, 0)
    assert (real.part_more_kg, set(real.compensation)) == ({"arm": float(masses[0])}, {"arm"})
