"""What the fuzzer found once, in its smallest form: a changed text is told on its line, where it was a traceback."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.pipeline import check
from tests.cells import written
from tests.robustness.fuzz.bases import PARTS

HEAD = "format: 1\ncell: found\nversions: {ros: jazzy}\n"
MOUNTED = HEAD + "devices: {it: {model: ./device, mount: {parent: world}}}\n"

IN_A_DEVICE = [
    pytest.param("demo_camera", "      qos: default", "      qos: nobody", id="device 34: a profile that nobody knows"),
    pytest.param("demo_camera", "info_qos: default", "info_qos: nobody", id="the same of the calibration"),
    pytest.param(
        "demo_camera", "optical_frames: [color_optical]", "optical_frames: [nobody]", id="device 337: an optical frame"
    ),
    pytest.param("demo_camera", "      frame: color_optical", "      frame: nobody", id="the frame of a stream"),
    pytest.param("demo_arm", "tool_frame: tool0", "tool_frame: nobody", id="the frame of tools"),
]


@pytest.mark.parametrize(("device", "old", "new"), IN_A_DEVICE)
def test_a_changed_device_is_told_on_its_line(device: str, old: str, new: str, tmp_path: Path) -> None:
    shutil.copytree(PARTS / device, tmp_path / "device")
    file = tmp_path / "device" / "device.yaml"
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")
    line = text[: text.index(old)].count("\n") + 1
    found = check(written(tmp_path, MOUNTED)).diagnostics
    assert (Path(file).name, line) in {(Path(one.span.file).name, one.span.line) for one in found}
