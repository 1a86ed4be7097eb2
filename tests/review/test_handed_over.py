"""Who answers for safety, how the first motion changes, and what another spelling of a payload says: by hand."""

from __future__ import annotations

import pytest

from cellc.compiler.spec.quantity import MASS
from cellc.contract.review import Review
from tests.review.edits import review_of
from tests.review.revisions import Edit

APPROVER: Edit = ("safety: safety, data", "safety: integration, data")
FIRST = "max_delta: 5 deg, velocity: 5 deg/s, timeout: 5 s"


def _told(found: Review) -> set[tuple[str, str]]:
    return {(str(change.grade), change.quantity) for change in found.changes if change.area != "documents"}


def test_owner_of_the_recovery_is_told_beside_an_approver_who_goes_to_the_same_people() -> None:
    found = review_of("ur5e_pick", APPROVER, ("owner: safety, observer", "owner: integration, observer"))
    assert _told(found) == {("dangerous", "approver of safety changes"), ("review", "owner of the recovery")}


@pytest.mark.parametrize("name", ["physical_stop", "vendor_safety"])
def test_who_hands_over_what_stops_the_motion_is_asked(name: str) -> None:
    was = {"physical_stop": "safety", "vendor_safety": "robot"}[name]
    found = review_of("ur5e_pick", (f"{name}: {was}", f"{name}: integration"))
    (change,) = (change for change in found.changes if change.area == "safety")
    assert (str(change.grade), change.approval) == ("dangerous", "safety")
    assert set(change.owner.split(" and ")) == {"safety", was}
    # Evidence stays: who answers is no part of the configuration.
    assert found.before.configuration_id == found.after.configuration_id


@pytest.mark.parametrize(
    ("after", "grade"),
    [
        ("max_delta: 3 deg, velocity: 3 deg/s, timeout: 5 s", "safe"),
        ("max_delta: 6 deg, velocity: 5 deg/s, timeout: 5 s", "dangerous"),
        ("max_delta: 5 deg, velocity: 6 deg/s, timeout: 5 s", "dangerous"),
        ("max_delta: 5 deg, velocity: 5 deg/s, timeout: 6 s", "dangerous"),
    ],
)
def test_first_motion_that_is_smaller_and_slower_is_safe(after: str, grade: str) -> None:
    found = review_of("ur5e_pick", (FIRST, after))
    first = [change for change in found.changes if change.quantity.startswith("first motion")]
    assert {str(change.grade) for change in first} == {grade}


STOP = "velocity: 3 deg/s, timeout: 5 s,\n"
STOP += "       stop_if: [wrong direction, overshoot, unexpected sound]}\n    - {joint: right"


@pytest.mark.parametrize(
    ("reasons", "velocity", "expected"),
    [
        ("wrong direction, overshoot, unexpected sound, sagging", "2 deg/s", {"safe"}),
        ("wrong direction, overshoot", "2 deg/s", {"safe", "dangerous"}),
        ("wrong direction, overshoot, unexpected sound", "3.1 deg/s", {"dangerous"}),
    ],
)
def test_one_more_reason_to_stop_is_safe_and_one_less_is_not(reasons: str, velocity: str, expected: set[str]) -> None:
    after = STOP.replace("wrong direction, overshoot, unexpected sound", reasons).replace("3 deg/s", velocity)
    found = review_of("openarm_bimanual", (STOP, after))
    first = [change for change in found.changes if change.quantity.startswith("first motion")]
    assert {str(change.grade) for change in first} == expected


@pytest.mark.parametrize("unit", [unit for unit, _ in MASS.units])
def test_mass_in_another_unit_is_no_change(unit: str) -> None:
    factor = next(float(factor) for name, factor in MASS.units if name == unit and factor is not None)
    payload = "payload: {mass: 0.77 kg, center_of_mass: 0 0 -70 mm}    #"
    found = review_of("openarm_bimanual", (payload, payload.replace("0.77 kg", f"{0.77 / factor:.9g} {unit}")))
    assert found.changes == ()


@pytest.mark.parametrize("center", ["0 0 -7 cm", "0 0 -0.07 m"])
def test_center_of_mass_in_another_unit_is_no_change(center: str) -> None:
    payload = "payload: {mass: 0.77 kg, center_of_mass: 0 0 -70 mm}    #"
    assert review_of("openarm_bimanual", (payload, payload.replace("0 0 -70 mm", center))).changes == ()
