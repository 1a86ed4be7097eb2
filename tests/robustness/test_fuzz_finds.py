"""What the fuzzer found once, in its smallest form: a changed text is told on its line, where it was a traceback."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cellc.mock import MockCell, MockError, load
from cellc.pipeline import check
from cellc.vocabulary import AttemptOutcome
from tests.cells import generated, written
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


def _folder_with(folder: Path, cell: str, change: Callable[[Any, Any], None]) -> MockCell:
    """Load a generated folder whose contract and rehearsals were changed."""
    shutil.copytree(generated(cell), folder / cell)
    files = [folder / cell / name for name in ("contract.json", "rehearsals.json")]
    texts = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    change(*texts)
    for file, text in zip(files, texts, strict=True):
        file.write_text(json.dumps(text), encoding="utf-8")
    return load(folder / cell)


def test_a_grip_of_what_is_no_device_is_a_rejected_goal(tmp_path: Path) -> None:
    """`folder 109`."""

    def change(contract: Any, rehearsals: Any) -> None:
        rehearsals["rehearsals"][0]["steps"] = [{"kind": "grip", "target": "nobody", "command": "close"}]

    cell = _folder_with(tmp_path, "minimal", change)
    assert cell.run("ready").outcome == AttemptOutcome.GOAL_REJECTION


def test_a_clock_that_is_not_declared_counts_as_not_stated(tmp_path: Path) -> None:
    """`folder 3179`."""

    def change(contract: Any, rehearsals: Any) -> None:
        contract["clock_of"] = {"arm": "nobody"}

    assert _folder_with(tmp_path, "minimal", change).run("ready").passed


@pytest.mark.parametrize("section", ["goals", "poses"])
def test_a_target_of_a_group_that_is_none_is_refused(section: str, tmp_path: Path) -> None:
    def change(contract: Any, rehearsals: Any) -> None:
        entry = next(iter(contract[section].values()))
        (entry if section == "goals" else entry[0])["group"] = "nobody"

    with pytest.raises(MockError, match=rf"`{section}\..*group` must be a group of the contract, got `nobody`"):
        _folder_with(tmp_path, "ur5e_pick", change)


def test_a_controller_of_a_device_that_is_none_is_refused(tmp_path: Path) -> None:
    def change(contract: Any, rehearsals: Any) -> None:
        manager = next(iter(contract["managers"].values()))
        manager["controllers"]["arm_trajectory"]["device"] = "nobody"

    with pytest.raises(MockError, match="must be a device of the contract, got `nobody`"):
        _folder_with(tmp_path, "minimal", change)
