"""What a listener stores, refuses and logs: geometry2 `tf2/src/cache.cpp` and `buffer_core.cpp` of ROS 2."""

from __future__ import annotations

import math

import pytest

from cellc.contract.transforms import Pose, from_xyz_rpy, identity
from cellc.mock.clocks import Clock, Segment, TimeJump
from cellc.mock.tf.buffer import Transform, TransformBuffer
from cellc.mock.tf.messages import TfFailure, TfFailureKind
from cellc.mock.tf.sources import SampledSource, StaticSource

SECOND = 1_000_000_000


def at_x(meters: float) -> Pose:
    return from_xyz_rpy((meters, 0.0, 0.0), (0.0, 0.0, 0.0))


def x_of(buffer: TransformBuffer, frame: str, stamp_ns: int) -> float:
    answer = buffer.lookup("world", frame, stamp_ns)
    assert isinstance(answer, Transform), answer
    return answer.pose.position[0]


@pytest.fixture
def buffer() -> TransformBuffer:
    return TransformBuffer()


@pytest.fixture
def part(buffer: TransformBuffer) -> SampledSource:
    """A part in the world, seen by perception, kept for 5 s."""
    source = SampledSource("world", "part", "perception", 5.0, buffer.warnings)
    buffer.add("part", source)
    return source


def test_data_older_than_the_buffer_is_refused_with_tf_old_data(buffer: TransformBuffer, part: SampledSource) -> None:
    part.insert(20 * SECOND, at_x(1.0))
    part.insert(15 * SECOND, at_x(2.0))  # exactly as old as the buffer is long: kept
    part.insert(15 * SECOND - 1, at_x(3.0))
    assert buffer.warnings.lines() == (
        "TF_OLD_DATA ignoring data from the past for frame part at time 15.000000 according to authority perception",
    )
    assert x_of(buffer, "part", 15 * SECOND) == 2.0


def test_refused_data_is_counted_not_repeated(buffer: TransformBuffer, part: SampledSource) -> None:
    part.insert(20 * SECOND, at_x(1.0))
    for _ in range(3):
        part.insert(1 * SECOND, at_x(2.0))
    (line,) = buffer.warnings.lines()
    assert line.endswith("(3 times)")


