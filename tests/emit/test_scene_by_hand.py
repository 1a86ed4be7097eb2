"""Tiny cells in MuJoCo through their own scenes, held against what is worked out by hand, within 2 %."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from tests.emit.cells import emitted
from tests.scene import SCENE, loaded

G = 9.81
_BODY = '<inertial><origin xyz="{}"/><mass value="{}"/><inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/>'
_LIMIT = '<limit lower="-2" upper="2" velocity="2" effort="200"/>'
_DEVICE = """format: 1
model: {name}
vendor: UNKNOWN
summary: made up
kind: {kind}
as_of: 2026-01-01
description: {{file: robot.urdf}}
sources: [made up]
base: base
frames: {{base: base, hand: hand}}
limits:
  acceleration: {{{joints}}}
  jerk: {{{jerks}}}
packages: {{driver: null, sdk: null, description: null}}
control:
  component: "{{device}}_hardware"
  hardware: {{mock: {{plugin: mock_components/GenericSystem, source: made up}}}}
  joints: {{"*": {{command: [position], state: [position, velocity]}}}}
{more}
"""
_CELL = """format: 1
cell: bench
versions: {{ros: jazzy}}
devices:
  {device}
control:
  update_rate: 100 Hz
  controllers:
    joint_states: {{type: joint_state_broadcaster}}
{more}
"""
_ON_PATH = """    trajectory:
      {type: joint_trajectory, device: arm, goal_time: 1 s, path_tolerance: 1 rad, goal_tolerance: 1 rad}
"""


def _body(at: str, mass: float, moment: float) -> str:
    return _BODY.format(at, mass, moment, moment, moment) + "</inertial>"


def _scene(folder: Path, robot: str, device: str, stated: str, more: str = "", **kind: str) -> Any:
    """Return the loaded scene of a cell with one device."""
    name = device.partition(":")[0]
    (folder / name).mkdir()
    (folder / name / "robot.urdf").write_text(f'<robot name="robot"><link name="base"/>{robot}</robot>')
    joints = [part.partition('"')[0] for part in robot.split('<joint name="')[1:]]
    lines = [
        ", ".join(f"{joint}: {{value: {n}, source: made up}}" for joint in joints)
        for n in kind.pop("limits", "").split("|")
    ]
    text = _DEVICE.format(name=name, kind=kind["kind"], joints=lines[0], jerks=lines[1], more=stated)
    (folder / name / "device.yaml").write_text(text)
    return loaded(emitted(folder, _CELL.format(device=device, more=more))[SCENE])


def _arm(folder: Path, robot: str, device: str, stated: str, more: str = "", unit: str = "rad") -> Any:
    limits = f"2 {unit}/s^2|20 {unit}/s^3"
    return _scene(
        folder,
        robot,
        device,
        f"tool_frame: hand\n{stated}",
        _ON_PATH.replace("rad", unit) + more,
        kind="arm",
        limits=limits,
    )


def _steps(model: Any, data: Any, seconds: float) -> None:
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)


def _begun(model: Any) -> Any:
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return data


def test_period_of_a_pendulum(tmp_path: Path) -> None:
    """A rod of 1 kg, 0.01 kg m^2 about its center 0.3 m below the joint, let go at 0.1 rad with its drive off.

    T = 2 pi sqrt((0.01 + 1 * 0.3^2) / (1 * 9.81 * 0.3)) = 1.1582 s, and 1 + 0.1^2 / 16 of that.
    """
    robot = f"""<link name="hand">{_body("0 0 -0.3", 1.0, 0.01)}</link>
<joint name="turn" type="revolute"><parent link="base"/><child link="hand"/><axis xyz="0 1 0"/>{_LIMIT}</joint>"""
    model = _arm(tmp_path, robot, "arm: {model: ./arm, impedance: {joint: 50 N m/rad}}", _SOFT)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    data = _begun(model)
    data.joint("arm_turn").qpos = 0.1
    crossings: list[float] = []
    before = 0.1
    while len(crossings) < 21:
        mujoco.mj_step(model, data)
        at = float(data.joint("arm_turn").qpos[0])
        if before * at < 0.0:
            crossings.append(data.time - model.opt.timestep * at / (at - before))
        before = at
    period = (crossings[20] - crossings[0]) / 10.0
    assert period == pytest.approx(1.1582 * (1.0 + 0.01 / 16.0), rel=0.002)


_SOFT = "laws: [{loop: spring, gains: impedance, gravity: spring, source: made up}]"


def test_droop_of_two_joints_behind_springs(tmp_path: Path) -> None:
    """Two rods ahead, 1 kg and 0.4 m, then 0.5 kg and 0.3 m; springs of 300 and 50 N m/rad hold them level.

    The first carries 9.81 * (1 * 0.2 + 0.5 * (0.4 + 0.15)) = 4.660 N m, so it gives way by 15.53 mrad; the second
    9.81 * 0.5 * 0.15 = 0.7358 N m, so by 14.72 mrad more.
    """
    robot = f"""<link name="upper">{_body("0.2 0 0", 1.0, 0.013)}</link>
