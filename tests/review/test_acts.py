"""What is one act is one heading that says how far; grades ask whether it was measured, and how much of what it is."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cellc.compiler.pipeline import check
from cellc.compiler.source import read
from cellc.compiler.source.document import SourceDocument
from cellc.contract.printing import as_text
from cellc.contract.review import Review
from cellc.tools.review.acts import causes_between
from cellc.tools.review.causes import as_cause
from cellc.tools.review.compare import reported
from cellc.tools.review.facts import Facts
from cellc.tools.review.grading import _decided_by
from cellc.tools.review.groups import groups_of
from cellc.tools.review.leaves import Delta, Leaf
from cellc.tools.review.loads import unexplained_load
from cellc.tools.review.review import review
from cellc.tools.review.short import MOST_LINES, render_short
from cellc.tools.review.sides import Package, package_of
from cellc.tools.review.titles import title_of
from tests.cells import spec_of
from tests.review.edits import package_before, review_of
from tests.review.revisions import Edit, edited

_TCP_AGAIN = (
    ("tcp_2f: {revision: 1, measured: 2026-07-10", "tcp_2f: {revision: 2, measured: 2026-09-02"),
    ("xyz: 0 0 162 mm, calibration: tcp_2f", "xyz: 0 0 163.6 mm, calibration: tcp_2f"),
)
_WHEEL_AGAIN = (
    ("wheel: {revision: 2, measured: 2026-07-10", "wheel: {revision: 3, measured: 2026-09-02"),
    ("xyz: 450 -200 800 mm", "xyz: 485 -220 800 mm"),
)
_LOAD = ("payload: {mass: 1.1 kg, center_of_mass: 0 0 60 mm}", "payload: {mass: 1.18 kg, center_of_mass: 0 0 66 mm}")
_CAMERA = (
    ("model: realsense_d435i", "model: realsense_d455"),
    ("xyz: 0 -70 30 mm, rpy: 0 -75", "xyz: 0 -100 5 mm, rpy: 0 -75"),
)
_HAND_EYE = ("hand_eye: {revision: 4, measured: 2026-07-01", "hand_eye: {revision: 5, measured: 2026-09-14")
_ADDRESS = ("address: 10.50.0.11/24", "address: 10.50.0.21/24")
_PEERS = ("peers: [10.50.0.10, 10.50.0.11]", "peers: [10.50.0.10, 10.50.0.21]")
_ENDS = (
    ("from: {perception: {reliability: reliable", "from: {perception: {reliability: best_effort"),
    ("to: {task: {reliability: reliable", "to: {task: {reliability: best_effort"),
)
_SENSOR = """  sensor:
    model: ati_axia80
    mount: {parent: arm/tool0}
    revision: UNKNOWN
    firmware: UNKNOWN
    driver: net_ft_driver 6520a2a
    description: net_ft_description 6520a2a
    connection: {host: control_pc, nic: robot, address: 192.168.56.110}
