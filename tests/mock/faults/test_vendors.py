"""What each vendor's driver leaves behind at a stop, who hears of it, and what moves once it is over.

From the sources: a UR keeps component, claim and goal alive and scales the speed to 0 (Universal_Robots_ROS2_Driver
3.8.0, hardware_interface.cpp:826-847, doc/robot_state_helper.rst); an FR3 becomes unconfigured with the next read
(franka_ros2 3.4.0, franka_hardware_interface.cpp:249-258); a Gen3 sends nothing while a fault lasts, and its
controllers run on (ros2_kortex 945324f, hardware_interface.cpp:793); an OpenArm and a 2F-85 report nothing.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from cellc.mock.faults.registry import possible_faults
from cellc.mock.plant import Plant
from tests.cells import generated
from tests.mock.faults.conftest import ACKNOWLEDGE, DETECT, HOME, PICK, Rehearse, Run, during, wait

WRIST = "arm_wrist_3_joint"
RESUMED = (HOME, DETECT, PICK, wait(3.0), ACKNOWLEDGE, HOME)
STOPS = [FaultKind.PROTECTIVE_STOP, FaultKind.SAFEGUARD_STOP, FaultKind.EMERGENCY_STOP, FaultKind.PROGRAM_PAUSE]


def second_step(after_s: float) -> FaultEvent:
    """Return a time after the begin of the second step."""
    return FaultEvent(step=2, when="started", after_s=after_s)


@cache
def loaded(name: str) -> MockCell:
    """Return a cell of the repository."""
    return load(generated(name))


def of(name: str, *faults: FaultEntry, steps: tuple[StepEntry, ...] = (), watched: bool = True) -> Run:
    """Run the first rehearsal of a cell, or other steps, with faults; or without the watches of its plan."""
    cell = loaded(name) if watched else cell_of(replace(loaded(name).folder, watches=()))
    plain = next(entry for entry in cell.entries if not entry.faults)
    changes = {"faults": faults, "steps": steps or plain.steps, "name": "vendor"}
    entry: RehearsalEntry = plain.model_copy(update=changes)
    plants: list[Plant] = []
    result = cell.rehearse(entry, watch=plants.append)
    return Run(result, plants[0])


def component(run: Run, name: str) -> str:
    """Return the state of a hardware component at the end of a run."""
    listed = [
        component for each in run.plant.control.managers.values() for component in each.list_hardware_components()
    ]
    return next(entry.state for entry in listed if entry.name == name)


@pytest.mark.parametrize("kind", STOPS)
def test_a_stop_that_is_resumed_moves_nothing_before_it_is_acknowledged(run: Rehearse, kind: FaultKind) -> None:
    done = run(during(3, kind, "arm", lasting_s=1.0), steps=RESUMED)
    stopped, waited, acknowledged = done.attempt(3), done.attempt(4), done.attempt(5)
    assert stopped.outcome in ("protective_stop", "emergency_stop", "claim_failure")
    assert done.result.outcome == "succeeded"
    assert component(done, "arm_hardware") == "active"
    # The stop is met 0.1 s after it began, when the arm stands; it is over 1 s later, and acknowledged 2 s after that.
    assert done.travel(stopped.ended_ns, acknowledged.started_ns) == 0.0
    assert waited.ended_ns - waited.started_ns == 3_000_000_000
    assert done.plant.effects.motions == []


@pytest.mark.parametrize("kind", STOPS)
def test_without_its_watch_the_arm_goes_on_and_the_run_says_so(kind: FaultKind) -> None:
    done = of("ur5e_pick", during(3, kind, "arm", lasting_s=1.0), steps=RESUMED, watched=False)
    assert done.result.outcome == "uncommanded_motion"
    assert "arm_trajectory continued after " in done.failed.fault_code
    assert done.failed.fault_code.endswith("and no person had acknowledged")


def test_a_goal_stands_still_while_the_speed_is_scaled_to_nothing_and_nobody_hears(run: Rehearse) -> None:
    done = of("ur5e_pick", during(3, FaultKind.PROGRAM_PAUSE, "arm"), watched=False)
    # Only the bound of the action ends it: the trajectory keeps its place.
    assert done.failed.outcome == "timeout"
    assert done.travel(done.plant.now_ns - 5_000_000_000, done.plant.now_ns) == 0.0


def test_a_stop_is_heard_as_late_as_the_plan_promises(cell: MockCell, run: Rehearse) -> None:
    (watch,) = cell.folder.watches
    done = run(during(3, FaultKind.PROTECTIVE_STOP, "arm"))
    assert done.result.response_s is not None
    assert watch.within_s <= done.result.response_s < watch.within_s + 0.05


def test_a_stop_that_is_over_before_it_is_acted_upon_is_remembered(run: Rehearse) -> None:
    # At rest, and resumed after 50 ms: nothing moves, but the claim goes, and only a person brings it back.
    stop = FaultEntry(kind=FaultKind.SAFEGUARD_STOP, target="arm", event=second_step(0.5), lasting_s=0.05)
    done = run(stop, steps=(HOME, wait(2.0), HOME))
    assert done.result.outcome == "protective_stop"
    assert component(done, "arm_hardware") == "active"


def test_a_stop_in_motion_that_is_shorter_than_the_delay_of_the_watch_is_motion_without_a_command(
    run: Rehearse,
) -> None:
    done = run(during(3, FaultKind.SAFEGUARD_STOP, "arm", lasting_s=0.02))
    assert done.result.outcome == "uncommanded_motion"


def jogged(*more: FaultEntry) -> tuple[FaultEntry, ...]:
    """Return a pause, in which the wrist is jogged by 0.1 rad, and what happens then."""
    pause = FaultEntry(kind=FaultKind.PROGRAM_PAUSE, target="arm", event=second_step(0.5), lasting_s=2.0)
    jog = FaultEntry(kind=FaultKind.JOG, target=WRIST, event=second_step(1.0), displacement=0.1)
    return (pause, jog, *more)


def test_an_arm_that_is_jogged_while_paused_jumps_back_however_far_as_its_program_compares_old_with_old(
    run: Rehearse,
) -> None:
    steps = (HOME, wait(5.0), ACKNOWLEDGE, HOME)
    for done in (run(*jogged(), steps=steps), of("ur5e_pick", *jogged(), steps=steps, watched=False)):
        assert done.result.outcome == "uncommanded_motion"
        (motion,) = done.plant.effects.motions
        # 0.1 rad is more than the 0.04 rad that a program which starts would follow.
        assert motion.joint == WRIST
        assert motion.distance == pytest.approx(0.1, abs=1e-6)


def test_a_program_that_is_stopped_and_started_from_its_beginning_follows_nothing_old(run: Rehearse) -> None:
    stop = FaultEntry(kind=FaultKind.PROGRAM_STOP, target="arm", event=second_step(1.8))
    start = FaultEntry(kind=FaultKind.PROGRAM_START, target="arm", event=second_step(2.6))
    done = run(*jogged(stop, start), steps=(HOME, wait(5.0), ACKNOWLEDGE, HOME))
    assert done.result.outcome == "succeeded"
    assert done.plant.effects.motions == []


def test_a_claim_that_somebody_takes_while_nobody_has_acknowledged_goes_again(
    cell: MockCell, plain: RehearsalEntry
) -> None:
    stop = FaultEntry(kind=FaultKind.PROTECTIVE_STOP, target="arm", event=second_step(0.5), lasting_s=0.5)
    states: list[str] = []

    def state(plant: Plant) -> str:
        (manager,) = plant.control.managers.values()
        return {controller.name: controller.state for controller in manager.list_controllers()}["arm_trajectory"]

    def claimed(plant: Plant) -> None:
        (manager,) = plant.control.managers.values()

        def claim() -> None:
            manager.switch_controllers(["arm_trajectory"], [])

        plant.simulation.at(3_000_000_000, claim)
        for now_ns in (2_990_000_000, 3_050_000_000, 3_200_000_000):
            plant.simulation.at(now_ns, lambda: states.append(state(plant)))

    steps = (HOME, wait(5.0), wait(4.0), ACKNOWLEDGE)
    cell.rehearse(plain.model_copy(update={"faults": (stop,), "steps": steps}), watch=claimed)
    assert states == ["inactive", "active", "inactive"]


# -- others -----------------------------------------------------------------------------------------------------------


def test_an_fr3_is_unconfigured_with_its_goal_aborted_and_nothing_resumes_it() -> None:
    done = of("fr3_hand", during(2, FaultKind.PROTECTIVE_STOP, "arm", lasting_s=0.5))
    assert (done.failed.outcome, component(done, "FrankaHardwareInterface")) == ("protective_stop", "unconfigured")
    assert done.failed.result is not None
    assert (done.failed.result.error_code, done.failed.result.status) == (-1, "aborted")
    assert done.result.response_s is not None
    assert done.result.response_s < 0.05  # the next cycle of its manager, not a message to a watch


def test_a_gen3_reports_a_fault_and_without_a_watch_its_trajectory_runs_on_and_the_arm_after_it() -> None:
    fault = during(2, FaultKind.PROTECTIVE_STOP, "arm", lasting_s=0.1)
    done = of("gen3_2f", during(2, FaultKind.PROTECTIVE_STOP, "arm"))
    assert (done.failed.outcome, done.failed.safety_state) == ("hardware_fault", "fault")
    assert component(done, "KortexMultiInterfaceHardware") == "active"
    unwatched = of("gen3_2f", fault, watched=False)
    assert unwatched.result.outcome == "uncommanded_motion"


def test_an_openarm_that_loses_its_supply_reports_nothing_and_its_goal_gets_nowhere() -> None:
    done = of("openarm_bimanual", during(2, FaultKind.EMERGENCY_STOP, "left"))
    assert (done.failed.outcome, done.failed.safety_state) == ("tolerance_violation", "normal")
    assert component(done, "openarm_left_hardware_interface") == "active"
    assert (
        "dangerous: `left` fell when it stopped; old joint states continue and do not show it" in done.result.findings
    )


def test_an_openarm_that_loses_its_supply_at_rest_shows_nothing_at_all() -> None:
    stop = FaultEntry(kind=FaultKind.EMERGENCY_STOP, target="left", event=second_step(0.5))
    hang = StepEntry(kind=StepKind.MOVE, target="hang")
    assert of("openarm_bimanual", stop, steps=(hang, wait(2.0))).result.outcome == "succeeded"


def test_a_gripper_without_power_reports_nothing_and_its_fingers_stand(run: Rehearse) -> None:
    done = run(during(4, FaultKind.PROTECTIVE_STOP, "gripper", when="started", after_s=0.0))
    assert (done.failed.step, done.failed.outcome) == ("grip close gripper", "tolerance_violation")
    assert (done.failed.safety_state, component(done, "gripper_hardware")) == ("normal", "active")


@pytest.mark.parametrize("kind", [FaultKind.EMERGENCY_STOP, FaultKind.SAFEGUARD_STOP])
def test_a_device_without_such_a_stop_has_no_case_of_it(cell: MockCell, kind: FaultKind) -> None:
    assert {case.entry.target for case in possible_faults(cell.contract) if case.entry.kind is kind} == {"arm"}


# -- links ------------------------------------------------------------------------------------------------------------


def test_a_ur_that_is_cut_off_stays_active_and_only_its_goal_shows_it(run: Rehearse) -> None:
    done = run(during(3, FaultKind.CUT_NETWORK, "arm"))
    assert (done.failed.outcome, done.failed.safety_state) == ("tolerance_violation", "normal")
    assert component(done, "arm_hardware") == "active"


def test_a_ur_that_was_cut_off_at_rest_says_so_as_it_is_connected_again_and_gives_its_claim_up(run: Rehearse) -> None:
    cut = FaultEntry(kind=FaultKind.CUT_NETWORK, target="arm", event=second_step(0.5), lasting_s=2.0)
    done = run(cut, steps=(HOME, wait(5.0)))
    assert done.failed.outcome == "claim_failure"
    assert done.failed.fault_code.endswith("the program of arm is not running")
    assert (done.failed.ended_ns - done.failed.started_ns) / 1e9 == pytest.approx(2.6, abs=0.05)  # not before 2.5 s


def test_an_fr3_that_is_cut_off_ends_its_driver() -> None:
    done = of("fr3_hand", during(2, FaultKind.CUT_NETWORK, "arm"))
    assert (done.failed.outcome, component(done, "FrankaHardwareInterface")) == ("hardware_fault", "unconfigured")


def test_an_openarm_that_is_connected_again_jumps_to_where_its_trajectory_is_by_then() -> None:
    done = of("openarm_bimanual", during(2, FaultKind.CUT_NETWORK, "left", lasting_s=0.1))
    assert done.result.outcome == "uncommanded_motion"
    assert "kept its set point while left followed none" in done.failed.fault_code
