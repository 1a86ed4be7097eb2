"""Droop, overshoot, stopping distance and a part that topples, by the textbook: an oscillator, the balance of a box."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cellc.contract.transforms import Pose
from cellc.mock.physics.dynamics import Dynamics
from cellc.mock.physics.motions import Motion, drooping, motions, passing, stopping, toppled
from cellc.robot.physics.scene import Scene

_MS = 1_000_000
_SHARE = 0.2
"""Damping ratio of the slider: 1 kg behind 100 N/m."""
_SCENE = f"""<mujoco><option timestep="0.001" integrator="implicitfast"/><worldbody>
<body name="floor"><geom type="box" size="2 2 0.05" pos="0 0 -0.05"/></body>
<body name="carriage" pos="0 1 1"><joint name="along" type="slide" axis="1 0 0"/>
<inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/></body>
<body name="lift" pos="0 2 1"><joint name="up" type="slide" axis="0 0 1"/>
<inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/></body>
<body name="part" pos="0 0 0.05"><freejoint/><geom type="box" size="0.02 0.02 0.05" mass="0.2"/></body>
</worldbody><actuator><position name="along" joint="along" kp="100" kv="{2.0 * _SHARE * 10.0}"/>
<position name="up" joint="up" kp="1000" kv="{2.0 * _SHARE * 1000.0**0.5}"/></actuator></mujoco>"""


def _made() -> Dynamics:
    return Dynamics(Scene(_SCENE, {}), frozenset({frozenset({"part", "floor"})}), {}, {})


def _run(bodies: Dynamics, first_ms: int, until_ms: int, along: float, up: float = 0.0) -> None:
    times = np.arange(first_ms, until_ms + 1, dtype=np.int64) * _MS
    bodies.aim(["along", "up"], np.tile((along, up), (len(times), 1)))
    bodies.advance(times)
    bodies.commit(len(times))


def _of(bodies: Dynamics, joint: str, since_ms: int = 0) -> Motion:
    return next(each for each in motions(bodies, since_ms * _MS) if each.joint == joint)


def test_a_lift_droops_by_its_weight_over_its_stiffness() -> None:
    bodies = _made()
    _run(bodies, 1, 3000, 0.0)
    assert _of(bodies, "up").droop == pytest.approx(9.81 / 1000.0, rel=1e-3)
    assert drooping(tuple(motions(bodies, 0))) == "droop: joint up rests 9.81 mm from its command"
    assert drooping(tuple(motions(bodies, 0, ("up",)))) == ""


def test_a_step_is_passed_by_what_the_damping_ratio_says() -> None:
    """exp(-pi z / sqrt(1 - z^2)) of the step: 52.7 mm of 100 mm at z = 0.2."""
    bodies = _made()
    _run(bodies, 1, 10, 0.0)
    _run(bodies, 11, 3000, 0.0)
    _run(bodies, 3001, 11000, 0.1, 0.1)
    expected = 0.1 * math.exp(-math.pi * _SHARE / math.sqrt(1.0 - _SHARE**2))
    assert _of(bodies, "along", 2900).overshoot == pytest.approx(expected, rel=0.02)
    assert _of(bodies, "up", 2900).overshoot == pytest.approx(expected, rel=0.05), "beyond where it droops to"
    assert passing(tuple(motions(bodies, 2900 * _MS, ("up",)))).startswith(
        "overshoot: joint along passes its end by 52."
    )
    assert _of(bodies, "along", 10000).overshoot == 0.0


def test_a_stopped_joint_goes_on_by_its_speed_over_its_frequency() -> None:
    """x = v / w exp(-z / sqrt(1 - z^2) acos z), where the drive holds what is measured at the stop."""
    bodies = _made()
    _run(bodies, 1, 10, 0.0)
    _run(bodies, 11, 150, 0.1)
    speed, at = float(bodies.moving(["along"])[0]), float(bodies.standing(["along"])[0])
    _run(bodies, 151, 400, at)
    expected = speed / 10.0 * math.exp(-_SHARE / math.sqrt(1.0 - _SHARE**2) * math.acos(_SHARE))
    assert _of(bodies, "along", 149).way == pytest.approx(expected, rel=0.03)
    assert "joint along goes on by " in stopping(tuple(motions(bodies, 149 * _MS)))
    assert ", and still moves at " in stopping(tuple(motions(bodies, 149 * _MS)))


@pytest.mark.parametrize(("degrees", "falls"), [(10.0, False), (30.0, True)])
def test_a_box_is_knocked_over_beyond_its_balance(degrees: float, falls: bool) -> None:
    """40 mm wide and 100 mm high it balances on its edge at atan(40 / 100) = 21.8 degrees."""
    bodies = _made()
    _run(bodies, 1, 500, 0.0)
    half, lean = math.radians(degrees) / 2.0, math.radians(degrees)
    height = 0.05 * math.cos(lean) + 0.02 * math.sin(lean)
    bodies.put("part", Pose((0.0, 0.0, height + 1e-4), (0.0, math.sin(half), 0.0, math.cos(half))))
    _run(bodies, 501, 510, 0.0)
    assert tuple(toppled(bodies, 400 * _MS, ())) == (), "it may still right itself"
    _run(bodies, 511, 2500, 0.0)
    told = tuple(toppled(bodies, 400 * _MS, ()))
    assert bool(told) == falls
    assert all(line.startswith("knocked over: part leans by 90 deg, ") for line in told)
    assert tuple(toppled(bodies, 400 * _MS, ("part",))) == ()
