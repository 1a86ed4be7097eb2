"""What people tell a robot, and how fast it servos, is graded by itself: each stands in a checklist or a file alone."""

from __future__ import annotations

import pytest

from cellc.tools.review.compare import changes_between
from cellc.tools.review.facts import facts_of
from tests.cells import generated

_LINES = {
    "load set in the robot": "- [ ] arm: Set the load beside the end effector of Desk: mass {}",
    "impedance of the joints": "- [ ] arm: Set the joint impedance to {}",
    "impedance at the tool": "- [ ] arm: Set the tool impedance to {}",
    "voltage of the tool connector": (
        "- [ ] Check each nameplate before plugging in: the tool connector of arm supplies {} to gripper"
    ),
}
_SERVO = "/**:\n  ros__parameters:\n    moveit_servo:\n      scale:\n        linear: {}\n"


@pytest.fixture(scope="module")
def files() -> dict[str, str]:
    folder = generated("minimal")
    found = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8") for path in found}


def _graded(files: dict[str, str], path: str, before: str, after: str) -> list[tuple[str, str]]:
    """Return grade and quantity of each change between two texts at the end of a file."""
    one, other = ({**files, path: files.get(path, "") + text} for text in (before, after))
    return [(str(change.grade), change.quantity) for change in changes_between(facts_of(one), facts_of(other))]


@pytest.mark.parametrize("quantity", _LINES)
def test_another_figure_for_the_robot_is_dangerous(quantity: str, files: dict[str, str]) -> None:
    line = _LINES[quantity]
    assert _graded(files, "gates/promotion.md", line.format("1"), line.format("2")) == [("dangerous", quantity)]


def test_faster_servoing_is_dangerous_and_slower_is_not(files: dict[str, str]) -> None:
    told = _graded(files, "config/moveit/servo.yaml", _SERVO.format(0.05), _SERVO.format(0.4))
    assert told == [("dangerous", "largest speed of servoing linear")]
    assert _graded(files, "config/moveit/servo.yaml", _SERVO.format(0.4), _SERVO.format(0.05))[0][0] == "safe"
