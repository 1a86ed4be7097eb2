"""One named change of a real cell is found on the line where it was made."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.pipeline import check

CELL = Path(__file__).resolve().parents[2] / "cells" / "ur5e_pick" / "cell.yaml"
TEXT = CELL.read_text(encoding="utf-8")
JOINTS = ("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint")
FIVE = ", ".join(f"arm/{joint}" for joint in JOINTS)
POSE = "    from: {perception: {reliability: reliable, depth: 1}}\n    to: {task: {reliability: reliable, depth: 1}}"

MUTATIONS = [
    pytest.param("450 100 850 mm", "450 100 850 m", "implausible-distance", id="unit swapped"),
    pytest.param("0 -90 90 -90 -90 0 deg", "0 -90 90 -90 -90 0 rad", "pose-outside-limits", id="degrees as radians"),
    pytest.param("parent: gripper/base,", "parent: gripper/bas,", "unknown-frame", id="name misspelt"),
    pytest.param("client: move_group", "client: move_gruop", "unknown-node", id="node misspelt"),
    pytest.param("tip: tcp}", "tip: tpc}", "unknown-frame", id="tip misspelt"),
    pytest.param("tcp: {parent: gripper/base", "tcp: {parent: tcp", "not-a-chain", id="parent turned"),
    pytest.param("tip: tcp}", "tip: arm/wrist_1_link}", "tip-off-the-tool-chain", id="tip turned"),
    pytest.param(
        POSE, POSE.replace("reliable", "best_effort", 1), "reliability-mismatch", id="quality of service weakened"
    ),
    pytest.param("task: {reliability: reliable, depth: 1}", "task: {deadline: 150 ms, depth: 1}", "deadline-mismatch",
                 id="quality of service demanded"),
    pytest.param("run: cell_tasks/pick_place, host: control_pc, owner: integration",
                 "run: cell_tasks/pick_place, host: control_pc", "node-without-owner", id="owner dropped"),
    pytest.param("owner: safety, observer", "owner: UNKNOWN, observer", "procedure-without-owner", id="owner unknown"),
    pytest.param("driver: ur_robot_driver 3", "driver: ur_robot_driver 9", "version-not-in-matrix",
                 id="version bumped"),
    pytest.param("os: ubuntu 24.04", "os: ubuntu 20.04", "os-ros-mismatch", id="system swapped"),
    pytest.param("      device: arm\n", f"      device: arm\n      joints: [{FIVE}]\n",
                 "group-joints-without-controller", id="controller joint removed"),
    pytest.param("max_age: 200 ms", "max_age: 20 ms", "max-age-too-short", id="age cut"),
    pytest.param("rate: 30 Hz", "rate: 3 Hz", "max-age-too-short", id="rate cut"),
    pytest.param("joint: arm/wrist_3_joint", "joint: arm/wrist_4_joint", "first-motion-of-unknown-joint",
                 id="joint misspelt"),
    pytest.param("on_timeout: cancel_and_hold", "on_timeout: continue", "continues-on-timeout", id="failing open"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "code"), MUTATIONS)
def test_mutation_is_found_on_its_line(old: str, new: str, code: str, tmp_path: Path) -> None:
    assert TEXT.count(old) == 1 or code in ("max-age-too-short",), old
    file = tmp_path / "cell.yaml"
    file.write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    changed = {
        number
        for number, (before, after) in enumerate(zip(TEXT.splitlines(), file.read_text().splitlines(), strict=False), 1)
        if before != after
    }
    lines = {diagnostic.span.line for diagnostic in check(file).diagnostics if diagnostic.code == code}
    assert lines, code
    nearby = range(min(changed), min(changed) + 4)  # a topic's two ends, or its rate and its age, are near lines
    assert lines & set(nearby), (lines, changed)
