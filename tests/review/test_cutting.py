"""Nothing is cut within a quantity: a figure that is printed stands in the full text, with the same unit."""

from __future__ import annotations

import re

import pytest

from cellc.contract.printing import as_text
from cellc.tools.review.cutting import broken, cut
from cellc.tools.review.groups import groups_of
from cellc.tools.review.short import render_short
from cellc.tools.review.text import render_review
from tests.review.edits import review_of
from tests.review.revisions import Edit

_CELLS: tuple[tuple[str, tuple[Edit, ...]], ...] = (
    (
        "hybrid_sdk",
        (
            ("command_timeout: 20 ms", "command_timeout: 100 ms"),
            ("path_tolerance: 0.1 rad", "path_tolerance: 0.2 rad"),
            ("stiffness: 600 600 600 600 250 150 50 N m/rad", "stiffness: 800 800 800 800 350 200 80 N m/rad"),
        ),
    ),
    ("ur5e_pick", (("model: realsense_d435i", "model: realsense_d455"), ("xyz: 0 -70 30 mm", "xyz: 0 -82 30 mm"))),
    ("rail_arm", (("mass: 2.0 kg, center_of_mass: 0 0 60 mm", "mass: 6.5 kg, center_of_mass: 0 0 110 mm"),)),
    ("dual_ur", (("xyz: 0 0 250 mm, box: 500 400 500 mm", "xyz: 0 0 200 mm, box: 500 320 400 mm"),)),
)
_QUANTITY = re.compile(r"(?<![\w.:-])-?\d[\d.]*(?: -?\d[\d.]*)* (?:mm|ms|kg|rad|deg|N m/rad|s|g|%)(?![\w/])")
_COUNTED = re.compile(r"\.\.\. \d+ words? more")


@pytest.mark.parametrize(("cell", "edits"), _CELLS)
def test_every_quantity_of_a_line_that_was_cut_stands_in_the_whole_text(cell: str, edits: tuple[Edit, ...]) -> None:
    found = review_of(cell, *edits)
    whole = as_text(render_review(found), color=False).splitlines() + [group.title for group in groups_of(found)]
    tried = 0
    for line in whole:
        known = set(_QUANTITY.findall(line))
        figures = set(re.findall(r"\d[\d.]*", line))
        for width in range(24, 100):
            told = _COUNTED.sub("", cut(line, width))
            assert len(cut(line, width)) <= width
            assert set(_QUANTITY.findall(told)) <= known, (width, told)
            assert {figure.strip(".") for figure in re.findall(r"\d[\d.]*", told)} <= {
                each.strip(".") for each in figures
            }
            assert not told.rstrip(" .").endswith(" ->"), told
            assert " ".join(" ".join(broken(line, "", 200)).split()) == " ".join(line.split())
            tried += len(known)
    assert tried > 500
    full = " ".join(
        (*whole, *(group.kept for group in groups_of(found)), *(each.message for each in found.new_findings))
    )
    for width in (80,):
        for line in as_text(render_short(found), color=False).splitlines():
            assert len(line) <= width
            assert set(_QUANTITY.findall(line)) <= set(_QUANTITY.findall(full)), line


def test_the_value_that_protects_leads_its_heading_with_how_much_it_grew() -> None:
    found = review_of("hybrid_sdk", *_CELLS[0][1])
    (group,) = groups_of(found)
    assert [change.quantity for change in group.changes][:2] == ["watchdog", "path tolerance"]
    assert ": command_timeout 20 ms -> 100 ms (+400 %), path_tolerance 0.1 rad -> 0.2 rad (+100 %)" in group.title
    for width in (60, 70, 80):
        told = group.fitting(width)
        assert len(told) <= width
        assert "command_timeout: 20 ms -> 100 ms (+400 %)" in told
        assert told.endswith("and 2 more")


def test_a_tolerance_is_read_before_gains() -> None:
    listed = [change.quantity for change in review_of("hybrid_sdk", *_CELLS[0][1][1:]).changes]
    assert listed.index("path tolerance") < listed.index("stiffness of the joint")
