"""What sweeps draw and judge is bound to what the cell has, or reported where it is written."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cells import linked, linking, spec_of, spec_text, there, written


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
            "there is no fixed frame or object with a simulated pose `objekt`",
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
    line = text.replace(before, after).splitlines()[found.span.line - 1]
    assert line[found.span.column - 1 :].startswith(after.strip("{").split(":")[0].split("{")[-1])  # at the key


def test_what_a_region_may_be_of_is_told_in_a_sentence(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("{object: {box", "{world: {box")
    (found,) = linking(written(tmp_path, text)).diagnostics
    assert found.message == "there is no fixed frame or object with a simulated pose `world`"
    assert "fixed frames or objects with a simulated pose of this cell" in there(found.help)


@pytest.mark.parametrize("device", ["camera", "gripper"])
def test_the_repeatability_of_a_device_that_no_group_moves_is_refused(device: str, tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace(
        "  tolerances: {pick", f"  repeatability: {{{device}: 1 mm}}\n  tolerances: {{pick"
    )
    (found,) = linking(written(tmp_path, text)).diagnostics
    assert found.code == "repeatability-of-nothing"
    assert found.message == f"`{device}` must be a device that a group moves; of another one no repeatability is drawn"
    assert found.help == "name one of: arm"


def test_a_confidence_without_a_rate_of_success_is_told(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert "    success: 99 %\n" in text
    (found,) = linking(written(tmp_path, text.replace("    success: 99 %\n", ""))).diagnostics
    assert (found.code, found.message) == (
        "confidence-of-nothing",
        "`pick_and_place` must state `success` too; without it no verdict needs a confidence",
    )


def test_figures_are_halves_in_si_and_a_confidence_is_95_percent_unless_stated(tmp_path: Path) -> None:
    found = linked(spec_of("ur5e_pick"))
    assert found.uncertainty is not None
    assert found.uncertainty.rotations_rad == {"hand_eye": pytest.approx(0.1 * 3.141592653589793 / 180.0)}
    assert found.uncertainty.regions["object"].half_m == pytest.approx((0.04, 0.04, 0.0))
    assert found.uncertainty.regions["object"].half_yaw_rad == pytest.approx(3.141592653589793 / 6.0)
    assert found.uncertainty.tolerances_m == {"pick": 0.004, "place": 0.003}
    assert [(rehearsal.success, rehearsal.confidence) for rehearsal in found.rehearsals][:2] == [
        (0.99, 0.95),
        (None, 0.95),
    ]


def test_a_cell_that_says_nothing_of_it_has_none(tmp_path: Path) -> None:
    text = spec_text("minimal")
    assert linked(spec_of("minimal")).uncertainty is None
    stated = there(linked(written(tmp_path, text + "uncertainty: {}\n")).uncertainty)
    assert (stated.rotations_rad, stated.regions, stated.tolerances_m) == ({}, {}, {})
