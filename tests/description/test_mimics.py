"""Joints that follow followers, by the hand: position = multiplier * leader + offset."""

from __future__ import annotations

import pytest

from cellc.contract.transforms import identity
from cellc.robot.description.model import Description, Joint, Mimic

Follows = dict[str, tuple[str, float, float]]


def _direct(follows: Follows, *leaders: str) -> Follows:
    joints = tuple(
        Joint(name, "revolute", "base", f"{name}_link", identity(), (0.0, 0.0, 1.0), mimic=None) for name in leaders
    ) + tuple(
        Joint(name, "revolute", "base", f"{name}_link", identity(), (0.0, 0.0, 1.0), mimic=Mimic(*mimic))
        for name, mimic in follows.items()
    )
    direct = Description(name="chain", links=(), joints=joints).with_direct_mimics()
    assert [joint.name for joint in direct.joints] == [joint.name for joint in joints]
    return {
        joint.name: (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
        for joint in direct.joints
        if joint.mimic is not None
    }


@pytest.mark.parametrize(
    ("follows", "direct"),
    [
        ({"b": ("a", 3.0, 0.5)}, {"b": ("a", 3.0, 0.5)}),
        # c = 2 b + 0.1, b = 3 a + 0.5: c = 6 a + 1.1.
        ({"c": ("b", 2.0, 0.1), "b": ("a", 3.0, 0.5)}, {"c": ("a", 6.0, 1.1), "b": ("a", 3.0, 0.5)}),
        # d = -c + 1 = -6 a - 0.1.
        (
            {"b": ("a", 3.0, 0.5), "c": ("b", 2.0, 0.1), "d": ("c", -1.0, 1.0)},
            {"b": ("a", 3.0, 0.5), "c": ("a", 6.0, 1.1), "d": ("a", -6.0, -0.1)},
        ),
        # Two that follow each other, and one that follows them, stay as they are.
        (
            {"b": ("c", 2.0, 0.0), "c": ("b", 0.5, 0.0), "d": ("c", 1.0, 0.0)},
            {"b": ("c", 2.0, 0.0), "c": ("b", 0.5, 0.0), "d": ("c", 1.0, 0.0)},
        ),
        ({"b": ("b", 1.0, 0.2)}, {"b": ("b", 1.0, 0.2)}),
        ({"b": ("nothing", 2.0, 0.2)}, {"b": ("nothing", 2.0, 0.2)}),
    ],
)
def test_follower_of_a_follower_follows_the_first_leader(follows: Follows, direct: Follows) -> None:
    found = _direct(follows, "a")
    assert {name: leader for name, (leader, _, _) in found.items()} == {
        name: leader for name, (leader, _, _) in direct.items()
    }
    for name, (_, multiplier, offset) in direct.items():
        assert found[name][1:] == pytest.approx((multiplier, offset))
