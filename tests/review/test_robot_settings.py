"""What people set in a robot, and how fast it servos, is graded by itself: the contract or one file has each."""

from __future__ import annotations

import json

import pytest

from cellc.contract.gates import GATES
from cellc.tools.review.facts import CONTRACT, Facts, FactsError, facts_of
from tests.cells import generated
from tests.review.edits import changes_between

_SETTINGS = {
    "robot payload mass": ("payload", "mass", "{} kg"),
    "robot TCP xyz": ("tcp", "xyz", "0.00 0.00 {}.00 mm"),
    "load set in the robot": ("load", "does", "Set the load beside the end effector of Desk: mass {}"),
    "collision thresholds set in the robot": ("thresholds", "does", "Have the adapter set the thresholds to {} Nm"),
    "impedance of the joints": ("joint_impedance", "does", "Set the joint impedance to {}"),
    "impedance at the tool": ("tool_impedance", "does", "Set the tool impedance to {}"),
    "tool connector voltage": ("tool_voltage", "voltage", "{} V"),
    "first motion largest move": ("first_motion", "max_delta", "{} deg"),
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


def _with_setting(files: dict[str, str], sets: str, name: str, value: str) -> Facts:
    contract = json.loads(files[CONTRACT])
    contract["gates"]["settings"] = [{"gate": "G5", "sets": sets, "device": "arm", "values": {name: value}}]
    return facts_of({**files, CONTRACT: json.dumps(contract)})


@pytest.mark.parametrize("quantity", _SETTINGS)
def test_another_figure_for_the_robot_is_dangerous(quantity: str, files: dict[str, str]) -> None:
    sets, name, value = _SETTINGS[quantity]
    before, after = (_with_setting(files, sets, name, value.format(figure)) for figure in ("1", "2"))
    changes = changes_between(before, after)
    assert [(str(change.grade), change.quantity) for change in changes] == [("dangerous", quantity)]


def test_another_unit_of_the_same_figure_is_no_change(files: dict[str, str]) -> None:
    before, after = (_with_setting(files, "payload", "mass", value) for value in ("1.2 kg", "1200 g"))
    assert not changes_between(before, after)


def test_a_version_that_is_no_longer_fit_is_dangerous(files: dict[str, str]) -> None:
    contract = json.loads(files[CONTRACT])
    known = next(pin for pin in contract["gates"]["versions"] if pin["answer"] == "OK")
    known["answer"] = "INCOMPATIBLE"
    (change,) = changes_between(facts_of(files), facts_of({**files, CONTRACT: json.dumps(contract)}))
    assert (str(change.grade), change.quantity) == ("dangerous", "compatibility matrix")


def test_a_package_without_gates_as_data_is_compared_by_its_checklists(files: dict[str, str]) -> None:
    contract = json.loads(files[CONTRACT])
    gates = contract.pop("gates")
    older = {**files, CONTRACT: json.dumps(contract)}
    assert not changes_between(facts_of(older), facts_of(files))
    # Between the two, a file of its own had them.
    assert not changes_between(facts_of({**older, GATES: json.dumps({"format": 1, **gates})}), facts_of(files))


def test_settings_of_a_folder_are_read_as_untrusted(files: dict[str, str]) -> None:
    with pytest.raises(FactsError, match=r"contract\.json: `gates\.settings"):
        _with_setting(files, "firmware", "version", "1")


def test_faster_servoing_is_dangerous_and_slower_is_not(files: dict[str, str]) -> None:
    told = _graded(files, "config/moveit/servo.yaml", _SERVO.format(0.05), _SERVO.format(0.4))
    assert told == [("dangerous", "largest speed of servoing linear")]
    assert _graded(files, "config/moveit/servo.yaml", _SERVO.format(0.4), _SERVO.format(0.05))[0][0] == "safe"
