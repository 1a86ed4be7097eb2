"""What no file of a package shows is told too, and nobody chooses who approves their own change."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cellc.contract.transforms import Pose
from cellc.tools.review.facts import facts_of
from cellc.tools.review.sides import Package, Side, packages
from cellc.tools.review.units import difference
from tests.cells import spec_text
from tests.cli.run import run
from tests.link.test_packages import CELL, CUBE, DEVICE
from tests.review.edits import changes_between
from tests.review.revisions import Edit, Repository, changes_of, edited, new_repository, package_of, reviewed

DUAL = "cells/dual_ur/cell.yaml"
AREA = "parent: nest, xyz: 0 0 250 mm, box: 500 400 500 mm, granted_by: safety_plc"


def _changes(repository: Repository, main: Package, *edits: Edit) -> list[str]:
    return changes_of(main, package_of(repository, repository.commit(edited(*edits))))


def _of_two_arms(tmp_path: Path, new: str) -> list[str]:
    repository = new_repository(tmp_path, DUAL)
    commit = repository.commit(spec_text("dual_ur").replace(AREA, new), DUAL)
    sides = (Side(name, DUAL, name, repository.folder) for name in ("main", commit))
    with packages(*sides) as ((before, _), (after, _)):
        return changes_of(before, after)


def test_an_area_that_arms_share_is_told_in_mm_and_is_a_matter_of_safety(tmp_path: Path) -> None:
    assert AREA in spec_text("dual_ur")
    smaller = AREA.replace("500 400 500 mm", "50 40 50 mm").replace("safety_plc", "nobody")
    assert _of_two_arms(tmp_path, smaller) == [
        "dangerous safety | over_nest | size of the shared area | 500 400 500 mm -> 50 40 50 mm"
        " | loses 225 mm on each side in x, loses 180 mm on each side in y, loses 225 mm on each side in z",
        "dangerous safety | over_nest | who grants access | safety_plc -> nobody",
    ]


def test_an_area_that_went_is_a_matter_of_safety(repository: Repository, tmp_path: Path) -> None:
    other = new_repository(tmp_path, DUAL)
    lines = [line for line in spec_text("dual_ur").splitlines() if not line.startswith(("areas:", "  over_nest:"))]
    commit = other.commit("\n".join(lines) + "\n", DUAL)
    with packages(*(Side(name, DUAL, name, other.folder) for name in ("main", commit))) as ((before, _), (after, _)):
        assert changes_of(before, after) == ["dangerous safety | over_nest | shared area removed | present -> None"]


def test_what_a_calibration_rests_on_is_told(repository: Repository, main: Package) -> None:
    mount = "mount: {parent: arm/tool0, xyz: 0 0 11"
    found = _changes(
        repository,
        main,
        ("reference_points: 3", "reference_points: 1"),
        (mount, mount.replace("{", "{since: 2026-06-01, ")),
    )
    assert found == [
        "dangerous calibration | gripper | date of mounting | None -> 2026-06-01",
        "dangerous calibration | fixture_A | reference points | 3 -> 1",
    ]


_SAME_CAMERA = ("hand_eye: {revision: 4", "hand_eye: {revision: 5")
_SAME_TOOL = ("tcp_2f: {revision: 1", "tcp_2f: {revision: 2")


@pytest.mark.parametrize(
    ("edit", "newly_measured", "measured"),
    [
        (("serial: UNKNOWN", "serial: '20225500002'"), (_SAME_CAMERA, _SAME_TOOL), "hand_eye`, `tcp_2f"),
        (("model: robotiq_2f_85", "serial: B2\n    model: robotiq_2f_85"), (_SAME_TOOL,), "tcp_2f"),
        (("model: realsense_d435i", "serial: B2\n    model: realsense_d435i"), (_SAME_CAMERA,), "hand_eye"),
        (("xyz: 0 0 11 mm", "xyz: 0 0 12 mm"), (_SAME_TOOL,), "tcp_2f"),
        (("model: realsense_d435i", "model: realsense_d455"), (_SAME_CAMERA,), "hand_eye"),
    ],
)
def test_device_that_a_calibration_measured_is_not_replaced_without_a_new_one(
    edit: Edit, newly_measured: tuple[Edit, ...], measured: str, repository: Repository
) -> None:
    known = tuple((old, new.replace("B2", "A1").replace("20225500002", "20225500001")) for old, new in (edit,))
    before = package_of(repository, repository.commit(edited(*known) if "serial" in edit[1] else edited()))
    after = package_of(repository, repository.commit(edited(edit)))
    again = package_of(repository, repository.commit(edited(edit, *newly_measured)))
    without = {
        "tcp_2f": "`tcp_2f` (revision 1) has no new revision",
        "hand_eye": "`hand_eye` (revision 4) has no new revision",
        "hand_eye`, `tcp_2f": "`hand_eye` (revision 4), `tcp_2f` (revision 1) have no new revision",
    }[measured]
    assert [change.subjects for change in reviewed(before, after).changes if change.why == without]
    assert not [change for change in reviewed(before, again).changes if "no new revision" in change.why]


def test_serial_number_that_was_read_ends_no_calibration(repository: Repository, main: Package) -> None:
    found = reviewed(
        main, package_of(repository, repository.commit(edited(("serial: UNKNOWN", "serial: '20225500001'"))))
    )
    # It was as it is, and is known now.
    assert {str(change.grade) for change in found.changes} == {"safe"}


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ("played_by: operator, mode: remote", "dangerous safety | arm | mode for the program | local -> remote"),
        (
            "played_by: shift, mode: local",
            "dangerous safety | arm | who starts the program | operator -> shift",
        ),
    ],
)
def test_who_starts_the_program_of_a_robot_is_told_first(
    new: str, expected: str, repository: Repository, main: Package
) -> None:
    assert _changes(repository, main, ("played_by: operator, mode: local", new))[0] == expected


def test_a_blocker_that_a_comment_silences_did_not_go(repository: Repository, main: Package) -> None:
    rollback = "rollback: {image: UNKNOWN, configuration: UNKNOWN}"
    silenced = (rollback, f"{rollback}  # cellc: ignore missing-rollback no image yet")
    after = package_of(repository, repository.commit(edited(silenced)))
    found = reviewed(main, after)
    assert [(str(change.grade), change.quantity, change.approval) for change in found.changes] == [
        ("dangerous", "excuse of a blocker added", "safety")
    ]
    assert "missing-rollback" not in {finding.code for finding in found.gone_findings}
    back = reviewed(after, main)
    assert [(str(change.grade), change.quantity) for change in back.changes] == [
        ("safe", "excuse of a blocker removed")
    ]
    assert "missing-rollback" in {finding.code for finding in back.new_findings}


def test_who_approved_before_a_change_approves_it(repository: Repository, main: Package) -> None:
    text = edited(
        ("safety: safety", "safety: integration"),
        ("states: [protective_stop, safeguard_stop, ", "states: [protective_stop, "),
    )
    found = reviewed(main, package_of(repository, repository.commit(text)))
    of_safety = {
        change.quantity: (str(change.grade), change.owner) for change in found.changes if change.area == "safety"
    }
    assert of_safety["states that need recovery"] == ("dangerous", "safety and integration")
    assert of_safety["approver of safety changes"] == ("dangerous", "safety and integration")


def test_an_obstacle_that_planning_knows_no_more_is_dangerous(repository: Repository, main: Package) -> None:
    table = "  table: {parent: world, xyz: 350 0 780 mm, box: 900 1200 40 mm}\n"
    found = _changes(repository, main, (table, ""), ("{shapes: [table]}", "{shapes: [floor]}"))
    assert "dangerous model | table | collision shapes removed | present -> None" in found


def test_an_offer_that_shrinks_breaks_who_asked_for_it(main: Package) -> None:
    # Both ends in the cell ask for less; who asks for reliable elsewhere hears nothing (DDS 1.4, 2.2.3.14).
    contract = json.loads(main.files["contract.json"])
    for end in ("sources", "sinks"):
        for one in contract["interfaces"]["/object_pose"][end]:
            one["qos"]["reliability"] = "best_effort"
    weaker = facts_of({**main.files, "contract.json": json.dumps(contract)})
    broken = [change for change in changes_between(main.facts, weaker) if change.breaking]
    assert [(one.subjects, one.quantity) for one in broken] == [(("/object_pose",), "offered reliability")]
    assert not [change for change in changes_between(weaker, main.facts) if change.breaking]


def test_a_rate_of_success_that_sinks_is_dangerous(repository: Repository, main: Package) -> None:
    found = _changes(repository, main, ("success: 99 %", "success: 50 %"), ("confidence: 95 %", "confidence: 99 %"))
    assert found == [
        "dangerous rehearsals | pick_and_place | required success rate | 99 % -> 50 % | -49 points",
        "review rehearsals | pick_and_place | required confidence | 95 % -> 99 % | +4 points",
    ]


def test_two_folders_whose_cells_differ_are_never_the_same(main: Package) -> None:
    manifest = json.loads(main.files["manifest.json"])
    was = manifest["configuration_inputs"]["cell_sha256"]
    manifest["configuration_inputs"]["cell_sha256"] = "0" * len(was)
    other = facts_of({**main.files, "manifest.json": json.dumps(manifest)})
    (change,) = changes_between(facts_of(main.files), other)
    assert (str(change.area), change.before, change.after) == ("gates", was[:12], "0" * 12)


def test_packages_beside_the_folder_of_a_spec_are_found_in_a_revision(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    repository.git("init", "-q", "-b", "main")
    spec, parts = "cells/bench/cell.yaml", "vendor/src/repo/arm_parts"
    arm = (
        '<robot name="arm"><link name="base"/><link name="hand"><collision><geometry>'
        '<mesh filename="package://arm_parts/hand.stl"/></geometry></collision></link>'
        '<joint name="turn" type="revolute"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/>'
        '<limit lower="-2" upper="2" velocity="1" effort="10"/></joint></robot>'
    )
    repository.write(CUBE, f"{parts}/hand.stl")
    repository.write(arm, "cells/bench/arm/arm.xacro")
    repository.write(DEVICE, "cells/bench/arm/device.yaml")
    repository.write(CELL.replace("PLACES", "../../vendor"), spec)
    repository.git("add", "-A")
    repository.git("commit", "-q", "-m", "the cell")
    file = repository.folder / spec
    assert run("diff", str(file)).code == 0
    file.write_text(file.read_text(encoding="utf-8").replace("away: {all: 0.2 rad}", "away: {all: 0.3 rad}"))
    ran = run("diff", str(file))
    assert ran.code == 1, ran.err
    assert "poses.away.all: 0.2 rad -> 0.3 rad" in ran.out


def test_a_calibration_of_another_name_is_told_in_a_few_lines(repository: Repository, main: Package) -> None:
    text = spec_text("ur5e_pick").replace("hand_eye", "wrist_eye")
    found = changes_of(main, package_of(repository, repository.commit(text)))
    assert found == ["review calibration | wrist_eye | name of the calibration | hand_eye -> wrist_eye"]


@pytest.mark.parametrize(
    ("meters", "told"),
    [(0.001, "1 mm"), (0.12345, "123 mm"), (0.9999999, "1 m"), (1.0, "1 m"), (12.345, "12.3 m"), (1234.5, "1230 m")],
)
def test_how_far_a_frame_moved_is_told_without_a_power_of_ten(meters: float, told: str) -> None:
    upright = (0.0, 0.0, 0.0, 1.0)
    assert difference(Pose((0.0, 0.0, 0.0), upright), Pose((meters, 0.0, 0.0), upright), "") == f"moves {told}"


def test_a_large_share_is_told_without_a_power_of_ten() -> None:
    assert difference(1.0, 21.0, "s") == "+2000 %"
