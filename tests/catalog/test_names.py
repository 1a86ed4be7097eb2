"""A name in a device.yaml that nothing has is a finding at its line, with the names that exist."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.compiler.catalog.load import load_device_folder
from tests.cells import ROOT

PARTS = ROOT / "tests/corpus/valid/parts"


@pytest.mark.parametrize(
    ("device", "old", "new", "message"),
    [
        ("demo_camera", "qos: default", "qos: nobody", "the catalog has no QoS profile `nobody`"),
        ("demo_camera", "info_qos: default", "info_qos: nobody", "the catalog has no QoS profile `nobody`"),
        ("demo_camera", "optical_frames: [color_optical]", "optical_frames: [nobody]", "no link `nobody`"),
        ("demo_camera", "frame: color_optical\n", "frame: nobody\n", "the description has no link `nobody`"),
        ("demo_gripper", "jerk: {finger_joint", "jerk: {nobody", "the description has no joint `nobody`"),
        ("demo_gripper", "acceleration: {finger_joint", "acceleration: {nobody", "no joint `nobody`"),
        ("demo_gripper", "  joint: finger_joint", "  joint: nobody", "the description has no joint `nobody`"),
        ("demo_arm", '  joints: {"*": {', "  joints: {nobody: {", "the description has no joint `nobody`"),
        ("demo_arm", "tool_frame: tool0", "tool_frame: nobody", "the description has no link `nobody`"),
        (
            "demo_gripper",
            "gripper:\n",
            "services: [{name: /open, type: std_srvs/srv/Trigger, server: nobody}]\ngripper:\n",
            "the device has no node `nobody`",
        ),
    ],
)
def test_name_of_nothing_is_found_at_its_line(device: str, old: str, new: str, message: str, tmp_path: Path) -> None:
    folder = tmp_path / device
    shutil.copytree(PARTS / device, folder)
    text = (folder / "device.yaml").read_text(encoding="utf-8")
    assert old in text
    changed = text.replace(old, new, 1)
    (folder / "device.yaml").write_text(changed, encoding="utf-8")
    loaded = load_device_folder(folder, tmp_path)
    assert loaded.value is None
    (found,) = loaded.diagnostics
    assert (found.code, found.message.endswith(message)) == ("catalog-entry-invalid", True)
    assert "nobody" in changed.splitlines()[found.span.line - 1]


@pytest.mark.parametrize(
    ("device", "old", "new", "message"),
    [
        (
            "demo_arm",
            "{command: [position,",
            "{command: [postion,",
            "the standard of ros2_control has no interface `postion`",
        ),
        ("demo_arm", "state: [position, velocity]}}", "state: [position, velocty]}}", "has no interface `velocty`"),
        (
            "demo_arm",
            "initial: {speed_scaling_factor",
            "initial: {speed_scaling",
            "the gpio has no interface `speed_scaling`",
        ),
        (
            "demo_arm",
            "tool_frame:",
            "home: {joint_1: 400 deg}\ntool_frame:",
            "must lie from -6.28319 to 6.28319, got 6.98132",
        ),
    ],
)
def test_slip_in_an_interface_and_home_past_a_limit_are_found_at_their_line(
    device: str, old: str, new: str, message: str, tmp_path: Path
) -> None:
    folder = tmp_path / device
    shutil.copytree(PARTS / device, folder)
    text = (folder / "device.yaml").read_text(encoding="utf-8")
    assert old in text
    changed = text.replace(old, new, 1)
    (folder / "device.yaml").write_text(changed, encoding="utf-8")
    (found,) = load_device_folder(folder, tmp_path).diagnostics
    assert found.code == "catalog-entry-invalid"
    assert message in found.message
    assert new.split("\n")[0] in changed.splitlines()[found.span.line - 1]


def test_interface_that_is_no_slip_of_a_standard_one_is_a_vendors_own(tmp_path: Path) -> None:
    folder = tmp_path / "demo_arm"
    shutil.copytree(PARTS / "demo_arm", folder)
    file = folder / "device.yaml"
    own = file.read_text(encoding="utf-8").replace(
        "{command: [position,", "{command: [torque_offset, position_2nd_encoder,", 1
    )
    file.write_text(own, encoding="utf-8")
    assert load_device_folder(folder, tmp_path).diagnostics == ()


@pytest.mark.parametrize(
    ("device", "old", "new", "message"),
    [
        ("stage", "slide: {value: 5 m/s^2", "slide: {value: 5 rad/s^2", "in `m/s^2`, got 5 rad/s^2"),
        ("stage", "turn: {value: 50 rad/s^3", "turn: {value: 50 m/s^3", "in `rad/s^3`, got 50 m/s^3"),
        ("lift", "slide: {value: 20 m/s^3, source: made up}, ", "", "`jerk` of `slide`, which is prismatic, must be"),
        ("demo_gripper", "closed: 40 mm", "closed: 2 deg", "`closed` of `finger_joint`, which is prismatic, must be"),
    ],
)
def test_figure_of_another_unit_than_its_joint_is_found_at_its_line(
    device: str, old: str, new: str, message: str, tmp_path: Path
) -> None:
    shutil.copytree(PARTS / device, tmp_path / device)
    file = tmp_path / device / "device.yaml"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    (found,) = load_device_folder(tmp_path / device, tmp_path).diagnostics
    assert message in found.message
    assert found.span.line == text[: text.index(old)].count("\n") + 1


@pytest.mark.parametrize(
    ("old", "new", "message", "help_text"),
    [
        ("kind: arm", "kind: arn", "`kind` must be one of its choices, got the text `arn`", "did you mean `arm`?"),
        ("base: rail", "base: 3", "expected text for `base`, got the number `3`", 'put it in quotes: `"3"`'),
        ("{file: lift.urdf}", "lift.urdf", "expected a mapping for `description`", "write a mapping"),
        ("as_of: 2026-07-01", "as_of: July", "`July` cannot be used as `as_of`", "write the day as `2026-07-01`"),
        ("model: lift", "model: my lift", "`my lift` cannot be used as `model`", "use letters, digits and `_`"),
        ("slide: {value: 2 m/s^2", "slide: {value: 2 kg", "`kg` is not a unit of", "write a number and the unit"),
    ],
)
def test_wrong_value_is_told_in_the_words_of_the_spec(
    old: str, new: str, message: str, help_text: str, tmp_path: Path
) -> None:
    shutil.copytree(PARTS / "lift", tmp_path / "lift")
    file = tmp_path / "lift" / "device.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    (found,) = load_device_folder(tmp_path / "lift", tmp_path).diagnostics
    assert found.message.startswith(message)
    assert found.help.startswith(help_text)
