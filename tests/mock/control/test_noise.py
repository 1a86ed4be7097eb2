"""Noise of measured positions, and joints that lag or saturate by nature."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.mock.control import JointFault, Noise

from .bench import bench, ending, point, positions, send, wait


def test_sequence_is_that_of_the_published_generator() -> None:
    # The first outputs of SplitMix64 with state 0, as its authors' reference program prints them.
    outputs = (0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F)
    expected = [2.0 * (output >> 11) / 2**53 - 1.0 for output in outputs]
    assert Noise(1.0, 0).values(0, 3).tolist() == expected


def test_values_do_not_depend_on_how_cycles_are_grouped() -> None:
    noise = Noise.of_joint("a", 0.5, 7)
    pieces = [noise.values(0, 3), noise.values(3, 1), noise.values(4, 96)]
    assert np.concatenate(pieces).tolist() == noise.values(0, 100).tolist()


def test_noise_is_even_bounded_and_another_for_each_joint_and_seed() -> None:
    values = Noise.of_joint("a", 0.002, 0).values(0, 100_000)
    assert np.abs(values).max() <= 0.002
    assert values.std() == pytest.approx(0.002 / 3**0.5, rel=0.01)  # of an even distribution
    assert abs(values.mean()) < 3 * 0.002 / 3**0.5 / 100_000**0.5
    for joint, seed in (("b", 0), ("a", 1)):
        assert abs(np.corrcoef(values, Noise.of_joint(joint, 0.002, seed).values(0, 100_000))[0, 1]) < 0.02


def test_measured_position_errs_and_the_joint_does_not() -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(noise=Noise.of_joint("a", 0.001, 0)))
    send(manager, point(0.4, 0.4))
    assert int(ending(manager)[0]) == 4
    seen = []
    for _ in range(200):
        wait(manager, 0.002)
        seen.append(positions(manager)[0] - 0.4)
    assert 0.0005 < max(seen) <= 0.001
    assert -0.001 <= min(seen) < -0.0005
    assert positions(manager)[1] == pytest.approx(0.4)


def test_joint_that_is_cleared_of_a_fault_is_what_it_is_by_nature() -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(max_velocity=0.25))
    manager.disturbances.disturb("a", JointFault(stuck=True))
    manager.disturbances.restore("a", JointFault(stuck=True))
    send(manager, point(0.4, 0.0, at=1.0))
    wait(manager, 0.4)
    assert positions(manager)[0] == pytest.approx(0.25 * 0.4, abs=0.002)
