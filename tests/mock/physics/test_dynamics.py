"""Bodies by hand: parts that fall, lie and slide, drives that are led ahead, and states that are computed in vain."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.contract.transforms import Pose
from cellc.mock.errors import MockError
from cellc.mock.physics.dynamics import Dynamics
from cellc.robot.physics.scene import Scene, SceneError

_SCENE = """<mujoco><option timestep="0.001" integrator="implicitfast"/><worldbody>
<body name="floor"><geom type="box" size="2 2 0.05" pos="0 0 -0.05"/></body>
<body name="arm" pos="0 0 1"><joint name="turn" type="hinge" axis="0 1 0"/>
<inertial pos="0.2 0 0" mass="1" diaginertia="0.01 0.01 0.01"/></body>
<body name="part" pos="0 0 3"><freejoint/><geom type="box" size="0.05 0.05 0.05" mass="0.2"/></body>
</worldbody><actuator><position name="turn" joint="turn" kp="300" kv="30"/></actuator></mujoco>"""
_FLAT = (0.0, 0.0, 0.0, 1.0)
_MS = 1_000_000


def _made(**leads_s: float) -> Dynamics:
    return Dynamics(Scene(_SCENE, {}), frozenset({frozenset({"part", "floor"})}), {}, leads_s)


def _run(bodies: Dynamics, until_ms: int, target: float = 0.0, first_ms: int = 1) -> None:
    times = np.arange(first_ms, until_ms + 1, dtype=np.int64) * _MS
    bodies.aim(["turn"], np.full((len(times), 1), target))
    bodies.advance(times)
    bodies.commit(len(times))


def test_a_part_falls_and_lies() -> None:
    """z = 3 - 9.81 / 2 * 0.5^2 = 1.774 m after half a second, then it lies at half its height of 0.1 m."""
    bodies = _made()
    _run(bodies, 500)
    assert bodies.pose("part", 500 * _MS).position[2] == pytest.approx(1.774, abs=0.003)
    _run(bodies, 3000, first_ms=501)
    assert bodies.pose("part", 3000 * _MS).position[2] == pytest.approx(0.05, abs=0.001)
    assert bodies.pose("part", 500 * _MS).position[2] == pytest.approx(1.774, abs=0.003), "where it was is kept"
    pressed = [touch for touch in bodies.touches() if {touch.one, touch.other} == {"part", "floor"}]
    assert sum(touch.force_n for touch in pressed) == pytest.approx(0.2 * 9.81, rel=0.01)
    assert bodies.seen == [], "it may touch the floor"


def test_a_drive_hangs_through_by_the_weight_over_its_stiffness() -> None:
    """1 kg at 0.2 m weighs 1.962 N m about the joint, which 300 N m/rad holds at 6.54 mrad."""
    bodies = _made()
    _run(bodies, 3000)
    assert bodies.standing(["turn"])[0] == pytest.approx(1.962 / 300.0, rel=0.01)


def test_what_was_computed_in_vain_changes_nothing() -> None:
    one, other = _made(), _made()
    _run(one, 200, 0.3)
    other.aim(["turn"], np.full((500, 1), -0.8))
    other.advance(np.arange(1, 501, dtype=np.int64) * _MS)
    _run(other, 120, 0.3)
    _run(other, 200, 0.3, first_ms=121)
    assert one.standing(["turn"]).tolist() == other.standing(["turn"]).tolist()
    assert one.pose("part", 200 * _MS) == other.pose("part", 200 * _MS)


def test_a_drive_that_brakes_its_error_alone_is_led_ahead() -> None:
    """30 N m s/rad over 300 N m/rad is 0.1 s: at 0.5 rad/s a joint that is not led stays 50 mrad behind."""
    behind = []
    for lead_s in (0.0, 0.1):
        bodies = _made(turn=lead_s) if lead_s else _made()
        times = np.arange(1, 2001, dtype=np.int64) * _MS
        bodies.aim(["turn"], (times / 1e9 * 0.5)[:, None])
        bodies.advance(times)
        bodies.commit(len(times))
        weight = 1.962 * np.cos(bodies.standing(["turn"])[0]) / 300.0
        behind.append(1.0 + weight - bodies.standing(["turn"])[0])
    assert behind == [pytest.approx(0.05, abs=0.001), pytest.approx(0.0, abs=0.001)]


def test_a_part_is_gone_and_seen_where_it_was_and_comes_back() -> None:
    bodies = _made()
    bodies.put("part", Pose((1.0, 0.0, 0.05), _FLAT))
    bodies.miss("part", missing=True)
    _run(bodies, 100)
    assert bodies.touches() == ()
    assert bodies.pose("part", 100 * _MS).position == (1.0, 0.0, 0.05)
    bodies.miss("part", missing=False)
    _run(bodies, 600, first_ms=101)
    assert bodies.pose("part", 600 * _MS).position[2] == pytest.approx(0.05, abs=0.001)
    assert bodies.touches()


def test_a_wider_part_lies_lower_no_more_than_it_is_high() -> None:
    bodies = _made()
    bodies.reshape("part", wider_m=0.02)
    bodies.put("part", Pose((0.0, 0.0, 0.06), (0.0, 0.7071067811865476, 0.0, 0.7071067811865476)))
    _run(bodies, 500)
    assert bodies.pose("part", 500 * _MS).position[2] == pytest.approx(0.06, abs=0.001), "on its side, 120 mm wide"


def test_numbers_that_are_none_end_the_run_with_a_reason() -> None:
    bodies = _made()
    bodies.aim(["turn"], np.full((1, 1), np.nan))
    with pytest.raises(MockError, match="does not stay in one piece"):
        bodies.advance(np.array([_MS], dtype=np.int64))


def test_a_scene_that_mujoco_refuses_is_told() -> None:
    with pytest.raises(SceneError, match="MuJoCo refuses it: XML Error"):
        Scene("<mujoco><nothing/></mujoco>", {})
