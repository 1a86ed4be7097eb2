"""Collision cases that can be decided by hand: two spheres, a slider and boxes of known size."""

from __future__ import annotations

import pytest

from cellc.contract.transforms import Pose, Vector3
from cellc.robot.planning import Box, CollisionScene, JointLimits, ModelError, Planner, PlanningGroup, RobotModel
from cellc.robot.planning.pair_sampling import draw_configurations
from tests.planning.arm import ADJACENT, arm_urdf

# A ball of 0.1 m radius slides along x over a floor whose top is at z = -0.2; a post stands at x = 1.
SLIDER = """
<robot name="slider">
  <link name="world"/>
  <link name="floor"><collision><origin xyz="0 0 -0.25"/><geometry><box size="4 4 0.1"/></geometry></collision></link>
  <link name="post"><collision><geometry><cylinder radius="0.05" length="0.5"/></geometry></collision></link>
  <link name="ball"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="hand"/>
  <joint name="floor_mount" type="fixed"><parent link="world"/><child link="floor"/></joint>
  <joint name="post_mount" type="fixed"><parent link="world"/><child link="post"/><origin xyz="1 0 0.1"/></joint>
  <joint name="slide" type="prismatic"><parent link="world"/><child link="ball"/><axis xyz="1 0 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="grip" type="fixed"><parent link="ball"/><child link="hand"/><origin xyz="0.1 0 0.3"/></joint>
</robot>
"""
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def _at(xyz: Vector3) -> Pose:
    return Pose(xyz, UPRIGHT)


def _contacts(scene: CollisionScene, slide: float) -> tuple[tuple[str, str], ...]:
    return scene.contacts(scene.model.configuration({"slide": slide}))


@pytest.fixture(name="scene")
def scene_fixture() -> CollisionScene:
    return CollisionScene(RobotModel.from_urdf(SLIDER))


@pytest.mark.parametrize(("slide", "touches"), [(0.849, False), (0.851, True), (1.149, True), (1.151, False)])
def test_ball_touches_the_post_within_the_sum_of_radii(scene: CollisionScene, slide: float, touches: bool) -> None:
    assert scene.collides(scene.model.configuration({"slide": slide})) is touches
    assert _contacts(scene, slide) == ((("ball", "post"),) if touches else ())


def test_shapes_on_one_body_are_not_checked(scene: CollisionScene) -> None:
    assert scene.checked_pairs() == (("ball", "floor"), ("ball", "post"))


def test_disabled_pair_is_not_checked_in_either_order(scene: CollisionScene) -> None:
    silent = CollisionScene(scene.model, disabled_collisions=[("post", "ball")])
    assert _contacts(silent, 1.0) == ()


def test_box_in_the_hand_moves_with_it(scene: CollisionScene) -> None:
    # The box ends 0.3 ahead of the ball's centre: it meets the post of radius 0.05 from x = 0.65 on.
    carrying = scene.attach("part", "hand", (0.4, 0.1, 0.1), _at((0.0, 0.0, -0.1)))
    assert _contacts(carrying, 0.649) == ()
    assert _contacts(carrying, 0.651) == (("part", "post"),)
    assert _contacts(scene, 0.651) == ()


def test_box_on_a_fixture_stands_still_and_is_checked_against_moving_links(scene: CollisionScene) -> None:
    placed = scene.attach("part", "floor", (0.2, 0.2, 0.3), _at((-1.0, 0.0, -0.05)))
    assert _contacts(placed, -0.801) == (("ball", "part"),)
    assert _contacts(placed, -0.799) == ()
    assert ("floor", "part") not in placed.checked_pairs()


def test_allowed_touch_ends_with_forbidding_it_and_with_the_object(scene: CollisionScene) -> None:
    placed = scene.attach("part", "floor", (0.2, 0.2, 0.3), _at((-1.0, 0.0, -0.05)))
    grasping = placed.allow_touch("part", ["ball", "hand"])
    assert _contacts(grasping, -1.0) == ()
    assert _contacts(grasping.forbid_touch("part", ["ball"]), -1.0) == (("ball", "part"),)
    again = grasping.detach("part").attach("part", "floor", (0.2, 0.2, 0.3), _at((-1.0, 0.0, -0.05)))
    assert _contacts(again, -1.0) == (("ball", "part"),)


