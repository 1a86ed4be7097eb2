"""Every way a rotation is turned into other figures, near the poles of pitch too, against formulas of its own."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pinocchio
import pytest

from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.urdf.elements import origin
from cellc.compiler.link.hand_eye_file import read_hand_eye
from cellc.compiler.link.side_file import SideFile
from cellc.contract.transforms import Pose, apart, from_xyz_rpy, interpolate
from cellc.robot.description.urdf_reader import read_urdf
from tests.properties import given, settings, st

_QUARTER = math.pi / 2.0
_WRITTEN = 4e-12
"""Bound of an element of the matrix: three angles rounded to 1e-12 turn it by 1.5e-12, yaw cut near a pole by 1e-13."""
_EXACT = 1e-14

_drawn = settings(deadline=None, derandomize=True)
_Matrix = np.ndarray[Any, np.dtype[np.float64]]

_rounded_quarters = st.integers(2, 17).map(lambda digits: round(_QUARTER, digits))
_off = st.floats(-17.0, 0.0).map(lambda power: 10.0**power)
_pitches = st.tuples(
    st.sampled_from((-1.0, 1.0)),
    st.one_of(_rounded_quarters, _off.map(lambda off: _QUARTER - off), _off.map(lambda off: _QUARTER + off)),
).map(lambda pair: pair[0] * pair[1])
_angles = st.one_of(st.sampled_from((0.0, math.pi, -math.pi, _QUARTER, 1.5708, -3.14159)), st.floats(-7.0, 7.0))
_turns = st.tuples(_angles, st.one_of(_pitches, _angles), _angles)


def _matrix(rpy: Sequence[float]) -> _Matrix:
    """Return the rotation about the fixed axes x, y and z, one after the other (REP 103)."""
    roll, pitch, yaw = rpy
    about_x = [[1, 0, 0], [0, math.cos(roll), -math.sin(roll)], [0, math.sin(roll), math.cos(roll)]]
    about_y = [[math.cos(pitch), 0, math.sin(pitch)], [0, 1, 0], [-math.sin(pitch), 0, math.cos(pitch)]]
    about_z = [[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1]]
    turned: _Matrix = np.array(about_z) @ np.array(about_y) @ np.array(about_x)
    return turned


def _error(first: _Matrix, second: _Matrix) -> float:
    return float(np.abs(first - second).max())


def _of(pose: Pose) -> _Matrix:
    x, y, z, w = pose.quaternion
    return np.array(pinocchio.Quaternion(w, x, y, z).toRotationMatrix())


def _pose(rpy: tuple[float, float, float]) -> Pose:
    return from_xyz_rpy((0.0, 0.0, 0.0), rpy)


@_drawn
@given(_turns, st.booleans())
def test_a_turn_is_the_same_after_roll_pitch_and_yaw_are_rounded_as_files_have_them(
    turn: tuple[float, float, float], negative: bool
) -> None:
    pose = _pose(turn)
    if negative:  # the same rotation
        x, y, z, w = pose.quaternion
        pose = Pose(pose.position, (-x, -y, -z, -w))
    assert _error(_of(pose), _matrix(turn)) < _EXACT
    assert _error(_matrix([rounded(angle) for angle in pose.rpy()]), _matrix(turn)) < _WRITTEN


@_drawn
@given(_turns)
def test_angles_of_a_turn_are_small(turn: tuple[float, float, float]) -> None:
    roll, pitch, yaw = _pose(turn).rpy()
    assert max(abs(roll), abs(yaw)) <= math.pi + 1e-12
    assert abs(pitch) <= _QUARTER + math.radians(0.2)


@_drawn
@given(_turns)
def test_an_origin_that_is_written_to_urdf_is_the_one_that_was_read(turn: tuple[float, float, float]) -> None:
    text = " ".join(map(repr, turn))
    urdf = '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed">{}'
    urdf += '<parent link="a"/><child link="b"/></joint></robot>'
    read = read_urdf(urdf.format(f'<origin rpy="{text}"/>'), "robot.urdf").value
    assert read is not None
    written = [element.get("rpy") for element in origin(read.joints[0].pose)]
    again = [float(part) for part in (written[0] if written and written[0] else "0 0 0").split()]
    assert _error(np.array(pinocchio.rpy.rpyToMatrix(*again)), _matrix(turn)) < _WRITTEN


@pytest.mark.parametrize("digits", range(2, 13))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_quarter_turn_of_pitch_stays_as_its_vendor_rounded_it(digits: int, sign: float) -> None:
    pitch = sign * round(_QUARTER, digits)
    assert [rounded(angle) for angle in _pose((0.0, pitch, 0.0)).rpy()] == [0.0, pitch, 0.0]


@_drawn
@given(_turns)
def test_a_rotation_vector_is_the_logarithm_of_the_matrix(turn: tuple[float, float, float]) -> None:
    vector = np.array(_pose(turn).rotation_vector())
    assert float(np.linalg.norm(vector)) <= math.pi + 1e-12
    assert _error(np.array(pinocchio.exp3(vector)), _matrix(turn)) < 1e-12


@_drawn
@given(_turns, st.floats(-15.0, math.log10(math.pi)).map(lambda power: 10.0**power), st.integers(0, 2))
def test_two_poses_are_apart_by_the_angle_between_them(
    turn: tuple[float, float, float], angle: float, axis: int
) -> None:
    between = [0.0, 0.0, 0.0]
    between[axis] = angle
    first, second = _pose(turn), _pose(turn) @ _pose((between[0], between[1], between[2]))
    assert apart(first, second)[1] == pytest.approx(angle, abs=2e-15, rel=1e-14)


@_drawn
@given(_turns, _turns, st.floats(0.0, 1.0))
def test_halfway_between_two_turns_goes_along_the_shorter_arc(
    start: tuple[float, float, float], end: tuple[float, float, float], fraction: float
) -> None:
    between = pinocchio.log3(_matrix(start).T @ _matrix(end))
    if float(np.linalg.norm(between)) > math.pi - 1e-3:
        return  # either way round is as short
    expected = _matrix(start) @ pinocchio.exp3(fraction * between)
    assert _error(_of(interpolate(_pose(start), _pose(end), fraction)), expected) < 1e-10


@_drawn
@given(_turns)
def test_a_matrix_of_a_calibration_is_the_turn_that_it_states(turn: tuple[float, float, float]) -> None:
    rows = np.vstack((np.hstack((_matrix(turn), np.zeros((3, 1)))), (0.0, 0.0, 0.0, 1.0))).tolist()
    text = json.dumps({"parent": "tool0", "child": "camera", "matrix": rows})
    read = read_hand_eye(SideFile("eye.json", "eye.json", "", text)).value
    assert read is not None
    assert _error(_of(read.pose), _matrix(turn)) < 1e-14
