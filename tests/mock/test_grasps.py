"""What closed fingers prove: where they stop, what the task makes of it, and where a part is that is let go of."""

from __future__ import annotations

import math

import pytest

from cellc.contract.devices import ContractGripper
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import load
from cellc.mock.cell import cell_of
from cellc.mock.faults.registry import possible_faults
from cellc.mock.folder import GeneratedFolder
from cellc.mock.parts import Parts
from cellc.mock.plant import Plant
from cellc.mock.result import RehearsalResult
from tests.cells import generated, there

JOINT = "gripper_robotiq_85_left_knuckle_joint"
OUT, UP, PIVOT, PAD = 0.0371575, 0.04342168, 0.03060114, 0.02526
"""Of robotiq_description 3b6cf8f, m: from the knuckle to the tip's pivot, the knuckle from the middle, pivot to pad."""
HOME = StepEntry(kind=StepKind.MOVE, target="home")
DETECT = StepEntry(kind=StepKind.DETECT, target="object")
PICK, PLACE = StepEntry(kind=StepKind.MOVE, target="pick"), StepEntry(kind="move", target="place")
CLOSE = StepEntry(kind=StepKind.GRIP, target="gripper", command="close", part="object")
OPEN = StepEntry(kind=StepKind.GRIP, target="gripper", command="open")
TAKEN = (HOME, DETECT, PICK, CLOSE)


def opening_of_2f_85(angle: float) -> float:
    """Return how far the pads of a 2F-85 are apart, m: twice what one is from the middle."""
    return 2.0 * (PIVOT + OUT * math.cos(angle) - UP * math.sin(angle) - PAD)


@pytest.fixture(scope="module")
def folder() -> GeneratedFolder:
    """The folder of a cell whose part is 77 mm wide, within 2 mm."""
    return load(generated("ur5e_pick")).folder


def run(
    folder: GeneratedFolder, *steps: StepEntry, faults: tuple[FaultEntry, ...] = ()
) -> tuple[RehearsalResult, Plant]:
    """Run steps."""
    plants: list[Plant] = []
    entry = RehearsalEntry(name="grasp", steps=steps, faults=faults, expect=AttemptOutcome.SUCCEEDED, timeout_s=60.0)
    result = cell_of(folder).rehearse(entry, watch=plants.append)
    return result, plants[0]


def at(step: int, kind: FaultKind, target: str, **more: float) -> FaultEntry:
    """Return a fault that begins before a step."""
    return FaultEntry.model_validate({"kind": kind, "target": target, "event": FaultEvent(step=step), **more})


def reason(result: RehearsalResult) -> tuple[str, str]:
    """Return how a run ended, and the first word of why."""
    return result.outcome.value, next(each.fault_code for each in result.attempts if each.fault_code).split(":")[0]


def position(plant: Plant) -> float:
    """Return where the fingers' joint is, rad."""
    return plant.world.joint_positions(plant.now_ns)[JOINT]


def test_band_of_a_2f_85_is_where_the_vendors_linkage_has_the_width(folder: GeneratedFolder) -> None:
    band = there(folder.contract.frames["object"].grasp).bands["gripper"]
    assert band.joint == JOINT
    assert opening_of_2f_85(band.lower) == pytest.approx(0.079, abs=0.0002)
    assert opening_of_2f_85(band.upper) == pytest.approx(0.075, abs=0.0002)


def test_band_of_a_franka_hand_is_half_the_width_of_each_finger() -> None:
    band = there(load(generated("fr3_hand")).folder.contract.frames["tray"].grasp).bands["hand"]
    assert (band.lower, band.upper) == pytest.approx((0.034, 0.036), abs=1e-9)


@pytest.mark.parametrize("open_at", [0.7854, -0.7854])
def test_fingers_that_swing_are_where_their_sine_has_the_width(open_at: float) -> None:
    fingers = ContractGripper(joint="finger", open=open_at, closed=0.0, max_effort=100.0, stroke_m=0.099, swing=0.0)
    for width_m in (0.01, 0.05, 0.09):  # two fingers of 70 mm
        assert 2.0 * 0.07 * math.sin(abs(fingers.position(width_m))) == pytest.approx(width_m, abs=1e-4)
        assert fingers.position(width_m) * open_at > 0.0


def test_fingers_stop_at_the_part(folder: GeneratedFolder) -> None:
    result, plant = run(folder, *TAKEN)
    assert result.outcome == AttemptOutcome.SUCCEEDED
    assert opening_of_2f_85(position(plant)) == pytest.approx(0.077, abs=0.0002)
    assert there(result.attempts[3].result).error_string == "stalled"
    assert plant.parts.held == {"gripper": "object"}


def test_closing_on_nothing_fails_as_empty(folder: GeneratedFolder) -> None:
    result, plant = run(folder, *TAKEN, faults=(at(4, FaultKind.MISSING_PART, "object"),))
    assert reason(result) == ("grip_failure", "empty")
    assert position(plant) == pytest.approx(0.7929, abs=1e-6)


