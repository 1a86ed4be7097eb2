"""The transform buffer answers as tf2 does."""

from __future__ import annotations

import math

import pytest

from cellc.contract.transforms import Pose, from_xyz_rpy
from cellc.mock.tf.buffer import Transform, TransformBuffer
from cellc.mock.tf.messages import TfFailure, TfFailureKind, TfWarnings
from cellc.mock.tf.sources import SampledSource, StaticSource

SECOND = 1_000_000_000


@pytest.fixture
def warnings() -> TfWarnings:
    """The log of a listener."""
    return TfWarnings()


@pytest.fixture
def moving(warnings: TfWarnings) -> SampledSource:
    """A link that moves 1 m along x and turns a quarter about z in the second from 10 s to 11 s."""
    source = SampledSource("base", "arm", "driver", 5.0, warnings)
    source.insert(10 * SECOND, from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    source.insert(11 * SECOND, from_xyz_rpy((1.0, 0.0, 0.0), (0.0, 0.0, math.pi / 2)))
    return source


@pytest.fixture
def buffer(moving: SampledSource) -> TransformBuffer:
    """World, base 2 m above it, the moving arm, and a camera 1 m along the arm's x axis."""
    buffer = TransformBuffer()
    buffer.add("base", StaticSource("world", "publisher", from_xyz_rpy((0.0, 0.0, 2.0), (0.0, 0.0, 0.0))))
    buffer.add("arm", moving)
    buffer.add("camera", StaticSource("arm", "publisher", from_xyz_rpy((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    return buffer


def pose(answer: Transform | TfFailure) -> Pose:
    assert isinstance(answer, Transform), answer
    return answer.pose


def failure(answer: Transform | TfFailure) -> TfFailure:
    assert isinstance(answer, TfFailure), answer
    return answer


def test_lookup_between_samples_is_interpolated(buffer: TransformBuffer) -> None:
    camera = pose(buffer.lookup("world", "camera", 10 * SECOND + SECOND // 2))
    # Half way: 0.5 m along x, turned 45 degrees, so the camera's metre points along (cos 45, sin 45).
    half = math.sqrt(0.5)
    assert camera.position == pytest.approx((0.5 + half, half, 2.0), abs=1e-12)
    assert camera.rpy() == pytest.approx((0.0, 0.0, math.pi / 4), abs=1e-12)


def test_lookup_the_other_way_is_the_inverse(buffer: TransformBuffer) -> None:
    there = pose(buffer.lookup("world", "camera", 11 * SECOND))
    back = pose(buffer.lookup("camera", "world", 11 * SECOND))
    assert (there @ back).position == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_lookup_between_branches_goes_over_the_common_frame(buffer: TransformBuffer) -> None:
    buffer.add("fixture", StaticSource("base", "publisher", from_xyz_rpy((0.0, 3.0, 0.0), (0.0, 0.0, 0.0))))
    # The arm stands at x = 1 and its x axis points along the base's y: the fixture is 3 m ahead and 1 m to the left.
    arm_to_fixture = pose(buffer.lookup("arm", "fixture", 11 * SECOND))
    assert arm_to_fixture.position == pytest.approx((3.0, 1.0, 0.0), abs=1e-12)


def test_stamp_ahead_of_the_buffer_is_extrapolation_into_the_future(buffer: TransformBuffer) -> None:
    found = failure(buffer.lookup("world", "camera", 12 * SECOND))
    assert found.kind is TfFailureKind.EXTRAPOLATION_FUTURE
    assert found.text == (
        "Lookup would require extrapolation into the future.  Requested time 12.000000 but the latest data is at time "
        "11.000000, when looking up transform from frame [camera] to frame [world]"
    )


def test_stamp_before_the_buffer_is_extrapolation_into_the_past(buffer: TransformBuffer) -> None:
    found = failure(buffer.lookup("world", "camera", 9 * SECOND))
    assert found.kind is TfFailureKind.EXTRAPOLATION_PAST
    assert "Requested time 9.000000 but the earliest data is at time 10.000000" in found.text


def test_buffer_forgets_what_is_older_than_its_length(buffer: TransformBuffer, moving: SampledSource) -> None:
    moving.insert(16 * SECOND, from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    found = failure(buffer.lookup("world", "arm", 10 * SECOND + 1))
    assert found.kind is TfFailureKind.EXTRAPOLATION_PAST


def test_static_chain_is_known_at_every_time(buffer: TransformBuffer) -> None:
    assert pose(buffer.lookup("world", "base", 0)).position == (0.0, 0.0, 2.0)


def test_frame_that_nobody_published_does_not_exist(buffer: TransformBuffer) -> None:
    found = failure(buffer.lookup("world", "object", 11 * SECOND))
    assert found.kind is TfFailureKind.LOOKUP
    assert found.text.startswith('"object" passed to lookupTransform argument source_frame does not exist.')


def test_frames_of_two_trees_are_not_connected(buffer: TransformBuffer) -> None:
    buffer.add("shelf", StaticSource("hall", "publisher", from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    found = failure(buffer.lookup("world", "shelf", 11 * SECOND))
    assert found.kind is TfFailureKind.CONNECTIVITY
    assert "Could not find a connection between 'world' and 'shelf'" in found.text


def test_edge_with_one_transform_answers_for_its_stamp_alone(buffer: TransformBuffer, warnings: TfWarnings) -> None:
    lone = SampledSource("world", "object", "perception", 5.0, warnings)
    lone.insert(10 * SECOND, from_xyz_rpy((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    buffer.add("object", lone)
    assert pose(buffer.lookup("world", "object", 10 * SECOND)).position == (1.0, 0.0, 0.0)
    found = failure(buffer.lookup("world", "object", 10 * SECOND + 1600))
    assert found.kind is TfFailureKind.EXTRAPOLATION_ONE_SAMPLE
    # tf2 prints with std::fixed and six digits, which rounds: 10.0000016 s is 10.000002.
    assert found.text == (
        "Lookup would require extrapolation at time 10.000002, but only time 10.000000 is in the buffer, when looking "
        "up transform from frame [object] to frame [world]"
    )


def test_stamp_zero_asks_for_the_latest_common_time(buffer: TransformBuffer) -> None:
    answer = buffer.lookup("world", "camera", 0)
    assert isinstance(answer, Transform)
    assert answer.stamp_ns == 11 * SECOND
    assert answer.pose.position == pytest.approx((1.0, 1.0, 2.0), abs=1e-12)


def test_frame_in_itself_is_where_it_is_even_if_nobody_knows_it(buffer: TransformBuffer) -> None:
    assert pose(buffer.lookup("nowhere", "nowhere", 5)).position == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("frame", "text"),
    [
        ("", 'Invalid argument "" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot be empty'),
        (
            "/world",
            'Invalid argument "/world" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot start '
            "with a '/'",
        ),
    ],
)
def test_name_that_no_frame_can_have_is_an_invalid_argument(buffer: TransformBuffer, frame: str, text: str) -> None:
    found = failure(buffer.lookup(frame, "camera", 0))
    assert (found.kind, found.text) == (TfFailureKind.INVALID_ARGUMENT, text)


def test_edge_that_fails_below_the_target_is_named_before_one_below_the_source(
    buffer: TransformBuffer, warnings: TfWarnings
) -> None:
    # tf2 remembers what failed above the source, and returns at once with what fails above the target.
    other = SampledSource("base", "other", "other_driver", 5.0, warnings)
    for second in (20, 21):
        other.insert(second * SECOND, from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    buffer.add("other", other)
    found = failure(buffer.lookup("camera", "other", 15 * SECOND))
    assert found.kind is TfFailureKind.EXTRAPOLATION_FUTURE
    assert "latest data is at time 11.000000" in found.text
    assert failure(buffer.lookup("other", "camera", 15 * SECOND)).kind is TfFailureKind.EXTRAPOLATION_PAST


def test_tree_with_a_loop_is_invalid(buffer: TransformBuffer) -> None:
    buffer.add("world", StaticSource("camera", "intruder", from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    buffer.add("shelf", StaticSource("hall", "publisher", from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    found = failure(buffer.lookup("shelf", "camera", 11 * SECOND))
    assert found.kind is TfFailureKind.LOOKUP
    assert found.text.startswith("The tf tree is invalid because it contains a loop.")
