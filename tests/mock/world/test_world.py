"""Ground truth: links against pinocchio, joint states against what was put in, objects against their carriers."""

from __future__ import annotations

import math
import random
from pathlib import Path

import numpy as np
import pytest

from cellc.contract.transforms import Pose, from_xyz_rpy, identity
from cellc.mock.clocks import Clocks
from cellc.mock.control import JointStateBlock
from cellc.mock.nodes.robot_state_publisher import JointStateFeed, RobotStatePublisher
from cellc.mock.tf.buffer import Transform, TransformBuffer
from cellc.mock.tf.messages import TfWarnings
from cellc.mock.tf.sources import DeferredPose, SampledSource
from cellc.mock.world.joint_states import JointStateHistory
from cellc.mock.world.world import LinkTree, World, link_tree
from cellc.robot.description.model import Description
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.planning import RobotModel

MS = 1_000_000

SLIDER = """
<robot name="slider">
  <link name="world"/> <link name="base"/> <link name="cart"/> <link name="flap"/>
  <joint name="mount" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 1"/></joint>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="cart"/><axis xyz="2 0 0"/>
    <limit lower="0" upper="5" velocity="1" effort="1"/></joint>
  <joint name="turn" type="revolute"><parent link="cart"/><child link="flap"/><axis xyz="0 0 1"/>
    <mimic joint="slide" multiplier="2" offset="0.5"/><limit lower="0" upper="9" velocity="1" effort="1"/></joint>
</robot>"""


def history_of(positions: list[float], period_ms: int = 2, skip: frozenset[int] = frozenset()) -> JointStateHistory:
    """Return the history of joint `slide`, one message each period but for those that are skipped."""
    history = JointStateHistory(horizon_s=10.0, period_ns=period_ms * MS)
    kept = [index for index in range(len(positions)) if index not in skip]
    values = np.array([[positions[index]] for index in kept])
    stamps = np.array([index * period_ms * MS for index in kept], dtype=np.int64)
    history.append(JointStateBlock(stamps, ("slide",), values, np.zeros_like(values), np.zeros_like(values)))
    return history


def described(urdf: str) -> Description:
    """Return the model of a URDF that can be read."""
    description = read_urdf(urdf, "robot_description").value
    assert description is not None
    return description


@pytest.fixture
def links() -> LinkTree:
    return link_tree(described(SLIDER))


def test_links_of_the_real_cell_are_where_pinocchio_has_them(built_folder: Path) -> None:
    urdf = (built_folder / "urdf" / "ur5e_pick.mock.urdf").read_text()
    model, links = RobotModel.from_urdf(urdf), link_tree(described(urdf))
    generator = random.Random(0)
    for _ in range(20):
        positions = {joint: generator.uniform(0.0, 0.8) for joint in model.joints}
        for link in model.links:
            ours, theirs = links.pose(link, positions), model.link_pose(link, positions, base_link="world")
            assert ours.position == pytest.approx(theirs.position, abs=1e-12)
            difference = (ours.inverse() @ theirs).quaternion
            assert abs(difference[3]) == pytest.approx(1.0, abs=1e-12)


def test_axis_is_normalised_and_mimic_joint_follows(links: LinkTree) -> None:
    pose = links.pose("flap", {"slide": 0.25})
    assert pose.position == pytest.approx((0.25, 0.0, 1.0))
    assert pose.rpy() == pytest.approx((0.0, 0.0, 2 * 0.25 + 0.5))


@pytest.mark.parametrize(
    ("at_ms", "position"),
    [(-1.0, 3.0), (0.0, 3.0), (0.5, 3.25), (1.5, 3.75), (2.0, 4.0), (3.0, 6.0), (4.0, 8.0), (5.0, 8.0)],
)
def test_positions_are_linear_between_messages_and_held_beyond_them(at_ms: float, position: float) -> None:
    assert history_of([3.0, 4.0, 8.0]).at(round(at_ms * MS)) == {"slide": pytest.approx(position)}


def test_without_a_message_no_position_is_known() -> None:
    assert JointStateHistory(horizon_s=1.0, period_ns=2 * MS).at(0) == {}


def test_joints_of_another_manager_are_left_out_and_other_joints_begin_anew() -> None:
    history = JointStateHistory(horizon_s=1.0, period_ns=2 * MS, foreign=frozenset({"b"}))
    for stamp, names, row in ((0, ("a", "b", "c"), [1.0, 2.0, 3.0]), (2 * MS, ("a", "c", "b"), [4.0, 5.0, 6.0])):
        values = np.array([row])
        history.append(JointStateBlock(np.array([stamp]), names, values, values, values))
    assert history.at(MS) == {"a": 2.5, "c": 4.0}
    values = np.array([[7.0]])
    history.append(JointStateBlock(np.array([4 * MS]), ("a",), values, values, values))
    assert (history.stamps.tolist(), history.positions.tolist()) == ([4 * MS], [[7.0]])


def test_missed_cycles_are_counted_from_gaps() -> None:
    history = history_of([0.0] * 20, skip=frozenset({5, 6, 11}))
    assert history.missed_until(38 * MS) == 3


def test_cycles_that_are_being_missed_are_counted_too() -> None:
    history = history_of([0.0] * 20)  # the last one at 38 ms
    assert history.missed_until(40 * MS) == 0
    assert history.missed_until(48 * MS) == 4
    history.silent = True
    assert history.missed_until(48 * MS) == 0


