"""Facts of one model, and findings that name every line that enters them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cells import diagnose, spec_text, written
from tests.rules.examples import Example, diagnose_example

BEYOND, CARRIED = "controller-beyond-its-group", "address-of-a-carried-device"

# From start_ursim.sh of ur_client_library 2.14.0, which refuses an earlier simulator of a model.
LEAST = {"ur5e": "5.9.4", "ur7e": "5.22.0", "ur15": "5.22.0", "ur18": "5.23.0", "ur20": "5.14.0", "ur30": "5.15.0"}


@pytest.mark.parametrize("model", LEAST)
def test_each_model_has_its_own_least_firmware(tmp_path: Path, model: str) -> None:
    least = LEAST[model]
    major, minor, _ = (int(number) for number in least.split("."))
    text = spec_text("ur5e_pick").replace("model: ur5e", f"model: {model}")
    for firmware, expected in ((f"{major}.{minor - 1}.9", [f"at least {least} "]), (least, [])):
        spec = written(tmp_path, text.replace("polyscope 5.21.0", f"polyscope {firmware}"))
        found = [item.message for item in diagnose(spec) if item.code == "firmware-outside-matrix"]
        assert len(found) == len(expected)
        assert all(part in message for part, message in zip(expected, found, strict=True))


SIDE = """devices:
  side_arm: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
control:
  controllers:
    side: {type: joint_trajectory, device: side_arm, client: task, goal_time: 1 s,
           joints: [side_arm/turn, side_arm/slide], path_tolerance: 0.1 rad 20 mm, goal_tolerance: 0.1 rad 10 mm}
motion: {groups: {side: {base: side_arm/base, tip: side_arm/arm}}}
"""


def test_a_controller_beyond_its_group_is_named_where_its_joints_are_written(folder: Path) -> None:
    (found,) = (item for item in diagnose_example(Example("yaml", SIDE), folder) if item.code == BEYOND)
    (related,) = found.related
    lines = (folder / "cell.yaml").read_text(encoding="utf-8").splitlines()
    assert lines[related.span.line - 1].strip() == "joints:"


def test_an_address_of_a_hand_names_the_arm_through_which_it_is_reached(tmp_path: Path) -> None:
    text = spec_text("fr3_hand")
    lines = text.splitlines()
    hand = next(n for n, line in enumerate(lines) if "model: franka_hand" in line)
    place = next(n for n in range(hand, len(lines)) if "connection: {" in lines[n])
    lines[place] = "    connection: {host: control_pc, nic: robot, address: 172.16.0.3}"
    (found,) = (item for item in diagnose(written(tmp_path, "\n".join(lines))) if item.code == CARRIED)
    assert found.span.line == place + 1
    assert [related.span.line for related in found.related] == [lines.index("  arm:") + 1]
