"""Values and differences as people read them, worked out by hand."""

from __future__ import annotations

import math

import pytest

from cellc.contract.transforms import Pose
from cellc.tools.review.leaves import Leaf
from cellc.tools.review.units import difference, motion, shown

QUARTER = Pose((0.1, -0.02, 3.0), (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.1, "m", "100 mm"),
        (math.pi / 2, "rad", "90 deg"),
        (0.25, "m/s", "250 mm/s"),
        (math.pi, "rad/s", "180 deg/s"),
        (0.5, "m/s^2", "500 mm/s^2"),
        (-math.pi, "rad/s^2", "-180 deg/s^2"),
        (2.0, "m/s^3", "2000 mm/s^3"),
        (math.pi / 6, "rad/s^3", "30 deg/s^3"),
        (0.5, "s", "500 ms"),
        (-0.25, "s", "-250 ms"),
        (0.0, "s", "0 s"),
        (1.0, "s", "1 s"),
        (-1.5, "s", "-1.5 s"),
        (2.5, "kg", "2.5 kg"),
        (-0.0, "", "0"),
        (1.23456789, "", "1.234568"),
        (3, "", "3"),
        (True, "", "yes"),
        (False, "", "no"),
        ("word", "", "word"),
        ((0.1, 0.2), "m", "100 200 mm"),
        ((1, 2.5), "kg", "1 2.5 kg"),
        ((1, 2), "", "1 2"),
        (("a", "b"), "", "a, b"),
        (tuple("abcdef"), "", "a, b, c, d, e, f"),
        (tuple("abcdefg"), "", "7 entries"),
        (QUARTER, "", "xyz 100 -20 3000 mm, rpy 0 0 90 deg"),
    ],
)
def test_value_with_its_unit(value: Leaf, unit: str, text: str) -> None:
    assert shown(value, unit) == text


@pytest.mark.parametrize(
    ("before", "after", "unit", "text"),
    [
        (1.0, 1.5, "m", "+50 %"),
        (2.0, 1.0, "s", "-50 %"),
        (-2.0, -1.0, "kg", "+1 kg"),  # a negative value has no share
        (2.0, -1.0, "kg", "-3 kg"),
        (-0.5, 0.5, "s", "+1 s"),
        (0.0, 2.0, "kg", "+2 kg"),
        (-1.0, -0.5, "m", "+500 mm"),  # a place has no share of a negative one
        (0.1, 0.0, "m", "-100 mm"),
        (0.99, 0.9, "ratio", "-9 points"),  # a share of a share misleads
        (0.0, math.pi / 6, "rad", "+30 deg"),
        (0.0, 0.2, "s", "+200 ms"),
        (3.0, 4.0, "", "+33.3 %"),
        (1, 2, "", ""),
        (1, 2.5, "kg", "+150 %"),
        (2.5, 2, "kg", "-20 %"),
        (True, 2.0, "", ""),
        (1.0, "word", "", ""),
        (None, 1.0, "m", ""),
        (("a", "b", "c"), ("c", "d", "b"), "", "lost a; new d"),
        (("a", "b"), ("b", "a"), "", "in another order"),
        (("a",), ("b",), "", ""),
        ((1.0, 2.0), (1.0, 3.0), "m", ""),
        (QUARTER, Pose((0.1, -0.02, 3.004), QUARTER.quaternion), "", "moves 4 mm"),
    ],
)
def test_difference(before: Leaf | None, after: Leaf | None, unit: str, text: str) -> None:
    assert difference(before, after, unit) == text


@pytest.mark.parametrize(
    ("meters", "degrees", "text"),
    [
        (0.0, 0.0, ""),
        (5e-10, 5e-6, ""),  # less than a nanometer and 0.1 urad
        (2e-9, 0.0, "moves 0.000002 mm"),
        (0.9994, 0.0, "moves 999 mm"),
        (0.9996, 0.0, "moves 1 m"),
        (1.5, 2.0, "moves 1.5 m, turns 2 deg"),
        (0.0, 1e-4, "turns 0.0001 deg"),
    ],
)
def test_motion(meters: float, degrees: float, text: str) -> None:
    assert motion(meters, math.radians(degrees)) == text