def test_count_of_missed_cycles_begins_anew() -> None:
    history = history_of([0.0] * 20, skip=frozenset({5}))
    history.count_again()
    assert history.missed_until(38 * MS) == 0


def test_late_joint_states_are_not_known_before_they_arrive() -> None:
    history = history_of([float(index) for index in range(20)])
    history.hold_back(10 * MS, 20 * MS)
    assert history.arrived(8 * MS) == 5
    assert history.arrived(29 * MS) == 5
    assert history.arrived(30 * MS) == 6
    history.release(14 * MS, 20 * MS)  # those of 10 and 12 ms arrive at 30 and 32, that of 14 at once
    assert history.arrivals(np.array([8, 10, 12, 14]) * MS).tolist() == [8 * MS, 30 * MS, 32 * MS, 14 * MS]


def test_history_stays_bounded_and_keeps_its_horizon() -> None:
    history = JointStateHistory(horizon_s=1.0, period_ns=2 * MS)
    for start in range(0, 10_000, 100):
        stamps = np.arange(start, start + 100, dtype=np.int64) * 2 * MS
        values = np.zeros((100, 1))
        history.append(JointStateBlock(stamps, ("slide",), values, values, values))
    assert 500 <= len(history.stamps) <= 1100
    assert history.stamps[-1] == 9_999 * 2 * MS
    assert history.missed_until(9_999 * 2 * MS) == 0


def test_robot_state_publisher_thins_joint_states_to_its_frequency(links: LinkTree) -> None:
    # The cart moves with the square of time, so linear interpolation over 50 ms differs from the truth as expected.
    history = history_of([(index * 0.002) ** 2 for index in range(200)])
    publisher = RobotStatePublisher(
        links, (JointStateFeed(history, None),), rate_hz=20.0, buffer_s=10.0, clocks=Clocks({}, {}, lambda: 0)
    )
    buffer = TransformBuffer()
    publisher.announce(buffer, 0, hears_static=True, hears_moving=True)
    publisher.catch_up(398 * MS)
    answer = buffer.lookup("world", "cart", 125 * MS)
    assert isinstance(answer, Transform)
    assert answer.pose.position[0] == pytest.approx((0.1**2 + 0.15**2) / 2)


def test_object_moves_with_the_link_that_took_it(links: LinkTree) -> None:
    history = history_of([0.002 * index for index in range(501)])  # 1 m/s
    world = World(links, (history,))
    world.place("part", "base", from_xyz_rpy((0.5, 0.0, 0.0), (0.0, 0.0, 0.0)), 0)
    world.move("part", "cart", 500 * MS)
    assert world.object_pose("part", 400 * MS).position == pytest.approx((0.5, 0.0, 1.0))
    assert world.object_pose("part", 900 * MS).position[0] == pytest.approx(0.5 + 0.4 * 1.0)
    world.move("part", "base", 900 * MS)
    assert world.object_pose("part", 1000 * MS).position[0] == pytest.approx(0.9)


def test_empty_world_places_links_at_zero(links: LinkTree) -> None:
    assert World(links, ()).link_pose("base", 0).position == (0.0, 0.0, 1.0)
    assert links.pose("world", {}) == identity()


def test_object_is_seen_from_a_link_where_both_are(links: LinkTree) -> None:
    world = World(links, (history_of([0.01 * index for index in range(100)]),))
    world.place("part", "world", from_xyz_rpy((1.0, 2.0, 3.0), (0.1, 0.2, 0.3)), 0)
    world.move("part", "flap", 100 * MS)
    world.move("part", "base", 150 * MS)
    for stamp_ns in (10 * MS, 20 * MS, 120 * MS, 140 * MS, 160 * MS, 170 * MS):
        for link in ("base", "flap"):
            expected = world.link_pose(link, stamp_ns).inverse() @ world.object_pose("part", stamp_ns)
            assert world.sight(link, "part", stamp_ns).get() == expected
    assert world.sight("base", "part", 120 * MS).get() != world.sight("base", "part", 140 * MS).get()
    assert world.sight("base", "part", 10 * MS).get() != world.sight("base", "part", 160 * MS).get()


def test_object_seen_by_a_joint_without_a_position_is_no_transform(links: LinkTree) -> None:
    world = World(links, (history_of([0.1, math.nan]),))
    world.place("part", "cart", identity(), 0)
    warnings = TfWarnings()
    source = SampledSource("base", "part", "perception", 10.0, warnings)
    source.insert(0, world.sight("base", "part", 0))
    source.insert(2 * MS, world.sight("base", "part", 2 * MS))
    assert list(source.stamps()) == [0]
    assert source.pose(0).position == pytest.approx((0.1, 0.0, 0.0))
    assert "nan value" in warnings.lines()[0]


def test_pose_that_nobody_looks_at_is_not_computed() -> None:
    calls: list[int] = []

    def compute() -> Pose:
        calls.append(1)
        return identity()

    pose = DeferredPose(compute)
    source = SampledSource("base", "part", "perception", 10.0, TfWarnings())
    source.insert(5, pose)
    assert not calls
    assert source.pose(0) is source.pose(0)
    assert len(calls) == 1
