"""Real controllers' commands against limits: smooth while nothing interrupts, and every interruption is noted.

The goal is a rest-to-rest quintic of 0.2 rad in 1 s. By hand its largest velocity is 15/8 of the mean, its largest
acceleration 10/sqrt(3) rad/s2 a rad, its largest jerk 60 rad/s3 a rad; the limits stand a thousandth above.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import pytest

from cellc.contract.contract import Contract, ContractJointLimits
from cellc.contract.vocabulary import Distro
from cellc.mock import MockCell
from cellc.mock.campaign.limits import check_limits
from cellc.mock.control import ControllerManager, JointFault, TrajectoryGoal, TrajectoryPoint
from cellc.mock.control.journal import CommandSamples, Interruption
from tests.mock.control.arm_of_two import MS, run
from tests.mock.control.bench import Value, bench

DISTANCE = 0.2
LIMITS = ContractJointLimits(
    lower=-3.0,
    upper=3.0,
    velocity=1.001 * DISTANCE * 15 / 8,
    acceleration=1.001 * DISTANCE * 10 / math.sqrt(3),
    jerk=1.001 * DISTANCE * 60,
)


@pytest.fixture(scope="module")
def contract(cells: dict[str, MockCell]) -> Contract:
    """The contract of a real cell with the joints and limits of this one."""
    real = cells["fr3_hand"].contract
    manager = next(iter(real.managers.values()))
    arm = {"arm": manager.controllers["arm_trajectory"]}
    managers = {"control": manager.model_copy(update={"controllers": arm})}
    return real.model_copy(update={"managers": managers, "joint_limits": {"a": LIMITS, "b": LIMITS}})


@dataclass(frozen=True)
class Journal:
    """What the journal of a manager held."""

    samples: tuple[CommandSamples, ...]
    interruptions: tuple[Interruption, ...]

    @property
    def causes(self) -> list[str]:
        return [each.cause.value for each in self.interruptions]


def goal(distance: float = DISTANCE, duration_ns: int = 1000 * MS) -> TrajectoryGoal:
    end = TrajectoryPoint((distance, 0.0), (0.0, 0.0), (0.0, 0.0), time_from_start_ns=duration_ns)
    return TrajectoryGoal(("a", "b"), (end,))


def journal_of(
    happens: Callable[[ControllerManager, int], None],
    arm: dict[str, Value] | None = None,
    distro: Distro = Distro.KILTED,
) -> Journal:
    """Send the goal, let something happen 400 ms later, and read the journal."""
    manager = bench(arm, distro=distro)
    manager.journal.listening = True
    goal_id = manager.send_goal("arm", goal()).goal_id
    run(manager, 400 * MS)
    happens(manager, goal_id)
    run(manager, 3500 * MS)
    return Journal(*manager.journal.take())


def nothing(manager: ControllerManager, goal_id: int) -> None:
    pass


def cancel(manager: ControllerManager, goal_id: int) -> None:
    manager.cancel_goal(goal_id)


def replace(manager: ControllerManager, goal_id: int) -> None:
    manager.send_goal("arm", goal(0.0, 3000 * MS))


def stick(manager: ControllerManager, goal_id: int) -> None:
    manager.disturbances.disturb("a", JointFault(stuck=True))


def scale(manager: ControllerManager, goal_id: int) -> None:
    manager.publish_speed_scaling("arm", 0.5)


def miss(manager: ControllerManager, goal_id: int) -> None:
    manager.disturbances.skip_cycles(7)


def displace(manager: ControllerManager, goal_id: int) -> None:
    run(manager, 800 * MS)
    manager.disturbances.disturb("a", JointFault(offset=0.05))
    run(manager, 100 * MS)
    manager.send_goal("arm", goal(0.25))


def test_goal_that_nothing_interrupts_is_within_limits_and_notes_nothing(contract: Contract) -> None:
    journal = journal_of(nothing)
    assert journal.causes == []
    report = check_limits(contract, journal.samples, ())
    assert report.held
    peaks = report.peaks
    assert [peak.quantity for peak in peaks] == ["velocity", "acceleration", "jerk"]
    assert all(peak.share == pytest.approx(1 / 1.001, abs=0.02) for peak in peaks)


def test_missed_cycles_are_no_excess_and_no_interruption(contract: Contract) -> None:
    journal = journal_of(miss, distro=Distro.JAZZY)  # which does not limit commands: no catching up
    assert journal.causes == []
    assert check_limits(contract, journal.samples, ()).held


@pytest.mark.parametrize(
    ("happens", "arm", "causes"),
    [
        (cancel, None, ["hold"]),
        (
            cancel,
            {
                "constraints.decelerate_on_cancel": True,
                "constraints.a.max_deceleration_on_cancel": 1.0,
                "constraints.b.max_deceleration_on_cancel": 1.0,
            },
            ["deceleration"],
        ),
        (replace, None, ["replaced"]),
        (stick, {"constraints.a.trajectory": 0.02}, ["unwritten", "hold"]),
        (scale, None, ["scaling"]),
        (displace, None, ["off_command", "unwritten", "hold"]),
    ],
)
def test_interruption_is_noted_and_explains_every_excess(
    contract: Contract,
    happens: Callable[[ControllerManager, int], None],
    arm: dict[str, Value] | None,
    causes: list[str],
) -> None:
    journal = journal_of(happens, arm, distro=Distro.JAZZY)
    assert journal.causes == causes
    assert not check_limits(contract, journal.samples, ()).held
    assert check_limits(contract, journal.samples, journal.interruptions).held


def test_journal_keeps_nothing_while_nobody_listens() -> None:
    manager = bench()
    manager.send_goal("arm", goal())
    run(manager, 500 * MS)
    assert manager.journal.take() == ((), ())
