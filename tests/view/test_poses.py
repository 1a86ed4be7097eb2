"""Poses that are computed together have the bits of those that are computed one by one."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.contract.transforms import Pose
from cellc.mock.world.world import link_tree
from cellc.tools.view.poses import alike, composed
from cellc.tools.view.skeleton import Skeleton
from cellc.tools.view.subject import read_subject
from tests.cells import EVERY_CELL, ROOT

_TIMES = 20


def _random(random: np.random.Generator) -> Pose:
    x, y, z, *turn = random.normal(size=7).tolist()
    i, j, k, w = (value / float(np.linalg.norm(turn)) for value in turn)
    return Pose((x, y, z), (i, j, k, w))


def test_poses_compose_as_one_does() -> None:
    random = np.random.default_rng(0)
    pairs = [(_random(random), _random(random)) for _ in range(200)]
    firsts, seconds = (
        tuple(np.array([[*pose.position, *pose.quaternion] for pose in poses]).T) for poses in zip(*pairs, strict=True)
    )
    one_by_one = [first @ second for first, second in pairs]
    expected = [(*pose.position, *pose.quaternion) for pose in one_by_one]
    assert list(zip(*composed(firsts, seconds), strict=True)) == expected
    held = pairs[0][1]
    together = [(*pose.position, *pose.quaternion) for pose in (first @ held for first, _ in pairs)]
    assert list(zip(*composed(firsts, alike(held)), strict=True)) == together


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_each_group_is_where_its_link_is_at_each_time(cell: str) -> None:
    standing = read_subject(ROOT / "generated" / cell).standing
    assert standing is not None
    skeleton, random = Skeleton(standing), np.random.default_rng(1)
    at = {joint.name: random.uniform(-3.0, 3.0, _TIMES) for joint in standing.description.joints if joint.movable}
    found = skeleton.postures(at, [{}] * _TIMES)
    tree = link_tree(standing.description)
    for group, name in enumerate(skeleton.groups[: skeleton.links]):
        poses = [
            tree.pose(name, {joint: float(values[time]) for joint, values in at.items()}) for time in range(_TIMES)
        ]
        assert [tuple(row) for row in found[group].T.tolist()] == [(*pose.position, *pose.quaternion) for pose in poses]