def test_late_data_is_stored_between_what_came_before(buffer: TransformBuffer, part: SampledSource) -> None:
    part.insert(10 * SECOND, at_x(0.0))
    part.insert(12 * SECOND, at_x(2.0))
    part.insert(11 * SECOND, at_x(8.0))
    assert x_of(buffer, "part", 11 * SECOND + SECOND // 2) == pytest.approx(5.0)


def test_repeated_stamp_is_stored_silently_and_the_later_value_is_found(
    buffer: TransformBuffer, part: SampledSource
) -> None:
    # TF_REPEATED_DATA is a warning of ROS 1; insertData of ROS 2 puts the newer value before the older one.
    part.insert(10 * SECOND, at_x(1.0))
    part.insert(11 * SECOND, at_x(2.0))
    part.insert(11 * SECOND, at_x(5.0))
    assert buffer.warnings.lines() == ()
    assert x_of(buffer, "part", 11 * SECOND) == 5.0


def test_repeated_stamp_among_older_ones_is_found_with_its_later_value(
    buffer: TransformBuffer, part: SampledSource
) -> None:
    for stamp, meters in ((10, 0.0), (12, 2.0), (11, 1.0), (11, 7.0)):
        part.insert(stamp * SECOND, at_x(meters))
    assert x_of(buffer, "part", 11 * SECOND) == 7.0


def set_back(*, simulated: bool, source_changed: bool = False) -> TimeJump:
    """Return the jump of a clock by two seconds back."""
    clock = Clock("pc", "ros", (Segment(0, 0, 1.0),), simulated=simulated)
    return TimeJump(clock, -2 * SECOND, 10 * SECOND, source_changed)


@pytest.mark.parametrize(
    ("jump", "line"),
    [
        (set_back(simulated=True), "Detected jump back in time. Clearing TF buffer."),
        (set_back(simulated=True, source_changed=True), "Detected time source change. Clearing TF buffer."),
        (set_back(simulated=False), None),
    ],
)
def test_buffer_is_cleared_where_rcl_tells_tf2_of_a_jump(
    buffer: TransformBuffer, part: SampledSource, jump: TimeJump, line: str | None
) -> None:
    buffer.add("base", StaticSource("world", "publisher", at_x(1.0)))
    part.insert(9 * SECOND, at_x(1.0))
    part.insert(10 * SECOND, at_x(1.0))
    buffer.note_jump(jump)
    assert buffer.warnings.lines() == (() if line is None else (line,))
    assert x_of(buffer, "base", 0) == 1.0  # /tf_static is never forgotten
    answer = buffer.lookup("world", "part", 10 * SECOND)
    if line is None:
        assert isinstance(answer, Transform)
    else:
        assert isinstance(answer, TfFailure)
        # The frame is known, its history is not: tf2 has no reason to give before the comma.
        assert answer.kind is TfFailureKind.EXTRAPOLATION_NO_DATA
        assert answer.text == ", when looking up transform from frame [part] to frame [world]"


@pytest.mark.parametrize(
    ("parent", "child", "pose", "text"),
    [
        (
            "part",
            "part",
            identity(),
            'TF_SELF_TRANSFORM: Ignoring transform from authority "perception" with frame_id and  child_frame_id '
            '"part" because they are the same',
        ),
        (
            "",
            "part",
            identity(),
            'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "part"  from authority "perception" because '
            "frame_id not set",
        ),
        (
            "world",
            "",
            identity(),
            'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "perception" because child_frame_id not set ',
        ),
        (
            "world",
            "part",
            Pose((math.nan, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
            'TF_NAN_INPUT: Ignoring transform for child_frame_id "part" from authority "perception" because of a nan '
            "value in the transform (nan 0.000000 0.000000) (0.000000 0.000000 0.000000 1.000000)",
        ),
        (
            "world",
            "part",
            Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.01)),
            'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "part" from authority "perception" '
            "because of an invalid quaternion in the transform (0.000000 0.000000 0.000000 1.010000)",
        ),
    ],
)
def test_transform_that_means_nothing_is_refused(
    buffer: TransformBuffer, parent: str, child: str, pose: Pose, text: str
) -> None:
    source = SampledSource(parent, child, "perception", 5.0, buffer.warnings)
    source.insert(SECOND, pose)
    assert not source.stamps()
    assert buffer.warnings.lines() == (text,)


def test_quaternion_is_accepted_up_to_a_hundredth_of_squared_length(part: SampledSource) -> None:
    part.insert(SECOND, Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, math.sqrt(1.0099))))
    assert len(part.stamps()) == 1


def test_two_authorities_with_stamps_both_answer(buffer: TransformBuffer, part: SampledSource) -> None:
    intruder = SampledSource("world", "part", "intruder", 5.0, buffer.warnings)
    buffer.add("part", intruder)
    part.insert(10 * SECOND, at_x(0.0))
    part.insert(12 * SECOND, at_x(0.0))
    intruder.insert(11 * SECOND, at_x(9.0))
    assert buffer.conflicts == ["frame `part` has two authorities: `perception` and `intruder`"]
    assert x_of(buffer, "part", 11 * SECOND) == 9.0
    assert x_of(buffer, "part", 10 * SECOND + SECOND // 2) == pytest.approx(4.5)


def test_second_static_authority_replaces_the_first(buffer: TransformBuffer) -> None:
    buffer.add("base", StaticSource("world", "publisher", at_x(1.0)))
    buffer.add("base", StaticSource("world", "intruder", at_x(9.0)))
    assert x_of(buffer, "base", 0) == 9.0


def test_stamped_authority_replaces_a_static_one_once_it_has_spoken(buffer: TransformBuffer) -> None:
    buffer.add("base", StaticSource("world", "publisher", at_x(1.0)))
    intruder = SampledSource("world", "base", "intruder", 5.0, buffer.warnings)
    buffer.add("base", intruder)
    assert x_of(buffer, "base", 0) == 1.0
    intruder.insert(10 * SECOND, at_x(9.0))
    assert x_of(buffer, "base", 10 * SECOND) == 9.0


def test_transforms_of_different_parents_are_not_mixed(buffer: TransformBuffer, part: SampledSource) -> None:
    buffer.add("table", StaticSource("world", "publisher", at_x(1.0)))
    intruder = SampledSource("table", "part", "intruder", 5.0, buffer.warnings)
    buffer.add("part", intruder)
    part.insert(10 * SECOND, at_x(0.0))
    intruder.insert(12 * SECOND, at_x(5.0))
    assert x_of(buffer, "part", 11 * SECOND) == 0.0
    assert x_of(buffer, "part", 12 * SECOND) == 6.0
