"""The descriptions of the catalogue against published figures and physics."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import pinocchio
import pytest

from cellc.compiler.catalog.compiled import CATALOG, device_file
from cellc.compiler.catalog.load import device_names
from cellc.robot.description.model import Box, Description, Inertial
from cellc.robot.description.xacro_expansion import expand_here
from tests.catalog.chains import Matrix, axis_rotation, transform
from tests.cells import catalog_facts, device_of, there

# Classic DH of the arm as the vendor publishes it: a, alpha, d; theta is the joint.
PI = math.pi
UR5E_DH = (
    (0.0, PI / 2, 0.1625),
    (-0.425, 0.0, 0.0),
    (-0.3922, 0.0, 0.0),
    (0.0, PI / 2, 0.1333),
    (0.0, -PI / 2, 0.0997),
    (0.0, 0.0, 0.0996),
)
UR5E_JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
)
UR_MODELS = ("ur3e", "ur7e", "ur10e", "ur12e", "ur16e", "ur15", "ur18", "ur20", "ur30")
FR3_JOINTS = tuple(f"fr3_joint{number}" for number in range(1, 8))


def _description(name: str) -> Description:
    device = device_of(name)
    return device.description


def _dh(a: float, alpha: float, d: float, theta: float) -> Matrix:
    ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array(
        [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]], dtype=float
    )


def test_arm_has_the_forward_kinematics_of_the_published_parameters() -> None:
    description = _description("ur5e")
    generator = np.random.default_rng(20260722)
    for configuration in generator.uniform(-PI, PI, size=(100, 6)):
        expected = axis_rotation((0.0, 0.0, 1.0), PI)  # base_link is turned by pi against the vendor's base
        for (a, alpha, d), theta in zip(UR5E_DH, configuration, strict=True):
            expected = expected @ _dh(a, alpha, d, theta)
        actual = transform(description, "base_link", "tool0", dict(zip(UR5E_JOINTS, configuration, strict=True)))
        np.testing.assert_allclose(actual, expected, atol=1e-9)


def test_vendor_base_frame_is_base() -> None:
    turned = transform(_description("ur5e"), "base_link", "base", {})
    np.testing.assert_allclose(turned, axis_rotation((0.0, 0.0, 1.0), PI), atol=1e-12)


def test_flange_points_out_with_x_and_tool0_with_z() -> None:
    # REP-199 draft: X+ leaves the flange; tool0 keeps the vendor's Z+ out.
    description = _description("ur5e")
    wrist_to_flange = transform(description, "wrist_3_link", "flange", {})
    np.testing.assert_allclose(wrist_to_flange[:3, 0], [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(transform(description, "wrist_3_link", "tool0", {}), np.eye(4), atol=1e-12)


@pytest.mark.parametrize(("angle", "gap_mm"), [(0.0, 85.0), (0.7929, 0.97), (0.8, 0.16)])
def test_jaws_open_to_the_stroke_and_close(angle: float, gap_mm: float) -> None:
    # By hand: 2 (0.03060114 + 0.0371575 cos q - 0.04342168 sin q - 0.02526).
    description = _description("robotiq_2f_85")
    positions = {"robotiq_85_left_knuckle_joint": angle}
    for joint in description.joints:
        if joint.mimic is not None:
            assert joint.mimic.joint == "robotiq_85_left_knuckle_joint"
            positions[joint.name] = angle * joint.mimic.multiplier + joint.mimic.offset
    pads = []
    for side in ("left", "right"):
        tip = f"robotiq_85_{side}_finger_tip_link"
        link = there(description.link(tip))
        (collision,) = link.collisions
        frame = transform(description, "base_link", tip, positions)
        np.testing.assert_allclose(frame[:3, :3], np.eye(3), atol=1e-9)  # the pads stay parallel
        sign = 1.0 if side == "left" else -1.0
        assert isinstance(collision.geometry, Box)
        half_width = collision.geometry.size[0] / 2
        pads.append(frame[0, 3] + collision.pose.position[0] - sign * half_width)
    assert (pads[0] - pads[1]) * 1000 == pytest.approx(gap_mm, abs=0.05)


@pytest.mark.parametrize(("angle", "gap_mm"), [(0.0, 128.5), (0.695, 0.8)])
def test_jaws_of_the_wide_gripper_stay_parallel_and_close(angle: float, gap_mm: float) -> None:
    # By hand from the origins in the vendor's description: pads of 7.5 mm, whose middles are 136 and 8.3 mm apart.
    description = _description("robotiq_2f_140")
    moving = (joint for joint in description.joints if joint.movable)
    positions = {one.name: angle * (1.0 if one.mimic is None else one.mimic.multiplier) for one in moving}
    left, right = (
        transform(description, "base_link", f"{side}_inner_finger_pad", positions) for side in ("left", "right")
    )
    np.testing.assert_allclose(left[:3, 2], [1, 0, 0], atol=1e-9)
    np.testing.assert_allclose(left[1:3, 3], right[1:3, 3], atol=1e-9)
    assert (left[0, 3] - right[0, 3] - 0.0075) * 1000 == pytest.approx(gap_mm, abs=0.05)


@pytest.mark.parametrize(
    ("name", "second", "color"), [("realsense_d435i", -0.05, 0.015), ("realsense_d455", -0.095, -0.059)]
)
def test_imagers_stand_beside_the_first_as_the_vendor_has_them(name: str, second: float, color: float) -> None:
    # realsense2_description 4.58.2, urdf/_d435i.urdf.xacro and _d455.urdf.xacro.
    for frame, aside in (("infra2_frame", second), ("color_frame", color)):
        np.testing.assert_allclose(transform(_description(name), "link", frame, {})[:3, 3], [0, aside, 0], atol=1e-12)


@pytest.mark.parametrize("frame", ["color_optical_frame", "depth_optical_frame"])
def test_optical_frames_look_along_z(frame: str) -> None:
    # REP-103: z forward, x right, y down, seen from a body with x forward, y left, z up.
    turned = transform(_description("realsense_d435i"), "link", frame, {})[:3, :3]
    np.testing.assert_allclose(turned, [[0, 0, 1], [-1, 0, 0], [0, -1, 0]], atol=1e-12)


@pytest.mark.parametrize("name", device_names())
def test_every_inertia_is_possible(name: str) -> None:
    description = _description(name)
    inertials = [link.inertial for link in description.links if link.inertial is not None]
    assert inertials
    for inertial in inertials:
        _assert_possible(inertial)


def _assert_possible(inertial: Inertial) -> None:
    assert inertial.mass > 0
    tensor = np.array(
        [
            [inertial.ixx, inertial.ixy, inertial.ixz],
            [inertial.ixy, inertial.iyy, inertial.iyz],
            [inertial.ixz, inertial.iyz, inertial.izz],
        ]
    )
    low, middle, high = np.linalg.eigvalsh(tensor)
    assert low > 0
    assert low + middle >= high * (1 - 1e-12)


def _touching(name: str, positions: dict[str, float]) -> set[tuple[str, str]]:
    """Pairs of links that collide though no joint connects them."""
    devices = CATALOG / "devices"
    facts = catalog_facts(name)["description"]
    file = device_file(name).parent / facts["file"]
    expanded = there(expand_here(file.as_posix(), facts.get("arguments", {}), devices.as_posix()).value)
    model = pinocchio.buildModelFromXML(expanded.text)
    geometry = pinocchio.buildGeomFromUrdfString(model, expanded.text, pinocchio.GeometryType.COLLISION)
    geometry.addAllCollisionPairs()
    data, geometry_data = model.createData(), geometry.createData()
    turns = [positions[joint] for joint in list(model.names)[1:]]
    endless = [model.joints[model.getJointId(joint)].nq == 2 for joint in list(model.names)[1:]]
    pairs = zip(turns, endless, strict=True)
    q = np.array([part for turn, twice in pairs for part in ((math.cos(turn), math.sin(turn)) if twice else (turn,))])
    pinocchio.computeCollisions(model, data, geometry, geometry_data, q, False)
    neighbors = {frozenset((joint.parent, joint.child)) for joint in _description(name).joints}
    found = set()
    for pair, result in zip(geometry.collisionPairs, geometry_data.collisionResults, strict=True):
        ends = [geometry.geometryObjects[index] for index in (pair.first, pair.second)]
        first, second = sorted(model.frames[end.parentFrame].name for end in ends)
        if result.isCollision() and first != second and frozenset((first, second)) not in neighbors:
            found.add((first, second))
    return found


@pytest.mark.parametrize(
    ("name", "joints", "degrees"),
    [
        ("ur5e", UR5E_JOINTS, (0, -90, 90, -90, -90, 0)),
        ("ur5e", UR5E_JOINTS, (0, -90, 0, -90, 0, 0)),
        ("ur5e", UR5E_JOINTS, (30, -60, 100, -130, -90, 45)),
        *((name, UR5E_JOINTS, (0, -90, 90, -90, -90, 0)) for name in UR_MODELS),
        ("franka_fr3", FR3_JOINTS, (0, -45, 0, -135, 0, 90, 45)),
        ("franka_fr3", FR3_JOINTS, (0, 0, 0, -9, 0, 32, 0)),
        # Joints 2 and 4 at their ends: neighbours but one must not be mistaken for a collision.
        ("franka_fr3", FR3_JOINTS, (90, 102, 0, -9, 0, 200, 170)),
        ("franka_fr3", FR3_JOINTS, (0, 0, 0, -174, 0, 170, 0)),
    ],
)
def test_arm_does_not_touch_itself(name: str, joints: tuple[str, ...], degrees: tuple[float, ...]) -> None:
    assert _touching(name, dict(zip(joints, np.radians(degrees), strict=True))) == set()


@pytest.mark.parametrize(
    ("name", "joints", "degrees"),
    [
        # The elbow bent by 175 deg lays the forearm into the upper arm: shapes that enclose the links must meet.
        ("ur5e", UR5E_JOINTS, (0, -90, 175, 0, 0, 0)),
        *((name, UR5E_JOINTS, (0, -90, 175, 0, 0, 0)) for name in UR_MODELS),
        # Bent forward over the base and folded, the wrist of the seven-joint arm ends in its own base or column.
        ("franka_fr3", FR3_JOINTS, (0, 100, 0, -174, 0, 120, 0)),
    ],
)
def test_folded_arm_touches_itself(name: str, joints: tuple[str, ...], degrees: tuple[float, ...]) -> None:
    assert _touching(name, dict(zip(joints, np.radians(degrees), strict=True)))


@pytest.mark.parametrize("angle", [0.0, 0.2, 0.4, 0.6, 0.7929, 0.8])
def test_gripper_does_not_touch_itself(angle: float) -> None:
    multipliers = {joint.name: joint.mimic for joint in _description("robotiq_2f_85").joints}
    positions = {name: angle * (1.0 if mimic is None else mimic.multiplier) for name, mimic in multipliers.items()}
    assert _touching("robotiq_2f_85", positions) == set()


@pytest.mark.parametrize("angle", [0.0, 0.35, 0.695])
def test_wide_gripper_touches_itself_where_its_loops_close_alone(angle: float) -> None:
    device = device_of("robotiq_2f_140")
    multipliers = {joint.name: joint.mimic for joint in device.description.joints}
    positions = {name: angle * (1.0 if mimic is None else mimic.multiplier) for name, mimic in multipliers.items()}
    allowed = {tuple(sorted(pair.links)) for pair in device.model.allowed_collisions}
    assert _touching("robotiq_2f_140", positions) <= allowed


def test_expansion_is_the_same_under_any_hash_seed() -> None:
    program = (
        "from cellc.compiler.catalog.compiled import CATALOG, device_file\n"
        "from cellc.compiler.catalog.load import device_names\n"
        "from tests.cells import catalog_facts\n"
        "from cellc.robot.description.xacro_expansion import expand_here\n"
        "d = CATALOG / 'devices'\n"
        "facts = {n: catalog_facts(n)['description'] for n in device_names()}\n"
        "files = {device_file(n).parent / f['file']: f.get('arguments', {}) for n, f in facts.items()}\n"
        "for f, a in files.items():\n"
        "    print(expand_here(str(f), a, str(d)).value)\n"
    )
    folder = Path(__file__).resolve().parents[2]
    outputs = [
        subprocess.run(
            [sys.executable, "-c", program],
            cwd=folder,
            env={**os.environ, "PYTHONHASHSEED": seed},
            stdout=subprocess.PIPE,
            check=True,
        ).stdout
        for seed in ("1", "2")
    ]
    assert outputs[0] == outputs[1]
    assert len(outputs[0]) > 10_000


def test_names_are_unique_within_a_description() -> None:
    for name in device_names():
        description = _description(name)
        for things in (description.links, description.joints):
            names = [thing.name for thing in things]
            assert not [pair for pair in combinations(names, 2) if pair[0] == pair[1]]
        assert len(description.roots()) == 1
