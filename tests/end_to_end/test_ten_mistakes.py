"""Mistakes of every family, made in a copy of the pick-and-place cell, are found on the line they were made on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from tests.cli.run import PICK


@dataclass(frozen=True)
class Mistake:
    """A text of the cell, what is written in its place, the code, and a text of the line that must be named."""

    old: str
    new: str
    code: str
    line: str = ""


MISTAKES = {
    "FRM: one calibration for two frames": Mistake(
        "calibration: tcp_2f}", "calibration: hand_eye}", "calibration-of-two-frames", line="  tcp: {parent"
    ),
    "TIM: older than one period is too old": Mistake("max_age: 200 ms", "max_age: 50 ms", "max-age-too-short"),
    "INT: an age limit without a stamp": Mistake(
        "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/Pose", "unstamped-age-limit"
    ),
    "QOS: reliable asked, best effort offered": Mistake(
        "from: {perception: {reliability: reliable, depth: 1}}",
        "from: {perception: {reliability: best_effort, depth: 1}}",
        "reliability-mismatch",
        line="to: {task: {reliability: reliable",
    ),
    "OWN: nobody approves the graph": Mistake(
        "approvals: {graph: integration, ", "approvals: {", "missing-approval", line="approvals: {time_tf"
    ),
    "VER: a package without a number": Mistake(
        "rmw: rmw_fastrtps_cpp 8.4.4", "rmw: rmw_fastrtps_cpp", "version-without-number"
    ),
    "CTL: two controllers claim the arm": Mistake(
        "device: gripper, client: task}",
        "device: gripper, client: task}\n    second: {type: joint_trajectory, device: arm, client: task, "
        "goal_time: 1 s, path_tolerance: 0.2 rad, goal_tolerance: 0.01 rad}",
        "double-claim",
        line="    second:",
    ),
    # The elbow turns by 180 deg either way (facts/robots.md, UR5e limits).
    "MOT: a pose outside of the limits": Mistake(
        "0 -90 90 -90 -90 0 deg", "0 -90 200 -90 -90 0 deg", "pose-outside-limits"
    ),
    "NET: a robot outside of the subnet": Mistake("192.168.56.101", "192.168.57.101", "device-outside-subnet"),
    "LIF: recovery without a person": Mistake(
        "fault], acknowledge: operator", "fault], acknowledge: automatic", "automatic-recovery"
    ),
    "SAF: a stop by software": Mistake("path: hardwired", "path: software", "software-stop-path"),
    "LOG: commands of a wrong owner are tolerated": Mistake(
        "wrong_owner_events: 0", "wrong_owner_events: 1", "tolerated-wrong-owner"
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistake_is_found_on_its_line(name: str, tmp_path: Path) -> None:
    mistake = MISTAKES[name]
    text = Path(PICK).read_text(encoding="utf-8")
    assert text.count(mistake.old) == 1
    file = tmp_path / "cell.yaml"
    file.write_text(text.replace(mistake.old, mistake.new), encoding="utf-8")
    found = {(diagnostic.code, diagnostic.span.line) for diagnostic in check(file).diagnostics}
    assert (mistake.code, _line_of(mistake.line or mistake.new, file)) in found
    assert mistake.code not in {code for code, _ in _found_in_the_cell()}


def _line_of(part: str, file: Path) -> int:
    lines = [number for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1) if part in line]
    assert len(lines) == 1
    return lines[0]


def _found_in_the_cell() -> set[tuple[str, int]]:
    return {(diagnostic.code, diagnostic.span.line) for diagnostic in check(PICK).diagnostics}
