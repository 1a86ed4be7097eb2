"""The bring-up of the real target, with devices that do what their vendors' drivers do as they come up.

What they do is told in the vendors' sources: the 2F-85 runs its fingers and holds its controller manager for seconds
(ros2_robotiq_gripper@3b6cf8f hardware_interface.cpp:220), a UR ends its program after 40 ms without set points, and an
FR3 with closed brakes ends the controller manager of humble and refuses the claim on jazzy.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract.bring_up import Activation, BringUpStep, HardwareActivation
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome, BringUpPhase, ManagerLock, Moment, Need, Unmet
from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from cellc.mock.folder import GeneratedFolder
from cellc.mock.plant import Plant
from cellc.mock.real_start import RealStart
from cellc.mock.result import RehearsalResult
from tests.cells import generated

STEPS = (StepEntry(kind=StepKind.MOVE, target="home"), StepEntry(kind="wait", target="", duration_s=1.0))
PLAIN = RehearsalEntry(
    name="real", steps=STEPS, faults=(), expect=AttemptOutcome.SUCCEEDED, timeout_s=60.0, bring_up="real"
)
BRAKES = FaultEntry(kind=FaultKind.BRAKES_CLOSED, target="arm", phase=BringUpPhase.CLAIM)
Change = Callable[[BringUpStep], BringUpStep]


@pytest.fixture(scope="module")
def ur5e() -> GeneratedFolder:
    """The folder of a UR5e with a 2F-85."""
    return load(generated("ur5e_pick")).folder


@pytest.fixture(scope="module")
def fr3() -> GeneratedFolder:
    """The folder of an FR3, on humble."""
    return load(generated("fr3_hand")).folder


def brought_up(folder: GeneratedFolder, *faults: FaultEntry) -> tuple[RehearsalResult, Plant]:
    """Bring a cell up as its real target would be."""
    plants: list[Plant] = []
    cell: MockCell = cell_of(folder)
    result = cell.rehearse(PLAIN.model_copy(update={"faults": faults}), watch=plants.append)
    return result, plants[0]


@pytest.mark.parametrize("kind", [None, FaultKind.PROGRAM_STOP, FaultKind.EMERGENCY_STOP, FaultKind.RESTART_DRIVER])
@pytest.mark.parametrize("phase", list(BringUpPhase)[:3])
def test_component_of_another_plugin_is_a_failed_bring_up(
    kind: FaultKind | None, phase: BringUpPhase, tmp_path: Path
) -> None:
    folder = tmp_path / "ur5e_pick"
    shutil.copytree(generated("ur5e_pick"), folder)
    urdf = folder / "urdf/ur5e_pick.mock.urdf"
    urdf.write_text(urdf.read_text().replace("mock_components/GenericSystem", "demo_simulation/Arm", 1))
    faults = () if kind is None else (FaultEntry(kind=kind, target="arm", phase=phase, lasting_s=1.0),)
    result, _ = brought_up(load(folder, edited=True).folder, *faults)
    assert result.outcome == "bringup_failure"
    assert "demo_simulation/Arm" in result.reason
    assert "(cellc executes mock_components/GenericSystem alone.)" in result.reason


def with_steps(folder: GeneratedFolder, change: Change) -> GeneratedFolder:
    """Return a folder whose real target has other steps."""
    return replace(folder, real_bring_up=tuple(map(change, folder.real_bring_up)))


def reason(result: RehearsalResult) -> str:
    """Return why a run failed, of its bring-up or of its first attempt that failed."""
    problems = [problem for stage in result.bringup for problem in stage.problems]
    return "; ".join(problems) or next(attempt.fault_code for attempt in result.attempts if attempt.fault_code)


def test_fingers_run_while_nothing_listens_and_hold_the_manager_for_seconds(ur5e: GeneratedFolder) -> None:
    result, plant = brought_up(ur5e)
    assert result.outcome == "succeeded", reason(result)
    assert plant.effects.motions == []
    (history,) = plant.control.histories.values()
    assert result.attempts[0].started_ns >= 3_000_000_000
    assert history.missed_until(plant.now_ns) == 0  # cycles before anybody was promised any count for nothing


def test_activation_in_the_first_phase_moves_where_nothing_may_move(ur5e: GeneratedFolder) -> None:
    def early(step: BringUpStep) -> BringUpStep:
        moved = isinstance(step.request, HardwareActivation)
        return step.model_copy(update={"phase": BringUpPhase.START}) if moved else step

    result, plant = brought_up(with_steps(ur5e, early))
    assert result.outcome == "uncommanded_motion"
    (motion,) = plant.effects.motions
    assert (motion.device, motion.joint) == ("gripper", "gripper_robotiq_85_left_knuckle_joint")
    assert motion.why == "activation of gripper moves it, in phase start, in which nothing may move"


def test_hardware_that_comes_up_active_with_the_process_moves_too(ur5e: GeneratedFolder) -> None:
    manager, text = next(iter(ur5e.parameters.items()))
    at_once = text.replace("unconfigured:", "none:")
    assert at_once != text
    assert brought_up(replace(ur5e, parameters={manager: at_once}))[0].outcome == "uncommanded_motion"


def test_stay_in_inactive_leaves_commands_of_nan(ur5e: GeneratedFolder) -> None:
    manager, text = next(iter(ur5e.parameters.items()))
    inactive = text.replace("unconfigured:", "inactive:")
    assert inactive != text
    result, _ = brought_up(replace(ur5e, parameters={manager: inactive}))
    assert (result.outcome, reason(result)) == (
        "claim_failure",
        "commands of gripper_hardware are NaN after a stay in inactive",
    )


def test_activation_after_the_claim_ends_the_program_of_the_arm(ur5e: GeneratedFolder) -> None:
    arm_first = [
        step.model_copy(
            update={
                "proof": (),
                "effect": (),
                "phase": BringUpPhase.CLAIM,
                "request": step.request.model_copy(update={"controllers": ("arm_trajectory",)}),
            }
        )
        for step in ur5e.real_bring_up
        if step.phase is BringUpPhase.CLAIM and isinstance(step.request, Activation)
    ]
    rest = [step for step in ur5e.real_bring_up if step.phase is BringUpPhase.CLAIM]
    late = [
        step.model_copy(update={"phase": BringUpPhase.CLAIM, "proof": ()})
        for step in ur5e.real_bring_up
        if step.phase is BringUpPhase.ACTIVATE
    ]
    first = [step for step in ur5e.real_bring_up if step.phase is BringUpPhase.START]
    (manager,) = ur5e.parameters
    shown = {manager: ur5e.parameters[manager].replace("unconfigured:", "inactive:")}  # its states are observed before
    result, plant = brought_up(replace(ur5e, parameters=shown, real_bring_up=(*first, *arm_first, *late, *rest)))
    assert result.outcome == "uncommanded_motion"  # fingers in the phase of the claim
    assert "arm" in plant.effects.silenced


def test_claim_that_waits_for_no_program_jumps_when_somebody_starts_it(ur5e: GeneratedFolder) -> None:
    def unproven(step: BringUpStep) -> BringUpStep:
        return step.model_copy(
            update={"proof": tuple(one for one in step.proof if one.kind != "topic" or not one.field)}
        )

    result, plant = brought_up(replace(with_steps(ur5e, unproven), watches=()))
    assert result.outcome == "uncommanded_motion"
    assert [motion.device for motion in plant.effects.motions] == ["arm"]


def test_people_open_the_brakes_before_the_claim_and_the_cell_moves(fr3: GeneratedFolder) -> None:
    result, _ = brought_up(fr3)
    assert result.outcome == "succeeded", reason(result)


def test_claim_with_closed_brakes_ends_the_manager_of_humble(fr3: GeneratedFolder) -> None:
    result, _ = brought_up(fr3, BRAKES)
    assert result.outcome == "claim_failure"
    assert reason(result) == (
        "step `claim_control`: `arm_trajectory` cannot be activated: "
        "a claim of arm needs brakes open: the process of the controller manager ends"
    )


def test_fault_of_a_phase_that_the_bring_up_does_not_have_is_told(fr3: GeneratedFolder) -> None:
    result, _ = brought_up(fr3, BRAKES.model_copy(update={"phase": BringUpPhase.ACTIVATE}))
    assert result.findings[-1] == "fault `brakes_closed arm` never began: the bring-up has no phase `activate`"
    assert not result.passed


def test_claim_with_closed_brakes_is_refused_on_jazzy(fr3: GeneratedFolder) -> None:
    arm = fr3.contract.devices["arm"]
    claim = arm.effects[Moment.CLAIM].model_copy(update={"needs": {Need.BRAKES_OPEN: Unmet.REFUSED}})
    devices = fr3.contract.devices | {"arm": arm.model_copy(update={"effects": {Moment.CLAIM: claim}})}
    contract = fr3.contract.model_copy(update={"devices": devices})
    result, _ = brought_up(replace(fr3, contract=contract), BRAKES)
    assert result.outcome == "claim_failure"
    assert reason(result).endswith("a claim of arm needs brakes open: the claim is refused")


def test_claim_in_the_first_phase_comes_before_anybody_opened_the_brakes(fr3: GeneratedFolder) -> None:
    def early(step: BringUpStep) -> BringUpStep:
        claims = step.phase is BringUpPhase.CLAIM
        return step.model_copy(update={"phase": BringUpPhase.START}) if claims else step

    assert brought_up(with_steps(fr3, early))[0].outcome == "claim_failure"


@pytest.mark.parametrize(
    ("lock", "held_s"),
    [
        (ManagerLock.SECONDS, 3.0),  # until its fingers have come to an end of their stroke
        (ManagerLock.NONE, 0.0),
    ],
)
def test_activation_takes_as_long_as_the_driver_holds_its_manager(
    lock: ManagerLock, held_s: float, ur5e: GeneratedFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken: dict[str, int] = {}
    activate = RealStart.activate

    def timed(start: RealStart, component: str) -> int:
        taken[component] = activate(start, component)
        return taken[component]

    monkeypatch.setattr(RealStart, "activate", timed)
    gripper = ur5e.contract.devices["gripper"]
    effect = gripper.effects[Moment.ACTIVATE].model_copy(update={"lock": lock})
    held = gripper.model_copy(update={"effects": {**gripper.effects, Moment.ACTIVATE: effect}})
    devices = {**ur5e.contract.devices, "gripper": held}
    brought_up(replace(ur5e, contract=ur5e.contract.model_copy(update={"devices": devices})))
    assert taken == {"arm_hardware": 0, "gripper_hardware": round(held_s * 1e9)}
