"""Each line of a gate follows the evidence: confirmed, contradicted, or UNKNOWN without it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pytest

from cellc.contract.attempt import CancelRecord
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell
from cellc.mock.campaign.limits import LimitExcess, LimitsReport, Peak
from cellc.mock.folder import GeneratedFolder
from cellc.mock.gates import JudgedRun, Verdict, sign_gates
from cellc.robot.description.urdf_reader import read_urdf
from tests.mock.gates.conftest import gate, line, with_attempt

PASSED, FAILED, UNKNOWN = Verdict.PASSED, Verdict.FAILED, Verdict.UNKNOWN
Runs = tuple[JudgedRun, ...]


def run(runs: Runs, name: str) -> JudgedRun:
    return next(each for each in runs if each.name == name)


def changed_urdf(folder: GeneratedFolder, old: str, new: str) -> GeneratedFolder:
    assert old in folder.urdf
    urdf = folder.urdf.replace(old, new, 1)
    description = read_urdf(urdf, folder.contract.files.urdf_mock).value
    assert description is not None
    return replace(folder, urdf=urdf, description=description)


def test_rehearsals_confirm_what_they_showed_and_leave_the_rest_unknown(pick: MockCell, rehearsed: Runs) -> None:
    command_path = gate("L6", pick.folder, rehearsed)
    assert line(command_path, "is a route to a real interface").verdict is PASSED
    assert line(command_path, "claimed by its one owner").verdict is PASSED
    assert line(command_path, "A goal to arm_trajectory is accepted, driven and answered").verdict is PASSED
    cancel = line(command_path, "A canceled goal of arm_trajectory is held within 0.2 s on mock hardware")
    assert cancel.verdict is PASSED
    assert cancel.evidence[0].startswith("canceled, move pick: held after ")
    assert line(command_path, "A canceled goal of gripper_action").verdict is UNKNOWN
    assert line(command_path, "A violated tolerance of arm_trajectory").verdict is UNKNOWN
    assert command_path.verdict is UNKNOWN


def test_no_evidence_leaves_every_line_about_runs_unknown(pick: MockCell) -> None:
    gates = sign_gates(pick.folder, (), 0)
    assert [each.gate for each in gates] == ["S2", "L6", "G1", "G2"]
    static = ("real interface", "generated", "one tree", "unit length", "Limits of the cell", "TCP", "one server")
    for each in gates:
        for check in each.checks:
            assert check.verdict is (PASSED if any(word in check.text for word in static) else UNKNOWN), check.text
            assert check.evidence


def test_what_only_hardware_or_a_person_can_show_is_never_signed(pick: MockCell, rehearsed: Runs) -> None:
    model = gate("G1", pick.folder, rehearsed)
    assert line(model, "Axes turn as those of the robot").verdict is UNKNOWN
    assert line(model, "Collision shapes enclose").verdict is UNKNOWN
    assert line(model, "Frame tcp agrees with its physical marker (calibration tcp_2f)").verdict is UNKNOWN
    assert line(gate("G2", pick.folder, rehearsed), "launch file").verdict is UNKNOWN
    assert line(gate("S2", pick.folder, rehearsed), "hard servo loop").verdict is UNKNOWN


@pytest.mark.parametrize(
    ("old", "new", "words", "reason"),
    [
        (
            "mock_components/GenericSystem",
            "vendor_driver/PositionHardware",
            "is a route to a real interface",
            "arm_hardware: vendor_driver/PositionHardware",
        ),
        ('<parent link="world"/>', '<parent link="nowhere"/>', "one tree", "link "),
        ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 2"/>', "unit length", "has the length 2"),
        (
            'velocity="1.5707963267948966"',
            'velocity="1.0"',
            "Limits of the cell",
            "velocity 1.5708, 1 in the description",
        ),
    ],
)
def test_spoiled_description_fails_its_line(
    pick: MockCell, rehearsed: Runs, old: str, new: str, words: str, reason: str
) -> None:
    spoiled = changed_urdf(pick.folder, old, new)
    checks = [check for each in sign_gates(spoiled, rehearsed, 0) for check in each.checks if words in check.text]
    assert [check.verdict for check in checks] == [FAILED]
    assert any(reason in piece for piece in checks[0].evidence), checks[0].evidence


def test_file_edited_by_hand_fails_the_model(pick: MockCell, rehearsed: Runs) -> None:
    edited = replace(pick.folder, notes=("`urdf/ur5e_pick.mock.urdf` differs from the manifest",))
    assert line(gate("G1", edited, rehearsed), "as it was generated").verdict is FAILED


def test_cancel_that_is_not_held_fails_its_line(pick: MockCell, rehearsed: Runs) -> None:
    moving = run(rehearsed, "canceled")
    late = CancelRecord(requested_ns=1_000_000_000, held_ns=1_250_000_000, latency_s=0.25, return_code=0)
    never = replace(late, held_ns=None, latency_s=None)
    for cancel in (late, never):
        spoiled = (with_attempt(moving, "move pick", partial(replace, cancel=cancel)),)
        check = line(gate("G2", pick.folder, spoiled), "A canceled goal of arm_trajectory")
        assert check.verdict is FAILED
        assert check.evidence == ("canceled, move pick: not held within 0.2 s",)


def test_cancel_of_a_goal_that_moved_nothing_is_no_evidence(pick: MockCell, rehearsed: Runs) -> None:
    still = with_attempt(run(rehearsed, "canceled"), "move pick", partial(replace, trace=()))
    assert line(gate("L6", pick.folder, (still,)), "A canceled goal of arm_trajectory").verdict is UNKNOWN


def test_second_owner_fails_its_line(pick: MockCell, rehearsed: Runs) -> None:
    good = run(rehearsed, "pick_and_place")
    problem = "`arm_elbow_joint/position` must be claimed by `arm_trajectory`, got `other`"
    stages = tuple(
        replace(stage, problems=(problem,)) if stage.stage == "claim" else stage for stage in good.result.bringup
    )
    spoiled = replace(good, result=replace(good.result, bringup=stages))
    assert line(gate("G2", pick.folder, (spoiled,)), "claimed by its one owner").verdict is FAILED
    assert line(gate("G2", pick.folder, (spoiled,)), "starts in stages").verdict is FAILED


def test_rehearsal_that_ends_otherwise_fails_the_mock_gate(pick: MockCell, rehearsed: Runs) -> None:
    other = replace(run(rehearsed, "stale_camera"), passed=False)
    assert line(gate("G2", pick.folder, (*rehearsed, other)), "Every rehearsal ends").verdict is FAILED
    fewer = tuple(each for each in rehearsed if each.name != "stale_camera")
    missing = line(gate("G2", pick.folder, fewer), "Every rehearsal ends")
    assert (missing.verdict, missing.evidence) == (UNKNOWN, ("a run of stale_camera",))


def test_late_sample_passes_where_it_ended_bounded_and_fails_where_it_did_not(pick: MockCell, rehearsed: Runs) -> None:
    words = "/camera/color/image_raw (topic, newest): a late sample"
    assert line(gate("S2", pick.folder, rehearsed), words).verdict is PASSED
    assert line(gate("S2", pick.folder, rehearsed), "/joint_states (topic, newest)").verdict is UNKNOWN
    unbounded = replace(run(rehearsed, "stale_camera"), passed=False)
    assert line(gate("S2", pick.folder, (unbounded,)), words).verdict is FAILED
    unnoticed = replace(unbounded, passed=True, result=replace(unbounded.result, outcome=AttemptOutcome.SUCCEEDED))
    assert line(gate("S2", pick.folder, (unnoticed,)), words).verdict is UNKNOWN


def test_exceeded_limit_fails_the_mock_gate(pick: MockCell, rehearsed: Runs) -> None:
    peaks = (Peak("velocity", 0.5),)
    held = replace(rehearsed[0], limits=LimitsReport(peaks=peaks))
    assert line(gate("G2", pick.folder, (held,)), "exceeds a limit").verdict is PASSED
    excess = LimitExcess("arm_trajectory", "arm_elbow_joint", "velocity", 1_000_000_000, 2.0, 1.57)
    exceeded = replace(rehearsed[0], limits=LimitsReport(peaks=peaks, excesses=(excess,)))
    assert line(gate("G2", pick.folder, (exceeded,)), "exceeds a limit").verdict is FAILED


def test_signature_changes_with_any_evidence(pick: MockCell, rehearsed: Runs) -> None:
    signed = gate("G2", pick.folder, rehearsed).signature
    assert gate("G2", pick.folder, rehearsed).signature == signed
    assert gate("G2", pick.folder, rehearsed[:-1]).signature != signed
    reseeded = next(each for each in sign_gates(pick.folder, rehearsed, 1) if each.gate == "G2")
    assert reseeded.signature != signed


_ACTIONS = ("/arm_trajectory/follow_joint_trajectory", "/gripper_action/gripper_cmd", "/move_action")


@pytest.mark.parametrize(
    ("target", "shown"),
    [("arm_trajectory", _ACTIONS[:1]), ("gripper_action", _ACTIONS[1:2]), ("move_group", _ACTIONS[2:]), ("camera", ())],
)
def test_missing_responder_is_shown_by_a_fault_of_its_server(
    target: str, shown: tuple[str, ...], pick: MockCell, rehearsed: Runs
) -> None:
    good = run(rehearsed, "pick_and_place")
    fault = FaultEntry(kind=FaultKind.UNRESPONSIVE, target=target, at_s=0.0, event=None, phase=None)
    ended = replace(good.result, outcome=AttemptOutcome.GOAL_REJECTION)
    runs = (replace(good, entry=good.entry.model_copy(update={"faults": (fault,)}), result=ended),)
    of = {name: line(gate("S2", pick.folder, runs), f"{name} (action): a missing responder") for name in _ACTIONS}
    assert {name for name, check in of.items() if check.verdict is PASSED} == set(shown)
    assert {check.verdict for check in of.values()} <= {PASSED, UNKNOWN}
