"""Before a release people know where the joints are: by hand before an activation, by their states before a claim."""

from __future__ import annotations

import pytest

from tests.cells import built


def _gate(cell: str, code: str) -> str:
    return built(cell).texts["gates/promotion.md"].split(f"\n## {code}")[1].split("\n## ")[0].replace("\\", "")


@pytest.mark.parametrize(("cell", "devices"), [("openarm_bimanual", ["left", "right"]), ("ur5e_pick", ["gripper"])])
def test_each_device_that_its_activation_moves_is_confirmed_by_hand_before_any_of_them(
    cell: str, devices: list[str]
) -> None:
    gate = _gate(cell, "G5")
    released = gate.index("Authorize hardware that moves on activation")
    for device in devices:
        assert 0 < gate.index(f"that {device} is near the position to which activation moves it") < released


@pytest.mark.parametrize(
    ("cell", "devices"),
    [("dual_ur", ["loader", "unloader"]), ("openarm_bimanual", ["left", "right"]), ("gen3_2f", ["arm"])],
)
def test_the_joint_states_of_each_arm_are_compared_before_its_claim(cell: str, devices: list[str]) -> None:
    gate = _gate(cell, "G7")
    claim = gate.index("Authorize the claims")
    for device in devices:
        assert 0 < gate.index(f"Compare the joint states of {device} with its real position") < claim


def test_the_sentence_of_the_vendor_says_what_pulls() -> None:
    assert "Activation switches all motors on and drives the arm to its zero pose" in _gate("openarm_bimanual", "G5")