<link name="hand">{_body("0.15 0 0", 0.5, 0.004)}</link>
<joint name="one" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>{_LIMIT}</joint>
<joint name="two" type="revolute"><parent link="upper"/><child link="hand"/><origin xyz="0.4 0 0"/><axis xyz="0 1 0"/>
{_LIMIT}</joint>"""
    stiff = "impedance: {joint: 300 50 N m/rad, damping: 10 2 N m s/rad}"
    model = _arm(tmp_path, robot, f"arm: {{model: ./arm, {stiff}}}", _SOFT)
    data = _begun(model)
    _steps(model, data, 5.0)
    assert data.joint("arm_one").qpos[0] == pytest.approx(0.01553, rel=0.02)
    assert data.joint("arm_two").qpos[0] == pytest.approx(0.01472, rel=0.02)
    # The same law the other way about: what the actuators give is what the arm weighs.
    assert data.actuator("arm_one").force[0] == pytest.approx(-4.660, rel=0.02)


_FRICTIONS = pytest.mark.parametrize("friction", [0.3, 0.5, 0.8])
_REST = '<link name="hand"/><joint name="turn" type="revolute"><parent link="base"/><child link="hand"/>' + (
    f'<axis xyz="0 0 1"/>{_LIMIT}</joint>'
)


@_FRICTIONS
def test_part_slides_down_a_slope_beyond_the_angle_of_its_friction(tmp_path: Path, friction: float) -> None:
    """A part rests on a slope whose tangent is below its friction; beyond, it gains g (sin - friction cos) each second.

    At 1.02 times the friction that is 0.02 friction g cos: 0.056 m/s^2 at 0.3.
    """
    for share, slides in ((0.98, False), (1.02, True)):
        angle = math.atan(share * friction)
        folder = tmp_path / f"{share}"
        folder.mkdir()
        more = f"""frames:
  slope: {{parent: world, xyz: 3 0 2 m, rpy: 0 {math.degrees(angle):.9f} 0 deg, designed: true}}
  part: {{parent: slope, xyz: -0.5 0 0.01 m, designed: true,
         grasp: {{mass: 0.2 kg, size: 80 80 20 mm, friction: {friction}}}}}
scene: {{plate: {{parent: slope, xyz: 0 0 -10 mm, box: 2000 1000 20 mm}}}}
"""
        model = _arm(folder, _REST, "arm: {model: ./arm}", "", more)
        data = _begun(model)
        _steps(model, data, 0.5)
        start = data.body("part_part").xpos.copy()
        speed = float(np.linalg.norm(data.body("part_part").cvel[3:]))
        _steps(model, data, 1.0)
        way = float(np.linalg.norm(data.body("part_part").xpos - start))
        if slides:
            assert way == pytest.approx(speed + 0.5 * 0.02 * friction * G * math.cos(angle), rel=0.1)
        else:
            assert way < 0.0005  # MuJoCo's contacts creep


_PADS = """<link name="hand"/><link name="left"><inertial><mass value="0.05"/>
<inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial>
<collision><geometry><box size="0.03 0.01 0.03"/></geometry></collision></link><link name="right"><inertial>
<mass value="0.05"/><inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial>
<collision><geometry><box size="0.03 0.01 0.03"/></geometry></collision></link>
<joint name="fixed" type="fixed"><parent link="base"/><child link="hand"/></joint>
<joint name="slide" type="prismatic"><parent link="base"/><child link="left"/><origin xyz="0 0.045 0"/>
<axis xyz="0 -1 0"/><limit lower="0" upper="0.04" velocity="0.1" effort="100"/></joint>
<joint name="other" type="prismatic"><parent link="base"/><child link="right"/><origin xyz="0 -0.045 0"/>
<axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="0.1" effort="100"/><mimic joint="slide"/></joint>"""
_GRIPPER = """gripper: {joint: slide, open: 0 mm, closed: 40 mm, stroke: 80 mm, max_force: 100 N, max_speed: 0.1 m/s,
  goal_tolerance: 1 mm, source: made up}"""
_IN_PADS = """frames:
  part: {{parent: world, xyz: 0 0 2 m, designed: true,
         grasp: {{width: 40 mm, tolerance: 1 mm, mass: 0.5 kg, friction: {}}}}}
