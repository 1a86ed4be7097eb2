"""Droop, overshoot, stopping distance, contacts and a part that topples, by the textbook: an oscillator, a box."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from cellc.contract.transforms import Pose
from cellc.mock.physics.contacts import Contacts
from cellc.mock.physics.dynamics import Dynamics
from cellc.mock.physics.motions import Motion, drooping, motions, passing, stopping, toppled, unsupported
from cellc.mock.physics.off_plan import off_plan
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


def _off(bodies: Dynamics, path: float, goal: float) -> list[str]:
    tolerances = [dict.fromkeys(("along", "up"), value) for value in (path, goal)]
    return list(off_plan(bodies, [("move: there", 2900 * _MS, 11000 * _MS)], *tolerances))


def test_a_motion_that_succeeds_is_named_where_it_comes_near_a_bound() -> None:
    """A step of 100 mm is a path error of all of it, less what one cycle brings, and passed by 52.7 mm."""
    bodies = _made()
    _run(bodies, 1, 3000, 0.0)
    _run(bodies, 3001, 11000, 0.1)
    first = "path error: joint along is 100 mm from its command in `move: there`, at 3.001 s; "
    passed = "overshoot: joint along passes its end by 52.7 mm in `move: there`; its goal tolerance is "
    assert _off(bodies, 0.15, 0.05) == [f"{first}150 mm would end its goal", f"{passed}50 mm"]
    assert _off(bodies, 0.25, 0.06) == []


@pytest.mark.parametrize(("above_mm", "way"), [(0.0, ""), (30.0, "down: floats above"), (-4.0, "up: sinks into")])
def test_a_part_that_floats_or_sinks_is_named(above_mm: float, way: str) -> None:
    bodies = _made()
    bodies.put("part", Pose((0.0, 0.0, 0.05 + above_mm * 1e-3), (0.0, 0.0, 0.0, 1.0)))
    _run(bodies, 1, 500, 0.0)
    found = list(unsupported(bodies))
    if not way:
        assert found == []
        return
    (told,) = (
        re.fullmatch(r"support: part moves (\S+) mm (\w+) as time begins: .* it (\w+ \w+) what is below it", line)
        for line in found
    )
    assert told is not None, found
    assert float(told[1]) == pytest.approx(abs(above_mm), abs=0.2)
    assert f"{told[2]}: {told[3]}" == way


def test_contacts_have_the_largest_force_of_all_points_together_and_its_instant() -> None:
    """At rest the four corners of the box carry its weight of 0.2 kg; dropped by 50 mm it presses harder once."""
    bodies = _made()
    _run(bodies, 1, 1000, 0.0)
    bodies.contacts.begin()
    _run(bodies, 1001, 1500, 0.0)
    (rests,) = bodies.contacts
    assert (rests.one, rests.other) == ("floor", "part")
    assert rests.most_n == pytest.approx(0.2 * 9.81, rel=1e-3)
    bodies.put("part", Pose((0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0)))
    bodies.contacts.begin()
    _run(bodies, 1501, 2500, 0.0)
    (hits,) = bodies.contacts
    assert hits.most_n > 5.0 * rests.most_n
    # It falls 50 mm in sqrt(2 * 0.05 / 9.81) = 101 ms, and is stopped within some ms.
    assert 1.590 <= hits.at_ns / 1e9 <= 1.620


def test_contacts_are_added_up_by_cycle_whatever_the_order_of_their_points() -> None:
    contacts = Contacts(("world", "a", "b"))
    pairs: list[list[list[int]]] = [[[0, 1], [1, 2], [0, 1]], [], [[0, 1], [1, 2]]]
    forces: list[list[float]] = [[1.0, 5.0, 3.0], [], [3.5, 6.0]]
    pressing = [
        (np.array(rows, dtype=np.intp).reshape(-1, 2), np.array(each)) for rows, each in zip(pairs, forces, strict=True)
    ]
    contacts.add(np.array([10, 20, 30]), pressing)
    found = [(each.one, each.other, each.most_n, each.at_ns) for each in contacts]
    assert found == [("a", "b", 6.0, 30), ("world", "a", 4.0, 10)]
