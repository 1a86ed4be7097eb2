"""A cell whose arm is driven by its own library: compiled, brought up and rehearsed through the adapter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from cellc.contract.adapter import Phase
from cellc.contract.devices import ContractSimulatedJoint
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.mock import MockCell, RehearsalResult, load
from cellc.mock.adapter.server import AdapterServer
from cellc.mock.campaign.campaign import execute
from cellc.mock.campaign.limits import check_limits
from cellc.mock.campaign.plan import CampaignRun
from cellc.mock.cell import cell_of
from cellc.mock.control import GripperGoal, JointFault, TrajectoryGoal, TrajectoryPoint
from cellc.mock.control.journal import CommandJournal
from cellc.mock.faults.registry import possible_faults
from cellc.mock.plant import Plant
from tests.cells import CORPUS, ROOT, build_into

SECOND = 1_000_000_000
REACH = tuple(StepEntry(kind=StepKind.MOVE, target=pose) for pose in ("home", "aside", "home"))


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> MockCell:
    """The cell, compiled and loaded."""
    return load(build_into(tmp_path_factory.mktemp("generated") / "demo", CORPUS / "valid" / "direct_sdk_arm.yaml"))


def run(
    cell: MockCell,
    *faults: FaultEntry,
    steps: tuple[StepEntry, ...] = REACH,
    at_s: float = 1.0,
    action: Callable[[Plant], None] | None = None,
) -> tuple[RehearsalResult, Plant]:
    """Rehearse the reach; ``action`` happens at a simulated time after the bring-up began."""
    plants: list[Plant] = []

    def watch(plant: Plant) -> None:
        plants.append(plant)
        if action is not None:
            plant.simulation.at(round(at_s * 1e9), lambda: action(plant))

    entry = RehearsalEntry(name="reach", steps=steps, faults=faults, expect="succeeded", within_s=None, timeout_s=60.0)
    return cell.rehearse(entry, watch=watch), plants[0]


def test_cell_states_the_contract_of_the_adapter(cell: MockCell) -> None:
    adapter = cell.contract.adapters["arm"]
    assert (adapter.command_period_s, adapter.command_timeout_s, adapter.stop_time_s) == (0.004, 0.04, 0.1)
    assert adapter.units == ("rad",) * 6
    assert adapter.action == "/arm/follow_joint_trajectory"
    assert adapter.client == "move_group"
    assert cell.contract.groups["manipulator"].controller == "arm"
    assert cell.contract.devices["arm"].hardware_component is None


def test_rehearsal_succeeds_and_ends_where_it_was_sent(cell: MockCell) -> None:
    result, plant = run(cell)
    assert result.outcome == "succeeded", result
    home = cell.contract.poses["home"][0].positions
    assert plant.control.adapters["arm"].adapter.read().positions == pytest.approx(home, abs=1e-6)


def test_bring_up_connects_before_it_observes_and_activates_last(cell: MockCell) -> None:
    result, _ = run(cell)
    facts = {stage.stage: stage.facts for stage in result.bringup}
    assert "the adapter of `arm` is connected and inactive" in facts["configure"]
    assert "the adapter of `arm` is active, for only `move_group`" in facts["claim"]


def test_no_command_is_faster_than_the_limits_of_the_cell(cell: MockCell) -> None:
    _, plant = run(cell)
    history = plant.control.histories[("arm", "arm")]
    limits = [cell.contract.joint_limits[name].velocity for name in history.names]
    seconds = (history.stamps[1:] - history.stamps[:-1]) / 1e9
    speeds = abs(history.positions[1:] - history.positions[:-1]) / seconds[:, None]
    assert (speeds.max(axis=0) <= [limit * 1.001 for limit in limits]).all()
    assert speeds.max() > 0.1  # it did move


def test_cancel_holds_the_arm_within_its_stop_time(cell: MockCell) -> None:
    result, _ = run(cell, FaultEntry(kind="cancel", target="move", at_s=0.6))
    assert result.outcome == "canceled"
    cancel = result.attempts[-2].cancel
    assert cancel is not None
    assert cancel.latency_s is not None
    assert 0.0 < cancel.latency_s <= 0.1 + 0.004


def test_stop_by_the_vendor_ends_the_rehearsal_as_a_protective_stop(cell: MockCell) -> None:
    result, plant = run(cell, action=lambda plant: plant.control.adapters["arm"].adapter.trip("torque limit"))
    assert result.outcome == "protective_stop"
    assert plant.control.adapters["arm"].adapter.read().phase is Phase.STOPPED


def test_arm_that_sticks_is_a_tolerance_violation(cell: MockCell) -> None:
    joint = cell.contract.adapters["arm"].joints[0]
    result, _ = run(cell, FaultEntry(kind="stick", target=joint, at_s=0.5))
    assert result.outcome == "tolerance_violation"
    assert "away from its command" in result.attempts[-2].fault_code


@pytest.mark.parametrize(("kind", "changes"), [("slow", {"velocity": 0.01}), ("displace", {"displacement": 0.2})])
def test_joint_that_is_slow_or_displaced_is_a_tolerance_violation(
    cell: MockCell, kind: FaultKind, changes: dict[str, float]
) -> None:
    fault = FaultEntry(kind=kind, target=cell.contract.adapters["arm"].joints[0], at_s=0.5, **changes)
    result, _ = run(cell, fault)
    assert result.outcome == "tolerance_violation"
    assert "away from its command" in result.attempts[-2].fault_code


def test_displaced_joint_moves_at_once_and_back_when_that_is_over(cell: MockCell) -> None:
    joint = cell.contract.adapters["arm"].joints[1]
    still = (StepEntry(kind=StepKind.WAIT, target="", duration_s=1.0),)
    _, plant = run(
        cell, FaultEntry(kind="displace", target=joint, at_s=0.2, displacement=0.2, lasting_s=0.4), steps=still
    )
    history = plant.control.histories[("arm", "arm")]
    column = history.positions[:, history.names.index(joint)]
    assert column.max() - column[0] == pytest.approx(0.2, abs=1e-12)
    assert column[-1] == pytest.approx(column[0], abs=1e-12)


STOPS: tuple[tuple[FaultKind, str], ...] = (
    (FaultKind.PROTECTIVE_STOP, "protective_stop"),
    (FaultKind.EMERGENCY_STOP, "emergency_stop"),
    (FaultKind.WRONG_PAYLOAD, "protective_stop"),
)


@pytest.mark.parametrize(("kind", "outcome"), STOPS)
def test_stop_of_the_device_has_its_own_outcome_and_lasts_until_it_is_acknowledged(
    cell: MockCell, kind: FaultKind, outcome: str
) -> None:
    acknowledge = StepEntry(kind=StepKind.ACKNOWLEDGE, target=cell.contract.safety.acknowledge)
    steps = (*REACH[:2], StepEntry(kind=StepKind.WAIT, target="", duration_s=2.0), REACH[0], acknowledge, *REACH)
    result, plant = run(cell, FaultEntry(kind=kind, target="arm", at_s=0.5, lasting_s=1.0), steps=steps)
    outcomes = [record.outcome for record in result.attempts[: len(steps)]]
    assert outcomes == ["succeeded", outcome, "succeeded", outcome, *["succeeded"] * 4]
    stopped, refused = result.attempts[1], result.attempts[3]
    assert (stopped.action_goal_id is None, refused.action_goal_id) == (False, None)
    assert plant.control.adapters["arm"].adapter.phase is Phase.ACTIVE


def test_runs_are_the_same_to_the_last_bit(cell: MockCell) -> None:
    assert run(cell)[0] == run(cell)[0]


def test_goals_that_no_command_may_follow_are_rejected_with_the_reason(cell: MockCell) -> None:
    answers: dict[str, str] = {}

    def ask(plant: Plant) -> None:
        server = plant.control.adapters["arm"]
        names, zero = server.adapter.model.joint_names, (0.0,) * 6
        far = tuple(position + 1.0 for position in server.adapter.read().positions)

        def goal(duration_s: float, names: tuple[str, ...] = names, **changes: tuple[float, ...]) -> TrajectoryGoal:
            fields = {"positions": far, "velocities": zero, "accelerations": zero} | changes
            point = TrajectoryPoint(time_from_start_ns=round(duration_s * 1e9), **fields)
            return TrajectoryGoal(names, (point,))

        goals: dict[str, TrajectoryGoal | GripperGoal] = {
            "fast": goal(0.1),
            "incomplete": goal(5.0, names=names[:5]),
            "bare": goal(5.0, velocities=()),
            "elsewhere": goal(0.0),
            "gripper": GripperGoal((0.0,)),
        }
        for title, each in goals.items():
            response = server.send_goal("arm", each)
            assert not response.accepted
            answers[title] = response.log_reason

    run(cell, at_s=0.53, action=ask)
    assert "rad/s allowed" in answers["fast"]
    assert "moves all of its joints" in answers["incomplete"]
    assert answers["bare"] == "a point lacks positions, velocities or accelerations"
    assert answers["elsewhere"] == "the trajectory begins 1 away from where the joints stand"
    assert answers["gripper"] == "`arm` takes trajectories only"


def test_periods_that_the_adapter_misses_are_missed_cycles_and_trip_its_watchdog(cell: MockCell) -> None:
    # 20 periods of 4 ms are twice what the watchdog allows.
    result, plant = run(cell, FaultEntry(kind="skip_cycles", target="", at_s=0.4, cycles=20))
    assert result.outcome in ("missed_cycle", "protective_stop")
    state = plant.control.adapters["arm"].adapter.read()
    assert (state.phase, state.fault) == (Phase.STOPPED, "no command within the watchdog's time")


def test_commands_are_held_to_the_limits_of_the_cell(cell: MockCell) -> None:
    entry = RehearsalEntry(name="reach", steps=REACH, faults=(), expect="succeeded", within_s=None, timeout_s=60.0)
    report = execute(cell, CampaignRun.undisturbed(entry), 0).limits
    # A motion of 40 degrees on the quickest profile comes to its limits of acceleration and jerk.
    shares = {peak.quantity: peak.share for peak in report.peaks}
    assert [shares["acceleration"], shares["jerk"]] == pytest.approx([1.0, 1.0], abs=1e-3)
    assert (report.held, report.steps, report.unchecked) == (True, (), ())


def test_command_beyond_a_limit_is_an_excess_of_the_device(cell: MockCell) -> None:
    joint = cell.contract.adapters["arm"].joints[0]
    halved = cell.contract.joint_limits[joint].model_copy(update={"jerk": cell.contract.joint_limits[joint].jerk / 2})
    contract = cell.contract.model_copy(update={"joint_limits": {**cell.contract.joint_limits, joint: halved}})
    journals: list[CommandJournal] = []

    def listen(plant: Plant) -> None:
        journals.append(plant.control.adapters["arm"].journal)
        journals[0].listening = True

    entry = RehearsalEntry(name="reach", steps=REACH, faults=(), expect="succeeded", within_s=None, timeout_s=60.0)
    cell.rehearse(entry, watch=listen)
    (excess,) = check_limits(contract, *journals[0].take()).excesses
    assert (excess.controller, excess.joint, excess.quantity) == ("arm", joint, "jerk")


def test_every_fault_at_every_step_ends_in_a_named_outcome(cell: MockCell) -> None:
    cases = possible_faults(cell.contract)
    kinds = {case.entry.kind for case in cases}
    assert {"stick", "slow", "displace", "freeze", "wrong_payload", "protective_stop", "emergency_stop"} <= kinds
    for case in cases:
        outcomes = case.outcomes(REACH, 2)
        entry = RehearsalEntry(
            name="reach", steps=REACH, faults=(case.at(2),), expect="succeeded", within_s=None, timeout_s=60.0
        )
        assert cell.rehearse(entry).outcome in outcomes, case.name


def test_a_campaign_expects_the_stop_of_a_watchdog_that_waits_less_than_the_missed_cycles_last() -> None:
    # Five cycles beyond none, of 4 ms: the next command is 24 ms after the last, the watchdog waits 20 ms.
    loop = load(ROOT / "generated/hybrid_sdk")
    (case,) = (fault for fault in possible_faults(loop.contract) if fault.entry.kind == "skip_cycles")
    named = {outcome for ending in case.endings.values() for outcome in ending.outcomes}
    assert {"missed_cycle", "protective_stop"} <= named


@pytest.mark.parametrize(("off", "noted"), [(0.0, []), (1e-10, []), (0.001, [1_000_000_001])])
def test_start_beside_the_last_command_is_noted_an_instant_after_it(
    cell: MockCell, off: float, noted: list[int]
) -> None:
    contract = cell.contract
    server = AdapterServer("arm", contract.adapters["arm"], contract.joint_limits, "host")
    server.adapter.connect()
    server.adapter.activate()
    assert server.advance(SECOND) == SECOND
    server.journal.listening = True
    server.adapter.disturb(contract.adapters["arm"].joints[0], JointFault(offset=off))
    zeros, start = (0.0,) * 6, server.adapter.read().positions
    points = tuple(TrajectoryPoint(start, zeros, zeros, time_from_start_ns=at_ns) for at_ns in (0, SECOND))
    goal = TrajectoryGoal(contract.adapters["arm"].joints, points)
    response = server.send_goal("arm", goal)
    assert response.accepted, response.log_reason
    _, interruptions = server.journal.take()
    # What was commanded at the same instant is no jump: it becomes one with the next command.
    assert [interruption.stamp_ns for interruption in interruptions] == noted


def test_joint_behind_an_adapter_is_measured_with_the_noise_that_the_spec_states(cell: MockCell) -> None:
    joint = cell.contract.adapters["arm"].joints[0]
    stated = {joint: ContractSimulatedJoint(noise=1e-4)}
    facts = cell.contract.model_copy(update={"simulated_joints": stated})
    result, plant = run(cell_of(replace(cell.folder, contract=facts)))
    assert result.outcome == "succeeded"
    server = plant.control.adapters["arm"]
    server.take_joint_states()
    server.advance(server.now_ns + SECOND)
    block = server.take_joint_states()
    column = block.names.index(joint)
    measured, others = block.positions[:, column], np.delete(block.positions, column, axis=1)
    assert not np.ptp(others, axis=0).any()
    # Evenly distributed noise of 0.1 mrad has a standard deviation of 0.1/sqrt(3) mrad.
    assert measured.std() == pytest.approx(1e-4 / 3**0.5, rel=0.1)
