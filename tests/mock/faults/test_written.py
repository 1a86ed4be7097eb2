"""Faults as a user writes them: each rehearsal of the chapter's cell ends as expected, within its bound."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.mock import MockCell, load
from tests import cells
from tests.cells import build_into, spec_of, spec_text

REHEARSALS = """
  late_state: {use: pick_and_place, inject: {delay: arm, by: 300 ms, at: 1 s}, expect: stale_state, within: 600 ms}
  late_image: {use: pick_and_place, inject: {delay: camera, by: 300 ms, at: 0 s}, expect: stale_state, within: 1.5 s}
  old_state: {use: pick_and_place, inject: {freeze: arm, at: 1 s}, expect: stale_state, within: 600 ms}
  first_part_lost:
    use: pick_and_place
    inject: {freeze: camera, at: {step: 3, when: accepted, after: 100 ms}}
    expect: stale_state
    within: 500 ms
  doubled_frame:
    {use: pick_and_place, inject: {double_frame: object, at: {step: 3}}, expect: tf_failure, within: 500 ms}
  clock_back:
    {use: pick_and_place, inject: {jump_clock: control_pc, by: -1 s, at: 1 s}, expect: stale_state, within: 500 ms}
  unheard: {use: pick_and_place, inject: {mismatch_qos: /object_pose, at: 1 s}, expect: stale_state, within: 500 ms}
  unplanned: {use: pick_and_place, inject: {unresponsive: move_group, at: 0 s}, expect: timeout, within: 1.1 s}
  unanswered: {use: pick_and_place, inject: {unresponsive: arm_trajectory, at: 0 s}, expect: timeout, within: 1.1 s}
  two_masters:
    use: pick_and_place
    inject: {second_commander: arm_trajectory, at: {step: 3, when: moving}}
    expect: wrong_owner
    within: 250 ms
  switched:
    {use: pick_and_place, inject: {switch: arm_trajectory, at: {step: 3, when: moving}}, expect: wrong_owner}
  slow: {use: pick_and_place, inject: {slow: arm/shoulder_pan_joint, to: 1 deg/s, at: 1 s}, expect: tolerance_violation}
  pushed:
    {use: pick_and_place, inject: {displace: arm/elbow_joint, by: 0.25 rad, at: 1 s}, expect: tolerance_violation}
  paused: {use: pick_and_place, inject: {scale_speed: arm, to: 0 %, at: 1 s}, expect: timeout, within: 90.5 s}
  slowed: {use: pick_and_place, inject: {scale_speed: arm, to: 10 %, at: 1 s, lasting: 1 s}}
  overloaded:
    use: pick_and_place
    inject: {wrong_payload: arm, at: {step: 3, when: moving}}
    expect: protective_stop
    within: 500 ms
  powerless:
    {use: pick_and_place, inject: {emergency_stop: arm, at: 1 s}, expect: emergency_stop, within: 250 ms}
  unplugged: {use: pick_and_place, inject: {cut_network: arm, at: 1 s}, expect: tolerance_violation}
  dark: {use: pick_and_place, inject: {cut_network: camera, at: 1 s}, expect: stale_state, within: 500 ms}
  lost: {use: pick_and_place, inject: {restart_driver: arm, at: 1 s, lasting: 1 s}, expect: hardware_fault}
  recovered:
    steps: [move: home, detect: object, move: pick, wait: 2 s, acknowledge: operator, move: home]
    inject: {restart_driver: arm, at: {step: 3, when: moving, after: 200 ms}, lasting: 1 s}
  alone_and_together:
    use: pick_and_place
    inject: [{slow: arm/elbow_joint, to: 60 deg/s, at: 0 s}, {protective_stop: gripper, at: {step: 4, when: accepted}}]
    expect: tolerance_violation
"""


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> MockCell:
    """The chapter's cell with more rehearsals, built and loaded."""
    folder = tmp_path_factory.mktemp("written")
    spec = cells.written(folder, spec_text("ur5e_pick").replace("\nuncertainty:", f"{REHEARSALS}\nuncertainty:"))
    return load(build_into(folder / "ur5e_pick", spec))


def test_rehearsals_of_all_kinds_of_faults_end_as_written(written: MockCell) -> None:
    results = [written.run(name) for name in written.rehearsals]
    failed = [f"{each.name}: {each.outcome} after {each.response_s} s" for each in results if not each.passed]
    assert failed == []
    assert len(results) == spec_text("ur5e_pick").count("expect:") + 4 + REHEARSALS.count("inject:")


def test_cell_with_such_rehearsals_is_checked_without_a_new_finding(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    cell = tmp_path / "cell.yaml"
    plain = {diagnostic.code for diagnostic in check(spec_of("ur5e_pick")).diagnostics}
    cell.write_text(text.replace("\nuncertainty:", f"{REHEARSALS}\nuncertainty:"), encoding="utf-8")
    assert {diagnostic.code for diagnostic in check(cell).diagnostics} == plain