"""


@_FRICTIONS
def test_part_between_pads_is_held_by_twice_their_force_times_its_friction(tmp_path: Path, friction: float) -> None:
    """Two pads hold 0.5 kg, which weighs 4.905 N, with at least 4.905 / (2 friction): 8.175, 4.905 and 3.066 N.

    With 2 % less the part gains 2 % of g each second.
    """
    needed = 0.5 * G / (2.0 * friction)
    for share, holds in ((1.02, True), (0.98, False)):
        folder = tmp_path / f"{share}"
        folder.mkdir()
        device = (
            f"hand: {{model: ./hand, mount: {{parent: world, xyz: 0 0 2 m}}, grip: {{force: {needed * share:.6f} N}}}}"
        )
        limits = "1 m/s^2|10 m/s^3"
        model = _scene(folder, _PADS, device, _GRIPPER, _IN_PADS.format(friction), kind="gripper", limits=limits)
        data = _begun(model)
        model.opt.gravity[:] = 0.0  # until the fingers hold it
        data.ctrl[:] = 0.04
        _steps(model, data, 1.0)
        assert _normal(model, data, "part_part", "hand_left") == pytest.approx(needed * share, rel=1e-3)
        assert data.joint("hand_slide").qpos[0] == pytest.approx(0.02, abs=0.0003)
        start = float(data.body("part_part").xpos[2])
        model.opt.gravity[2] = -G
        _steps(model, data, 0.4)
        fallen = start - float(data.body("part_part").xpos[2])
        assert fallen < 0.0002 if holds else fallen == pytest.approx(0.5 * 0.02 * G * 0.4**2, rel=0.2)


def _normal(model: Any, data: Any, one: str, other: str) -> float:
    """Return the force between two bodies, N, along the normals of their contacts."""
    force, total = np.zeros(6), 0.0
    for number in range(data.ncon):
        bodies = {model.body(model.geom_bodyid[geom]).name for geom in data.contact[number].geom}
        if bodies == {one, other}:
            mujoco.mj_contactForce(model, data, number, force)
            total += float(force[0])
    return total


def test_push_on_a_block_is_its_weight_times_its_friction(tmp_path: Path) -> None:
    """A pusher at 50 mm/s presses a block of 2 kg and a friction of 0.4 along a table with 0.4 * 2 * 9.81 = 7.848 N.

    It does so through the middle of the block: elsewhere its own friction takes or adds some of the weight.
    """
    robot = f"""<link name="hand">{_body("0 0 0", 1.0, 0.01)}<collision><geometry><box size="0.02 0.1 0.02"/></geometry>
</collision></link><joint name="push" type="prismatic"><parent link="base"/><child link="hand"/><axis xyz="1 0 0"/>
<limit lower="0" upper="1" velocity="1" effort="200"/></joint>"""
    more = """frames:
  block: {parent: world, xyz: 0.1 0 1.05 m, designed: true, grasp: {mass: 2 kg, size: 100 200 100 mm, friction: 0.4}}
scene: {table: {parent: world, xyz: 0.5 0 0.98 m, box: 2000 1000 40 mm}}
"""
    device = "arm: {model: ./arm, mount: {parent: world, xyz: 0 0 1.05 m}}"
    model = _arm(tmp_path, robot, device, "", more, unit="m")
    data = _begun(model)
    pressed = []
    for _ in range(6000):
        data.ctrl[0] = 0.05 * data.time
        mujoco.mj_step(model, data)
        if data.time > 4.0:
            pressed.append(_normal(model, data, "block_part", "arm_hand"))
    assert data.body("block_part").xpos[0] > 0.25
    assert np.mean(pressed) == pytest.approx(7.848, rel=0.02)