def test_box_to_be_grasped_touches_what_it_overlaps_and_not_what_carries_it(scene: CollisionScene) -> None:
    # Around the ball's centre at x = 0.75 the box ends at 0.95 and meets the post; the ball itself carries it.
    part = Box("part", "ball", (0.4, 0.1, 0.1), _at((0.0, 0.0, 0.0)))
    assert scene.touching(part, scene.model.configuration({"slide": 0.751})) == ("post",)
    assert scene.touching(part, scene.model.configuration({"slide": 0.749})) == ()
    assert scene.allow_touch("post", ["ball"]).touching(part, scene.model.configuration({"slide": 0.8})) == ("post",)


def test_other_positions_of_one_scene_do_not_move_another(scene: CollisionScene) -> None:
    near = scene.with_other_positions({"slide": 1.0})
    assert near.collides(near.rest_configuration())
    assert not scene.collides(scene.rest_configuration())


@pytest.mark.parametrize("few", [0, 64])
def test_bounding_boxes_hide_no_contact(few: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cellc.robot.planning.scene._FEW_SHAPES", few)
    model = RobotModel.from_urdf(arm_urdf())
    scene = CollisionScene(model, disabled_collisions=ADJACENT).attach("part", "tool", (0.1, 0.1, 0.1), _at((0, 0, 0)))
    configurations = draw_configurations(model, samples=400, rng_seed=3)
    expected = [bool(scene.contacts(configuration)) for configuration in configurations]
    assert [scene.collides(configuration) for configuration in configurations] == expected
    assert 50 < sum(expected) < 350


def test_unknown_names_are_refused(scene: CollisionScene) -> None:
    with pytest.raises(ModelError, match="`pillar`, which is neither a link nor an object"):
        CollisionScene(scene.model, disabled_collisions=[("ball", "pillar")])
    with pytest.raises(ModelError, match="no link `claw`"):
        scene.attach("part", "claw", (0.1, 0.1, 0.1), _at((0.0, 0.0, 0.0)))
    with pytest.raises(ModelError, match="`post` has the name of a link"):
        scene.attach("post", "hand", (0.1, 0.1, 0.1), _at((0.0, 0.0, 0.0)))


@pytest.mark.parametrize(
    ("slide", "clearance_m"),
    [(0.0, 0.1), (0.8, 0.05), (1.3, 0.1), (1.24, 0.09), (0.9, -0.05)],  # of ball and floor, or of ball and post
)
def test_clearance_is_from_what_the_group_moves_to_what_stands_around(
    scene: CollisionScene, slide: float, clearance_m: float
) -> None:
    assert _slider(scene).clearance_m((slide,)) == pytest.approx(clearance_m, abs=2e-6)


def test_clearance_knows_what_is_carried_and_not_what_may_be_touched(scene: CollisionScene) -> None:
    carrying = scene.attach("part", "hand", (0.4, 0.1, 0.1), _at((0.0, 0.0, -0.1)))
    assert _slider(carrying).clearance_m((0.5,)) == pytest.approx(0.1, abs=2e-6)  # the ball and the floor
    assert _slider(carrying).clearance_m((0.62,)) == pytest.approx(0.03, abs=2e-6)  # the part and the post
    assert _slider(carrying.allow_touch("part", ["post"])).clearance_m((0.62,)) == pytest.approx(0.1, abs=2e-6)
    assert _slider(scene.allow_touch("ball", ["post", "floor"])).clearance_m((0.0,)) is None


def test_what_carries_an_arm_does_not_stand_around(scene: CollisionScene) -> None:
    on_the_post = SLIDER.replace(
        '<parent link="world"/><child link="ball"/>', '<parent link="post"/><child link="ball"/>'
    )
    raised = CollisionScene(RobotModel.from_urdf(on_the_post))
    # Seen from the post the ball begins at x = 1 and 0.1 higher: inside the post, and 0.2 above the floor.
    assert raised.collides(raised.model.configuration({"slide": 0.0}))
    assert _slider(raised, base="post").clearance_m((0.0,)) == pytest.approx(0.2, abs=2e-6)
    assert _slider(raised, base="world").clearance_m((0.0,)) == pytest.approx(0.2, abs=2e-6)


def _slider(scene: CollisionScene, base: str = "world") -> Planner:
    limits = JointLimits(("slide",), (-2.0,), (2.0,), (1.0,), (1.0,), (1.0,))
    return Planner(scene.model, PlanningGroup("slider", ("slide",), base, "hand"), limits, scene)
