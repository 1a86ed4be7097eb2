"""What sweeps draw and judge is bound to what the cell has, or reported where it is written."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cells import linked, linking, spec_of, spec_text, written


@pytest.mark.parametrize(
    ("before", "after", "code", "message", "nearest"),
    [
        (
            "{hand_eye: {rot",
            "{hand_eyes: {rot",
            "unknown-calibration",
            "there is no calibration `hand_eyes`",
            "hand_eye",
        ),
        ("{pick: 4 mm,", "{pik: 4 mm,", "unknown-goal", "there is no goal `pik`", "pick"),
        (
            "{object: {box",
            "{objekt: {box",
            "unknown-frame",
            "there is no fixed frame, or dynamic one with `simulated_pose`, `objekt`",
            "object",
        ),
    ],
)
def test_a_name_that_nothing_has_is_reported_where_it_is_written(
    tmp_path: Path, before: str, after: str, code: str, message: str, nearest: str
) -> None:
    text = spec_text("ur5e_pick")
    assert before in text
    (found,) = linking(written(tmp_path, text.replace(before, after))).diagnostics
    assert (found.code, found.message) == (code, message)
    assert found.help == f"did you mean `{nearest}`?"
    assert found.span.line == text[: text.index(before)].count("\n") + 1


def test_figures_are_halves_in_si_and_a_confidence_is_95_percent_unless_stated(tmp_path: Path) -> None:
    found = linked(spec_of("ur5e_pick"))
    assert found.uncertainty is not None
    assert found.uncertainty.rotations_rad == {"hand_eye": pytest.approx(0.1 * 3.141592653589793 / 180.0)}
    assert found.uncertainty.regions["object"].half_m == pytest.approx((0.04, 0.04, 0.0))
    assert found.uncertainty.regions["object"].half_yaw_rad == pytest.approx(3.141592653589793 / 6.0)
    assert found.uncertainty.tolerances_m == {"pick": 0.004, "place": 0.003}
    assert [(one.success, one.confidence) for one in found.rehearsals][:2] == [(0.99, 0.95), (None, 0.95)]


def test_a_cell_that_says_nothing_of_it_has_none(tmp_path: Path) -> None:
    text = spec_text("minimal")
    assert linked(spec_of("minimal")).uncertainty is None
    stated = linked(written(tmp_path, text + "uncertainty: {}\n")).uncertainty
    assert stated is not None
    assert (stated.rotations_rad, stated.regions, stated.tolerances_m) == ({}, {}, {})