def test_closing_fingers_that_are_closed_already_take_nothing(folder: GeneratedFolder) -> None:
    before = CLOSE.model_copy(update={"part": None})
    result, plant = run(folder, HOME, before, DETECT, PICK, CLOSE)
    assert reason(result) == ("grip_failure", "empty")
    assert plant.parts.held == {}


@pytest.mark.parametrize("wider_m", [-0.006, 0.006])
def test_another_part_fails_as_wrong(folder: GeneratedFolder, wider_m: float) -> None:
    result, plant = run(folder, *TAKEN, faults=(at(4, FaultKind.WRONG_PART, "object", size_m=wider_m),))
    assert reason(result) == ("grip_failure", "wrong part")
    assert opening_of_2f_85(position(plant)) == pytest.approx(0.077 + wider_m, abs=0.0003)


def test_part_within_its_tolerance_is_right(folder: GeneratedFolder) -> None:
    result, _ = run(folder, *TAKEN, faults=(at(4, FaultKind.WRONG_PART, "object", size_m=0.0015),))
    assert result.outcome == AttemptOutcome.SUCCEEDED


def test_part_that_falls_on_the_way_ends_the_motion(folder: GeneratedFolder) -> None:
    lost = FaultEntry(kind=FaultKind.LOSE_PART, target="gripper", event=FaultEvent(step=5, when="moving", after_s=0.3))
    result, plant = run(folder, *TAKEN, PLACE, OPEN, faults=(lost,))
    assert (*reason(result), result.attempts[-1].step) == ("grip_failure", "lost", "end")
    assert result.attempts[4].outcome == AttemptOutcome.GRIP_FAILURE
    assert 0.0 < there(result.response_s) < 0.7
    assert plant.world.object_pose("object", plant.now_ns).position[2] == 0.0


def test_slip_is_seen_where_the_part_is_let_go_of(folder: GeneratedFolder) -> None:
    slip = at(5, FaultKind.SLIP, "gripper", size_m=0.005)
    result, _ = run(folder, *TAKEN, PLACE, OPEN, HOME, faults=(slip,))
    assert (*reason(result), len(result.attempts)) == ("grip_failure", "slipped", 7)
    borne, _ = run(folder, *TAKEN, PLACE, OPEN, HOME, faults=(slip.model_copy(update={"size_m": 0.001}),))
    assert borne.outcome == AttemptOutcome.SUCCEEDED


def test_part_stays_only_where_something_is_below_it(folder: GeneratedFolder) -> None:
    placed, plant = run(folder, *TAKEN, PLACE, OPEN)
    assert placed.outcome == AttemptOutcome.SUCCEEDED
    assert plant.world.object_pose("object", plant.now_ns).position[2] == pytest.approx(0.85, abs=0.002)
    back, _ = run(folder, *TAKEN, OPEN)
    assert back.outcome == AttemptOutcome.SUCCEEDED
    dropped, plant = run(folder, *TAKEN, HOME, OPEN)
    assert reason(dropped) == ("grip_failure", "dropped")
    assert plant.world.object_pose("object", plant.now_ns).position[2] == 0.0


def test_each_fault_of_a_part_is_a_case_of_the_campaign(folder: GeneratedFolder) -> None:
    kinds = {FaultKind.MISSING_PART, FaultKind.WRONG_PART, FaultKind.LOSE_PART, FaultKind.SLIP}
    cases = {case.entry.kind: case for case in possible_faults(folder.contract) if case.entry.kind in kinds}
    assert set(cases) == kinds
    ending = cases[FaultKind.WRONG_PART].ending(CLOSE)
    assert ending.outcomes == {AttemptOutcome.GRIP_FAILURE, AttemptOutcome.SUCCEEDED}
    assert not any(case.entry.kind in kinds for case in possible_faults(load(generated("minimal")).folder.contract))


@pytest.mark.parametrize(("above_m", "lies"), [(0.01, True), (0.05, False), (-0.01, False)])
def test_a_part_let_go_of_above_the_top_of_a_box_lies_on_it(
    folder: GeneratedFolder, above_m: float, lies: bool
) -> None:
    _, plant = run(folder, *TAKEN, HOME)
    tip, now_ns = next(iter(plant.contract.groups.values())).tip_frame, plant.now_ns
    middle_m = plant.world.link_pose("table", now_ns).position[2]
    top_m = plant.world.link_pose(tip, now_ns).position[2] - above_m
    boxes = {"table": (4.0, 4.0, 2.0 * (top_m - middle_m))}
    parts = Parts(plant.contract, plant.control, plant.world, boxes)
    parts.take("gripper", "object", 0)
    assert parts.lies("object", tip, now_ns) is lies
    assert not Parts(plant.contract, plant.control, plant.world).held