"""
_NEW_SENSOR = ("\ncalibrations:", f"\n{_SENSOR}\ncalibrations:")


def _titles(found: Review) -> list[str]:
    return [f"{group.grade} {group.title}" for group in groups_of(found)]


def _screen(found: Review) -> list[str]:
    return as_text(render_short(found), color=False).splitlines()


def _document(cell: str, *edits: Edit) -> SourceDocument:
    file = spec_of(cell).as_posix()
    document = read(file, {file: edited(*edits, cell=cell)}).value
    assert document is not None
    return document


@pytest.mark.parametrize(
    ("cell", "edits", "title"),
    [
        (
            "ur5e_pick",
            _CAMERA,
            # By hand: the root of 30 and 25 squared.
            "devices.camera.model: realsense_d435i -> realsense_d455 (cell.yaml:49, 50), "
            "mount moved 39.1 mm: 0 -70 30 mm -> 0 -100 5 mm",
        ),
        ("ur5e_pick", _ENDS, "interfaces./object_pose.reliability of both ends: reliable -> best_effort (cell.yaml:"),
        (
            "hybrid_sdk",
            (_ADDRESS, _PEERS),
            "hosts.planner_pc.nics.cell.address: 10.50.0.11/24 -> 10.50.0.21/24 (cell.yaml:",
        ),
        (
            "rail_arm",
            (_NEW_SENSOR,),
            "devices.sensor added (cell.yaml:44): "
            "ati_axia80 on `arm/tool0`, 192.168.56.110 at card `robot` of `control_pc`",
        ),
        ("hybrid_sdk", (("summary: ", "summary: another "),), "summary: other words (cell.yaml:4)"),
    ],
)
def test_what_is_one_act_is_one_heading(cell: str, edits: tuple[Edit, ...], title: str) -> None:
    (cause,) = map(as_cause, causes_between(_document(cell), _document(cell, *edits)))
    assert title_of(cause, cause.line, str, {}).startswith(title)


def test_what_was_measured_again_is_reviewed_whatever_its_size_and_the_largest_move_leads() -> None:
    found = review_of("hybrid_sdk", _LOAD, *_TCP_AGAIN, *_WHEEL_AGAIN)
    first, second, third = _titles(found)
    # By hand: the root of 35 and 20 squared.
    assert first.startswith("review frames.wheel moved 40.3 mm: 450 -200 800 mm -> 485 -220 800 mm (cell.yaml:")
    assert first.endswith("calibration wheel revision 2 -> 3, measured 2026-07-10 -> 2026-09-02")
    assert second.startswith("review frames.tcp moved 1.6 mm: 0 0 162 mm -> 0 0 163.6 mm (cell.yaml:")
    assert third.startswith("review devices.arm.payload (cell.yaml:")
    assert "mass 1.1 kg -> 1.18 kg (+7.27 %)" in third
    assert not any("longer" in line for line in _screen(found))
    narrow = groups_of(found)[0].fitting(70)
    assert narrow == "wheel moved 40.3 mm: 450 -200 800 mm -> 485 -220 800 mm and 2 more"


@pytest.mark.parametrize(("beside", "dangerous"), [((), {"model", "pose in its parent"}), ((_HAND_EYE,), set[str]())])
def test_another_camera_asks_for_its_calibration(beside: tuple[Edit, ...], dangerous: set[str]) -> None:
    file = spec_of("ur5e_pick").as_posix()
    after = package_of("after", check(file, {file: edited(*_CAMERA, *beside, cell="ur5e_pick")}))
    # Its box is larger, and where it is bolted moved: no room that planning avoided is free.
    changes = reported(package_before("ur5e_pick").facts, after.facts)
    assert {change.quantity for change in changes if change.grade == "dangerous"} == dangerous


def test_a_new_sensor_is_not_dangerous_for_pins_that_nobody_knows_yet() -> None:
    file = spec_of("rail_arm").as_posix()
    after = package_of("after", check(file, {file: edited(_NEW_SENSOR, cell="rail_arm")}))
    changes = reported(package_before("rail_arm").facts, after.facts)
    assert {str(change.grade) for change in changes} == {"review"}
    # A link that was not there could meet none before.
    assert not [change for change in changes if change.quantity.startswith("can ")]


_WRENCH = (
    (
        "\ncalibrations:",
        f"\n{_SENSOR.replace('arm/tool0', 'arm/flange').replace('nic: robot', 'nic: cell')}\ncalibrations:",
    ),
    (
        "    gripper_action: {type: parallel",
        "    wrench: {type: force_torque_sensor_broadcaster, device: sensor}\n    gripper_action: {type: parallel",
    ),
)
_MORE_OPEN = (
    "fittings: {open: {person: integration, date: 2026-12-15}}",
    "fittings: {open: {person: integration, date: 2027-01-29}}",
)


@pytest.mark.parametrize(
    ("cell", "edits", "quantity", "grade"),
    [
        # A broadcaster claims nothing: that more of them are activated moves no hardware.
        ("hybrid_sdk", _WRENCH, "controllers that only read hardware", "review"),
        ("dual_ur", (_MORE_OPEN,), "open question on the surroundings", "review"),
        ("dual_ur", (("recovery_time: 300 s", "recovery_time: 240 s"),), "target figure", "safe"),
        ("dual_ur", (("recovery_time: 300 s", "recovery_time: 360 s"),), "target figure", "review"),
        (
            "fr3_hand",
            (("grip: {force: 20 N}", "grip: {speed: 30 mm/s, force: 20 N}"),),
            "speed of the jaws' joint",
            "safe",
        ),
    ],
)
def test_what_moves_nothing_faster_and_protects_no_less_is_not_dangerous(
    cell: str, edits: tuple[Edit, ...], quantity: str, grade: str
) -> None:
    file = spec_of(cell).as_posix()
    changes = reported(
        package_before(cell).facts, package_of("after", check(file, {file: edited(*edits, cell=cell)})).facts
    )
    assert "dangerous" not in {str(change.grade) for change in changes}
    assert {str(change.grade) for change in changes if change.quantity.startswith(quantity)} == {grade}


def test_a_first_motion_and_the_speed_of_jaws_have_the_unit_of_their_joint() -> None:
    rail = review_of("rail_arm", ("max_delta: 20 mm, velocity: 10 mm/s", "max_delta: 50 mm, velocity: 15 mm/s"))
    told = {(change.quantity, change.before, change.after) for change in rail.changes}
    assert {("first motion largest move", "20 mm", "50 mm"), ("first motion velocity", "10 mm/s", "15 mm/s")} <= told
    arm = review_of("rail_arm", ("max_delta: 5 deg, velocity: 5 deg/s", "max_delta: 4 deg, velocity: 5 deg/s"))
    assert ("first motion largest move", "5 deg", "4 deg") in {(c.quantity, c.before, c.after) for c in arm.changes}
    hand = review_of("fr3_hand", ("grip: {force: 20 N}", "grip: {speed: 30 mm/s, force: 20 N}"))
    # Each of two fingers that slide goes half as fast as the jaws.
    assert "15 mm/s" in {change.after for change in hand.changes}


def test_a_controller_that_claims_makes_its_step_dangerous() -> None:
    facts = package_before("fr3_hand").facts
    steps = {path[3] for path in facts.leaves if path[:2] == ("step", "real") and path[4:] == ("controllers",)}
    assert steps == {"observed", "request"}


@pytest.mark.parametrize(
    ("what", "before", "after", "told"),
    [
        # The arm is rated for 3 kg: a tenth of it is 0.3 kg.
        ("mass_kg", 1.0, 1.08, None),
        ("mass_kg", 1.0, 1.29, None),
        ("mass_kg", 1.0, 1.3, "a tenth of the 3 kg"),
        ("mass_kg", 1.0, 0.7, "a tenth of the 3 kg"),
        ("mass_kg", 2.9, 3.01, "beyond the 3 kg"),
        ("mass_kg", 1.0, None, ""),
        ("center_of_mass", (0.0, 0.0, 0.05), (0.0, 0.0, 0.099), None),
        ("center_of_mass", (0.0, 0.0, 0.05), (0.0, 0.0, 0.1), "50 mm or more"),
        ("set_by", "installation", "service", ""),
    ],
)
def test_a_load_is_graded_by_how_much_of_what_the_arm_is_rated_for(
    what: str, before: Leaf, after: Leaf | None, told: str | None
) -> None:
    facts = package_before("hybrid_sdk").facts
    why = unexplained_load(Delta(("device", "arm", "payload", what), before, after), facts, facts)
    assert (why is None) == (told is None)
    assert (told or "") in (why or "")


def _with_bound(facts: Facts, clock: str, seconds: float) -> Facts:
    clocks = facts.contract.clocks
    bound = clocks[clock].model_copy(update={"max_offset_s": seconds})
    return replace(facts, contract=facts.contract.model_copy(update={"clocks": {**clocks, clock: bound}}))


def test_a_clock_counts_where_stamps_are_made_or_judged_on_it() -> None:
    facts = package_before("hybrid_sdk").facts  # joint states are made on control_pc, and may be 100 ms old
    assert _decided_by("control_pc", facts) == {"/joint_states": 0.1}
    assert not _decided_by("planner_pc", _with_bound(facts, "planner_pc", 0.005))


def test_a_value_is_told_in_the_units_of_each_side() -> None:
    (change,) = review_of("hybrid_sdk", ("command_timeout: 20 ms", "command_timeout: 0.2 s")).changes
    assert (change.before, change.after) == ("20 ms", "0.2 s")


def test_who_answers_for_the_recovery_is_asked_and_the_blocker_stands_below_its_cause() -> None:
    found = review_of("fr3_hand", ("states: [protective_stop, user_stop,", "states: [protective_stop,"))
    (change,) = found.changes
    assert change.owner == "safety and robot"
    screen = _screen(found)
    assert screen[3].startswith("dangerous  safety.recovery.states: ")
    assert "new blocker[stop-without-recovery]" in " ".join(screen[4:7])


def test_a_slower_device_asks_who_answers_for_limits() -> None:
    (group,) = groups_of(review_of("hybrid_sdk", ("velocity: 35 %", "velocity: 30 %")))
    assert (str(group.grade), group.asks) == ("safe", "controller (controls)")


def _with_errors(cell: str, *edits: Edit) -> Package:
    file = spec_of(cell).as_posix()
    checked = check(file, {file: edited(*edits, cell=cell)})
    assert not checked.ok
    return package_of("refused", checked)


def test_a_cell_with_errors_is_compared_and_its_repair_too() -> None:
    wrong: Edit = ("aside: {manipulator: 30 -90", "aside: {manipulator: 400 -90")
    looser: Edit = ("goal_tolerance: 0.01 rad", "goal_tolerance: 0.02 rad")
    refused, both = _with_errors("minimal", wrong), _with_errors("minimal", wrong, looser)
    stands = review(refused, both)
    assert [title.partition(":")[0] for title in _titles(stands)] == [
        "dangerous control.controllers.arm_trajectory.goal_tolerance"
    ]
    assert any("1 error of before still there" in note for note in stands.notes)
    repaired = review(refused, package_before("minimal"))
    assert [found.code for found in repaired.gone_findings] == ["pose-outside-limits"]
    assert [title.partition(":")[0] for title in _titles(repaired)] == ["review motion.poses.aside.manipulator"]
    assert "resolved findings: 1, error[pose-outside-limits]" in _screen(repaired)
    broken = review(package_before("minimal"), refused)
    screen = _screen(broken)
    assert screen[3] == "new findings: 1"
    assert screen[4].startswith("  new error[pose-outside-limits]: ")
    assert len(screen) <= MOST_LINES
