"""Pairs without a collision check: worked out by hand on small models, held by other samples on a real one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cellc.robot.planning import CollisionScene, DisabledReason, RobotModel, decided_collisions, disabled_collisions

from .arm import ADJACENT, arm_urdf
from .test_robot_model import ARM, TWO_FINGERS, _expanded
from .test_scene import SLIDER


def _reasons(urdf: str, samples: int = 100) -> dict[tuple[str, str], str]:
    pairs = disabled_collisions(RobotModel.from_urdf(urdf), samples=samples, rng_seed=5, margin_m=0.005)
    return {pair.links: pair.reason.value for pair in pairs}


def _adjacent(urdf: str) -> set[tuple[str, str]]:
    return {links for links, reason in _reasons(urdf).items() if reason == "adjacent"}


def test_neighbours_of_the_arm_are_the_links_of_each_joint() -> None:
    # The base lies between the table and the first link, so that these two stay checked.
    assert set(ADJACENT) <= _adjacent(arm_urdf())
    assert _adjacent(arm_urdf()) - set(ADJACENT) <= {("base", "table")}  # on one rigid body


def test_neighbours_are_found_through_fixed_joints_and_shapeless_links() -> None:
    flange = (
        '<link name="flange"/><link name="camera">'
        '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>'
        '<joint name="f1" type="fixed"><parent link="tool"/><child link="flange"/></joint>'
        '<joint name="turn" type="revolute"><parent link="flange"/><child link="camera"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" velocity="1" effort="1"/></joint>'
    )
    assert _adjacent(arm_urdf(flange)) - _adjacent(arm_urdf()) == {("camera", "link_6")}


def test_pair_in_contact_at_every_sample_is_always() -> None:
    fused = SLIDER.replace('<box size="4 4 0.1"/>', '<box size="9 4 0.5"/>')
    assert _reasons(fused)["ball", "floor"] == "always"
    assert ("ball", "floor") not in {pair for pair, reason in _reasons(SLIDER).items() if reason == "always"}


def _cart(gap: float) -> str:
    """Return a cube that slides past a post whose nearest face is ``gap`` metres from its path; both 0.1 m wide."""
    return f"""<robot name="cart"><link name="floor"/>
    <link name="cube"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <link name="post"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="rail" type="fixed"><parent link="floor"/><child link="carrier"/></joint><link name="carrier"/>
    <joint name="slide" type="prismatic"><parent link="carrier"/><child link="cube"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
    <joint name="stand" type="fixed"><parent link="floor"/><child link="post"/>
    <origin xyz="0 {0.1 + gap} 0"/></joint></robot>"""


def test_pair_that_passes_nearer_than_the_margin_stays_checked() -> None:
    assert _reasons(_cart(0.006)) == {("cube", "post"): "never"}
    assert _reasons(_cart(0.004)) == {}


def test_rigid_pair_is_always_where_it_touches_and_never_beyond() -> None:
    def two_boxes(distance: float) -> str:
        shape = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
        return f"""<robot name="two"><link name="floor"/><link name="a">{shape}</link><link name="b">{shape}</link>
        <joint name="ja" type="fixed"><parent link="floor"/><child link="a"/></joint>
        <joint name="jb" type="fixed"><parent link="floor"/><child link="b"/><origin xyz="{distance} 0 0"/></joint>
        </robot>"""

    assert _reasons(two_boxes(0.1)) == {("a", "b"): "always"}
    assert _reasons(two_boxes(0.2)) == {("a", "b"): "never"}


def test_same_seed_gives_the_same_pairs() -> None:
    assert _reasons(arm_urdf()) == _reasons(arm_urdf())


@pytest.mark.parametrize(("path", "device"), [(ARM, "ur5e"), (TWO_FINGERS, "robotiq_2f_85")], ids=["arm", "gripper"])
def test_pairs_hold_at_other_samples(path: Path, device: str) -> None:
    model = RobotModel.from_urdf(_expanded(path, device))
    pairs = disabled_collisions(model, samples=10_000, rng_seed=0, margin_m=0.005)
    never = {pair.links for pair in pairs if pair.reason is DisabledReason.NEVER}
    always = {pair.links for pair in pairs if pair.reason is DisabledReason.ALWAYS}
    everything = CollisionScene(model)
    generator = np.random.default_rng(20260701)
    lower = [
        float(model.kinematics.lowerPositionLimit[model.kinematics.idx_qs[model.joint_of(j)]]) for j in model.joints
    ]
    upper = [
        float(model.kinematics.upperPositionLimit[model.kinematics.idx_qs[model.joint_of(j)]]) for j in model.joints
    ]
    moving = set(everything.checked_pairs())
    for _ in range(2000):
        drawn = dict(zip(model.joints, generator.uniform(lower, upper).tolist(), strict=True))
        touching = set(everything.contacts(model.configuration(drawn)))
        assert not touching & never
        assert always & moving <= touching


def test_pairs_that_only_samples_keep_apart_are_left_to_the_check_of_a_configuration() -> None:
    # The cube passes the post at 10 mm: its ball reaches the post, so that only samples tell that they stay apart.
    model = RobotModel.from_urdf(_cart(gap=0.01))
    everything = disabled_collisions(model, samples=100, rng_seed=5, margin_m=0.005)
    decided = decided_collisions(model, samples=100, rng_seed=5, margin_m=0.005)
    assert {pair.links for pair in set(everything) - set(decided)} == {("cube", "post")}
    assert set(decided) <= set(everything)
