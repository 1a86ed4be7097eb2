"""Draws and statistics of sweeps, worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cellc.contract.uncertainty import UncertainQuantity
from cellc.mock.sweep.draws import reality_of, scale
from cellc.mock.sweep.figures import confidence_of_look, explain, interval
from cellc.mock.sweep.margins import Margin


def quantity(name: str, **stated: object) -> UncertainQuantity:
    usual = {"kind": "calibration", "target": "jig", "axis": "x", "unit": "m", "distribution": "uniform"}
    return UncertainQuantity.model_validate({"name": name, "spread": 1.0, "source": "s", **usual, **stated})


def test_an_axis_has_a_third_of_the_square() -> None:
    assert scale(quantity("q", distribution="isotropic", spread=0.003)) == pytest.approx(0.0017320508)  # 0.003/sqrt(3)
    assert scale(quantity("q", distribution="normal", spread=0.003)) == 0.003
    assert scale(quantity("q", distribution="uniform", spread=0.003)) == 0.003


def test_turns_are_rotation_vectors() -> None:
    turns = [quantity(axis, axis=axis, unit="rad") for axis in ("rx", "ry", "rz")]
    # (0, 0.6, 0.8) * pi/2: a quarter turn, so sin = cos = sqrt(1/2) of half of it.
    reality = reality_of(turns, {"rx": 0.0, "ry": 0.3 * math.pi, "rz": 0.4 * math.pi}, 0, 0)
    half = math.sqrt(0.5)
    assert reality.links["jig"].quaternion == pytest.approx((0.0, 0.6 * half, 0.8 * half, half))
    still = reality_of(turns, {"rx": 0.0, "ry": 0.0, "rz": 0.0}, 0, 0)
    assert still.links["jig"].quaternion == (0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("successes", "runs", "low", "high"),
    [
        (20, 20, 0.025 ** (1 / 20), 1.0),  # all succeed: p^20 = 0.025
        (0, 20, 0.0, 1.0 - 0.025 ** (1 / 20)),
        (1, 2, 1.0 - math.sqrt(0.975), math.sqrt(0.975)),  # 1 - (1 - p)^2 = 0.025 and 1 - p^2 = 0.025
        (0, 0, 0.0, 1.0),
    ],
)
def test_bounds_of_a_rate(successes: int, runs: int, low: float, high: float) -> None:
    found = interval(successes, runs, 0.95)
    assert (found.low, found.high) == pytest.approx((low, high))


def test_a_look_spends_its_part_of_what_may_be_wrong() -> None:
    # 0.05/(1*2), 0.05/(2*3), 0.05/(3*4): all of them together spend 0.05.
    assert [1.0 - confidence_of_look(number, 0.95) for number in (1, 2, 3)] == pytest.approx(
        [0.025, 0.05 / 6, 0.05 / 12]
    )


@pytest.mark.parametrize(("share", "expected"), [(0.0, 1.0), (0.25, 1.0), (0.26, 2.0), (0.95, 4.0), (1.0, 4.0)])
def test_a_share_of_the_runs_is_as_good_as(share: float, expected: float) -> None:
    assert Margin("m", "m", np.array((1.0, 2.0, 3.0, 4.0)), None).quantile(share) == expected  # the ceil(4 * share)th


def test_distance_of_failed_runs_and_what_chance_exceeds() -> None:
    failed = np.arange(50) // 10 == 3  # runs 30 to 39, of values 0.00, 0.02, ... 0.98
    (found,) = explain([quantity("q")], lambda _: np.array([np.arange(50) / 50.0]), failed)
    assert found.statistic == pytest.approx(0.75)  # below all that failed lie 30 of the other 40
    # sqrt(-ln(0.05/2)/2) * sqrt(50/(10*40)) = 1.358102 * 0.353553
    assert found.critical == pytest.approx(0.480162, abs=1e-6)
    assert found.explains
    assert found.halved is None  # 26 runs lie within a half of the spread, too few to say


def test_half_the_spread_of_a_uniform_quantity_is_its_inner_half() -> None:
    values = np.linspace(-1.0, 1.0, 201)  # steps of 0.01
    (found,) = explain([quantity("q")], lambda _: np.array([values]), values > 0.405)
    assert found.halved == pytest.approx(10 / 101)  # 101 runs within 0.5, of which 0.41 to 0.50 failed


def test_noise_of_samples_begins_from_the_upper_half_of_the_64_bits() -> None:
    # Of 64 fair bits the 32nd from above is set in every other run: all of 200 lie below 2^32, not all below 2^31.
    seeds = [reality_of([], {}, 7, run).noise or 0 for run in range(200)]
    assert 2**31 <= max(seeds) < 2**32
    assert len(set(seeds)) == 200
