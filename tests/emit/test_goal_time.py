"""The time that a controller allows past the end of a trajectory bounds no whole goal, wherever it is written."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest

from cellc.contract.contract import Contract
from cellc.mock import MockCell, load
from cellc.mock.task.bounds import goal_timeout_s
from tests.cells import CORPUS, build_into, built

ACTION = "/arm_trajectory/follow_joint_trajectory"
DIRECT = CORPUS / "valid" / "direct_sdk_arm.yaml"


@pytest.mark.parametrize("file", ["graph/responsibility.svg", "audit.md"])
def test_action_of_a_controller_has_no_timeout(file: str) -> None:
    # `goal_time: 1 s` in the spec; its goals take three seconds and more.
    text = built("ur5e_pick").texts[file]
    assert "timeout after 1 s" not in text
    assert ACTION in text


def test_picture_says_how_late_a_trajectory_may_end() -> None:
    sheet = fromstring(built("ur5e_pick").texts["graph/responsibility.svg"])
    said = [text.text or "" for text in sheet.iter("{http://www.w3.org/2000/svg}text")]
    below = " ".join(said[said.index(ACTION) :][:5])
    assert "no timeout stated, ends at most 1 s after its trajectory" in below


def test_contract_keeps_goal_time_and_timeout_apart() -> None:
    contract = Contract.model_validate_json(built("ur5e_pick").texts["contract.json"])
    interface = contract.interfaces[ACTION]
    assert (interface.timeout_s, interface.on_timeout) == (None, None)
    assert contract.managers["control"].controllers["arm_trajectory"].goal_time_s == 1.0
    assert contract.interfaces["/move_action"].timeout_s == 90.0


def direct(folder: Path, adapter: str, rehearsals: str = "rehearsals:\n") -> MockCell:
    """Return the mock of the arm behind its own library, with other bounds of its adapter."""
    spec = DIRECT.read_text(encoding="utf-8").replace("stop_time: 100 ms", adapter).replace("rehearsals:\n", rehearsals)
    path = folder / "direct.yaml"
    path.write_text(spec, encoding="utf-8")
    shutil.copytree(DIRECT.parent / "parts", folder / "parts")
    return load(build_into(folder / "generated", path))


def test_device_of_a_library_takes_the_bounds_of_the_spec(tmp_path: Path) -> None:
    adapter = direct(tmp_path, "goal_time: 2 s, path_tolerance: 0.3 rad").contract.adapters["arm"]
    assert (adapter.goal_time_s, adapter.path_tolerance, adapter.stop_time_s) == (2.0, 0.3, 0.1)


@pytest.mark.parametrize(
    ("bounds", "outcome"),
    [
        ("path_tolerance: 0.05 rad", "tolerance_violation"),
        ("path_tolerance: 3 rad", "tolerance_violation"),  # it is not there in time
        ("path_tolerance: 3 rad, goal_time: 30 s", "succeeded"),
    ],
)
def test_mock_ends_a_goal_of_a_library_by_the_bounds_of_the_spec(tmp_path: Path, bounds: str, outcome: str) -> None:
    slow = "{slow: arm/joint_1, to: 0.05 rad/s, at: {step: 2, when: moving}, lasting: 4 s}"
    slowed = f"rehearsals:\n  slowed: {{use: reach, inject: {slow}}}\n"
    cell = direct(tmp_path, bounds, slowed)
    assert cell.run("slowed").outcome == outcome


def test_goal_of_a_library_has_the_timeout_of_its_own_action_where_nobody_plans(tmp_path: Path) -> None:
    contract = load(build_into(tmp_path / "generated", DIRECT)).contract
    alone = {name: each for name, each in contract.interfaces.items() if name != "/move_action"}
    action = replace(alone["/arm/follow_joint_trajectory"], timeout_s=7.0)
    contract = contract.model_copy(update={"interfaces": alone | {"/arm/follow_joint_trajectory": action}})
    assert goal_timeout_s(contract, "arm") == 7.0
