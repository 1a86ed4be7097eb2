"""A bar of 2 kg, whose center is 0.25 m from its joint, behind a spring: worked out by hand."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from cellc.contract.control_law import ControlLaw, JointLaw, LinkMass
from cellc.contract.vocabulary import Gravity, Loop
from cellc.mock.control.hardware.spring_joints import SpringJoints
from cellc.robot.planning import Load, RobotModel, Springs
from tests.cells import ROOT

PERIOD_S = 0.001
BAR = RobotModel.from_urdf((ROOT / "tests/corpus/invalid/base/soft_bar/soft_bar.urdf").read_text(encoding="utf-8"))
MOMENT = 2.0 * 9.81 * 0.25
STIFFNESS, DAMPING = 400.0, 20.0
LAG_S = DAMPING / STIFFNESS
TURN = np.array([0])


def law(**more: float) -> ControlLaw:
    joint = JointLaw(stiffness=STIFFNESS, damping=DAMPING, **more)
    return ControlLaw(loop=Loop.SPRING, joints={"turn": joint}, lags=True)


def compensated(*, lags: bool) -> ControlLaw:
    part = LinkMass(link="bar", mass_kg=1.0, center=(0.25, 0.0, 0.0))
    joints = {"turn": JointLaw(stiffness=STIFFNESS, damping=DAMPING)}
    return ControlLaw(loop=Loop.SPRING, joints=joints, lags=lags, gravity=Gravity.COMPENSATED, part=part)


def follower(one: ControlLaw, at: float = 0.0) -> SpringJoints:
    return SpringJoints(one, Springs(one, BAR), ("turn",), np.array([at]))


def taken(joints: SpringJoints, commands: Sequence[float], *, first: int = 0) -> list[float]:
    values = np.array(commands)[:, None]
    joints.follow(TURN, values, first, PERIOD_S)
    joints.commit(len(commands))
    return [float(value) for value in values[:, 0]]


def at_rest(command: float, moment: float = MOMENT) -> float:
    """Return where the bar balances: it hangs to the positive side."""
    at = command
    for _ in range(50):
        at = command + moment * math.cos(at) / STIFFNESS
    return at


def test_bar_comes_to_rest_below_its_command() -> None:
    joints = follower(law())
    assert taken(joints, [0.3] * 2000)[-1] == pytest.approx(at_rest(0.3), abs=1e-9)
    assert at_rest(0.3) - 0.3 == pytest.approx(0.0117, rel=0.01)
    assert joints.settled


def test_joint_is_63_percent_of_its_way_after_its_lag() -> None:
    way = taken(follower(compensated(lags=True)), [0.5] * 400)
    assert way[round(LAG_S / PERIOD_S) - 1] / 0.5 == pytest.approx(1.0 - math.exp(-1.0), rel=0.01)


@pytest.mark.parametrize(("lags", "behind"), [(True, 0.4 * LAG_S), (False, 0.0)])
def test_joint_is_behind_a_ramp_where_damping_brakes_its_motion_alone(lags: bool, behind: float) -> None:
    ramp = [0.4 * PERIOD_S * cycle for cycle in range(1, 1001)]
    assert ramp[-1] - taken(follower(compensated(lags=lags)), ramp)[-1] == pytest.approx(behind, abs=1e-6)


def test_command_that_jumps_takes_no_joint_along() -> None:
    assert taken(follower(compensated(lags=False)), [0.2])[0] < 0.01


def test_hold_of_where_it_is_lets_the_bar_sink_by_the_same_again() -> None:
    joints = follower(law())
    here = taken(joints, [0.0] * 1000)[-1]
    assert taken(joints, [here] * 1000, first=1000)[-1] - here == pytest.approx(here, rel=1e-3)


def test_integral_takes_half_of_the_weight_where_it_may_take_no_more() -> None:
    joints = follower(law(integral=400.0, integral_most=MOMENT / 2.0))
    assert taken(joints, [0.0] * 8000)[-1] == pytest.approx(at_rest(0.0) / 2.0, rel=1e-3)


@pytest.mark.parametrize("cuts", [(1,) * 700, (7, 64, 129, 500), (350, 350)])
@pytest.mark.parametrize("one", [law(), law(integral=50.0), compensated(lags=False)])
def test_cycles_are_the_same_to_the_last_bit_however_they_are_cut(one: ControlLaw, cuts: tuple[int, ...]) -> None:
    commands = [*(0.5 * math.sin(cycle / 90.0) for cycle in range(300)), *(0.1 for _ in range(400))]
    whole, joints = taken(follower(one), commands), follower(one)
    found: list[float] = []
    for cut in cuts:
        found += taken(joints, commands[len(found) : len(found) + cut], first=len(found))
    assert found == whole


def test_cycles_that_were_computed_and_not_adopted_leave_no_trace() -> None:
    commands = [0.5 * math.sin(cycle / 90.0) for cycle in range(300)]
    whole, joints = taken(follower(law()), commands), follower(law())
    joints.follow(TURN, np.array(commands)[:200, None], 0, PERIOD_S)
    joints.commit(33)
    assert taken(joints, commands[33:], first=33) == whole[33:]


def test_weights_are_looked_up_once_in_10_ms_of_motion_and_never_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    joints, looks, efforts = follower(law()), list[None](), Springs.efforts

    def counted(springs: Springs, positions: np.ndarray) -> np.ndarray:
        looks.append(None)
        return efforts(springs, positions)

    monkeypatch.setattr(Springs, "efforts", counted)
    taken(joints, [0.001 * cycle for cycle in range(1000)])
    assert len(looks) == 100
    taken(joints, [1.0] * 2000, first=1000)
    assert joints.settled
    looks.clear()
    taken(joints, [1.0] * 2000, first=3000)
    assert looks == []


def test_part_that_is_taken_while_nothing_moves_lowers_the_bar() -> None:
    one = compensated(lags=False)
    joints = follower(one)
    assert taken(joints, [0.0] * 100)[-1] == 0.0
    joints.load(Springs(one, BAR, Load(holds=True)))
    assert taken(joints, [0.0] * 1000, first=100)[-1] == pytest.approx(at_rest(0.0, MOMENT / 2.0), abs=1e-9)


def test_joint_without_a_command_stays_where_it_is() -> None:
    joints = follower(law(), at=0.3)
    joints.follow(np.array([], dtype=np.intp), np.empty((10, 0)), 0, PERIOD_S)
    joints.commit(10)
    assert taken(joints, [0.3])[0] == pytest.approx(0.3, abs=1e-3)
