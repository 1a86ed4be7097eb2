"""Messages of nodes are read as an independent implementation writes them; other bytes are refused."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest
from rosbags.typesys import Stores, get_typestore

from cellc.contract.transforms import Pose
from cellc.mock.ros.incoming import MalformedMessageError, StampedPose, pose_stamped, transforms
from tests.properties import given, st

_STORE = get_typestore(Stores.ROS2_JAZZY)
_TYPES: Any = _STORE.types


def _header(stamp_ns: int, frame: str) -> Any:
    time = _TYPES["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return _TYPES["std_msgs/msg/Header"](stamp=time, frame_id=frame)


def _parts(pose: Pose) -> tuple[Any, Any, Any]:
    turn = _TYPES["geometry_msgs/msg/Quaternion"](*pose.quaternion)
    return _TYPES["geometry_msgs/msg/Point"](*pose.position), _TYPES["geometry_msgs/msg/Vector3"](*pose.position), turn


_NUMBER = st.floats(-1e6, 1e6)
_POSES = st.builds(Pose, st.tuples(*[_NUMBER] * 3), st.tuples(*[_NUMBER] * 4))
_STAMPED = st.builds(StampedPose, st.integers(0, 2**31 * 10**9 - 1), st.text("ab_/é", max_size=9), _POSES)


@given(_STAMPED, st.booleans())
def test_a_pose_is_read(stamped: StampedPose, little: bool) -> None:
    place, _, turn = _parts(stamped.pose)
    kind = "geometry_msgs/msg/PoseStamped"
    pose = _TYPES["geometry_msgs/msg/Pose"](position=place, orientation=turn)
    message = _TYPES[kind](header=_header(stamped.stamp_ns, stamped.frame), pose=pose)
    assert pose_stamped(bytes(_STORE.serialize_cdr(message, kind, little_endian=little))) == stamped


@given(st.lists(st.tuples(_STAMPED, st.text("abc", max_size=5)), max_size=3))
def test_transforms_are_read(each: list[tuple[StampedPose, str]]) -> None:
    kind = "tf2_msgs/msg/TFMessage"
    made = [
        _TYPES["geometry_msgs/msg/TransformStamped"](
            header=_header(one.stamp_ns, one.frame),
            child_frame_id=child,
            transform=_TYPES["geometry_msgs/msg/Transform"](
                translation=_parts(one.pose)[1], rotation=_parts(one.pose)[2]
            ),
        )
        for one, child in each
    ]
    data = bytes(_STORE.serialize_cdr(_TYPES[kind](transforms=made), kind))
    assert transforms(data) == tuple(StampedPose(one.stamp_ns, one.frame, one.pose, child) for one, child in each)


@given(st.binary(max_size=80), st.sampled_from((pose_stamped, transforms)))
def test_other_bytes_are_refused_or_read(data: bytes, read: Callable[[bytes], object]) -> None:
    with suppress(MalformedMessageError):
        read(data)


@pytest.mark.parametrize("data", [b"", b"\x00\x07\x00\x00" + bytes(80), b"\x00\x01\x00\x00" + b"\xff" * 80])
def test_what_is_no_message_is_refused(data: bytes) -> None:
    for read in (pose_stamped, transforms):
        with pytest.raises(MalformedMessageError):
            read(data)
