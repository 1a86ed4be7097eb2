"""A cap that grows is dangerous in a review, by the spec and by the package alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.contract.vocabulary import Grade
from cellc.tools.review.facts import Facts, facts_of
from tests.cells import compiled, spec_text, written
from tests.review.edits import changes_between

WHOLE = "commissioning: {velocity: 100 %, acceleration: 100 %}"


def facts(folder: Path, stated: str, *, with_spec: bool) -> Facts:
    folder.mkdir()
    text = spec_text("ur5e_pick").replace("velocity: 5 deg/s", "velocity: 1 deg/s")
    made = compiled(written(folder, text.replace(WHOLE, f"commissioning: {stated}")))
    return facts_of(made.texts, made.graph.cell if with_spec else None)


@pytest.mark.parametrize("with_spec", [True, False])
@pytest.mark.parametrize(
    ("smaller", "larger"),
    [
        ("{velocity: 50 %, acceleration: 50 %}", "{velocity: 60 %, acceleration: 50 %}"),
        ("{velocity: 50 %, acceleration: 50 %}", "{velocity: 50 %, acceleration: 80 %}"),
        ("{velocity: 3 m/s, acceleration: 50 %}", "{velocity: 4 m/s, acceleration: 50 %}"),
        ("{velocity: 50 %, acceleration: 50 %, force: 40 N}", "{velocity: 50 %, acceleration: 50 %, force: 50 N}"),
    ],
)
def test_larger_cap_is_dangerous_and_a_smaller_one_is_safe_but_that_of_a_grip_is_looked_at(
    smaller: str, larger: str, with_spec: bool, tmp_path: Path
) -> None:
    low, high = (
        facts(tmp_path / name, stated, with_spec=with_spec) for name, stated in (("a", smaller), ("b", larger))
    )
    grown = [change for change in changes_between(low, high) if change.area.value == "limits"]
    assert grown
    assert {change.grade for change in grown} == {Grade.DANGEROUS}
    shrunk = [change for change in changes_between(high, low) if change.area.value == "limits"]
    assert {change.grade for change in shrunk if change.quantity != "grip force"} <= {Grade.SAFE}
    # A part may fall.
    assert {change.grade for change in shrunk if change.quantity == "grip force"} <= {Grade.REVIEW}


def test_a_slower_stage_before_the_others_is_safe(tmp_path: Path) -> None:
    whole = facts(tmp_path / "a", "{velocity: 50 %, acceleration: 50 %}", with_spec=True)
    more = facts(tmp_path / "b", "{velocity: 50 %, acceleration: 50 %, stages: 5 10 25 50 100 %}", with_spec=True)
    added = [change for change in changes_between(whole, more) if change.area.value == "limits"]
    assert {change.grade for change in added} == {Grade.SAFE}
    assert "stages of commissioning" in {change.quantity for change in added}


def test_stage_that_is_gone_is_dangerous(tmp_path: Path) -> None:
    whole = facts(tmp_path / "a", "{velocity: 50 %, acceleration: 50 %}", with_spec=True)
    fewer = facts(tmp_path / "b", "{velocity: 50 %, acceleration: 50 %, stages: 10 100 %}", with_spec=True)
    gone = [change for change in changes_between(whole, fewer) if change.area.value == "limits"]
    assert Grade.DANGEROUS in {change.grade for change in gone}
