"""What the fuzzer found once, in its smallest form: a changed text is told on its line, where it was a traceback."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.diagnostics import Severity
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell, MockError, load
from cellc.robot.planning import RobotModel
from tests.cells import build_into, generated, written
from tests.robustness.fuzz import bases
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
    pytest.param("stage", "{turn: {value: 5 rad/s^2", "{turn: {value: 0 rad/s^2", id="device 483: no acceleration"),
    pytest.param("demo_arm", "tool_frame: tool0", "tool_frame: nobody", id="the frame of tools"),
]


IN_A_DESCRIPTION = [
    pytest.param("stage", 'velocity="1" effort="10"/>\n  </joint>\n  <joint name="slide"',
                 'velocity="1" effort="many"/>\n  </joint>\n  <joint name="slide"', id="description 7276: effort"),
]  # fmt: skip


@pytest.mark.parametrize(("device", "old", "new"), [*IN_A_DEVICE, *IN_A_DESCRIPTION])
def test_a_changed_device_is_told_on_its_line(device: str, old: str, new: str, tmp_path: Path) -> None:
    shutil.copytree(PARTS / device, tmp_path / "device")
    file = tmp_path / "device" / (f"{device}.urdf" if "<joint" in old else "device.yaml")
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")
    line = text[: text.index(old)].count("\n") + 1
    found = check(written(tmp_path, MOUNTED)).diagnostics
    assert (Path(file).name, line) in {(Path(finding.span.file).name, finding.span.line) for finding in found}


def _folder_with(folder: Path, cell: str, change: Callable[[Any, Any], None]) -> MockCell:
    """Load a generated folder whose contract and rehearsals were changed."""
    shutil.copytree(generated(cell), folder / cell)
    files = [folder / cell / name for name in ("contract.json", "rehearsals.json")]
    texts = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    change(*texts)
    for file, text in zip(files, texts, strict=True):
        file.write_text(json.dumps(text), encoding="utf-8")
    return load(folder / cell, edited=True)


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


def _first_group(contract: Any) -> Any:
    return next(iter(contract["groups"].values()))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        pytest.param(lambda group, pose: group.update(joints=[]), "`poses.ready", id="folder 3694: no joint"),
        pytest.param(lambda group, pose: pose.update(positions=[0.0]), "must be 6 positions, got 1", id="folder 3195"),
    ],
)
def test_a_group_and_its_poses_fit_each_other(change: Callable[[Any, Any], None], reason: str, tmp_path: Path) -> None:
    def changed(contract: Any, rehearsals: Any) -> None:
        change(_first_group(contract), contract["poses"]["ready"][0])

    with pytest.raises(MockError, match=reason):
        _folder_with(tmp_path, "minimal", changed)


def test_a_group_without_a_joint_is_refused(tmp_path: Path) -> None:
    def change(contract: Any, rehearsals: Any) -> None:
        _first_group(contract)["joints"] = []
        contract["poses"] = {}

    with pytest.raises(MockError, match="group `manipulator` has no joint"):
        _folder_with(tmp_path, "minimal", change)


def test_a_fixed_joint_follows_no_other() -> None:
    """`folder 9018`; the joint is none to pinocchio."""
    limits = '<limit lower="-1" upper="1" velocity="1" effort="1"/>'
    turn = f'<joint name="turn" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>{limits}</joint>'
    stiff = '<joint name="stiff" type="fixed"><parent link="b"/><child link="c"/><mimic joint="turn"/></joint>'
    robot = RobotModel.from_urdf(
        f'<robot name="r"><link name="a"/><link name="b"/><link name="c"/>{turn}{stiff}</robot>'
    )
    assert robot.link_pose("c", {"turn": 0.5}, base_link="b").position == (0.0, 0.0, 0.0)


def test_a_motion_that_nanoseconds_cannot_count_is_not_planned(tmp_path: Path) -> None:
    """`folder 944`."""

    def change(contract: Any, rehearsals: Any) -> None:
        for limits in contract["joint_limits"].values():
            limits.update(velocity=1e-9, acceleration=1e-9, jerk=1e-9)

    cell = _folder_with(tmp_path, "ur5e_pick", change)
    result = cell.run(cell.rehearsals[0])
    assert result.outcome == AttemptOutcome.PLANNING_FAILURE
    assert "s are planned" in result.reason


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        pytest.param("stage.urdf", 'upper="0.5"', 'upper="1e16"', id="description 3071: a limit that there is not"),
        pytest.param("stage.urdf", 'velocity="1"', 'velocity="1e16"', id="a speed that there is not"),
    ],
)
def test_what_exporters_write_for_no_limit_is_none(file: str, old: str, new: str, tmp_path: Path) -> None:
    shutil.copytree(PARTS / "stage", tmp_path / "device")
    text = (tmp_path / "device" / file).read_text(encoding="utf-8")
    (tmp_path / "device" / file).write_text(text.replace(old, new, 1), encoding="utf-8")
    spec = written(tmp_path, bases.TINY[1].replace("./parts/stage", "./device"))
    assert load(build_into(tmp_path / "folder", spec)).run("there").passed


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


def _tiny_with(folder: Path, old: str, new: str) -> Path:
    """Write the cell of the stage with a change of its description; ``back`` is a second pose."""
    shutil.copytree(PARTS / "stage", folder / "device")
    file = folder / "device" / "stage.urdf"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    return written(folder, bases.TINY[1].replace("./parts/stage", "./device"))


def test_a_cell_whose_mesh_is_not_there_runs_and_says_what_nobody_sees(tmp_path: Path) -> None:
    """`description 2105`; the check warns of the mesh, and the mock plans with the shapes that are there."""
    shape = '<link name="tool"><collision><geometry><mesh filename="arm/base_link"/></geometry></collision></link>'
    spec = _tiny_with(tmp_path, '<link name="tool"/>', shape)
    assert {diagnostic.code for diagnostic in check(spec).diagnostics if diagnostic.severity is Severity.ERROR} == set()
    cell = load(build_into(tmp_path / "folder", spec))
    result = cell.run("there")
    assert (result.outcome, result.unseen) == (AttemptOutcome.SUCCEEDED, ("stage_tool",))
    assert [note for note in cell.notes if "1 that move, `stage_tool`" in note]


@pytest.mark.parametrize("limit", ["acceleration", "jerk"])
def test_a_joint_of_a_group_without_a_limit_is_told(limit: str, tmp_path: Path) -> None:
    """`description 7289`; the mock does not load such a group."""
    spec = _tiny_with(tmp_path, "<robot", "<robot")
    facts = tmp_path / "device" / "device.yaml"
    kept = [line for line in facts.read_text(encoding="utf-8").splitlines() if not line.startswith(f"  {limit}:")]
    facts.write_text("\n".join(kept), encoding="utf-8")
    assert "unplannable-joint" in {diagnostic.code for diagnostic in check(spec).diagnostics}


def test_a_joint_of_a_group_without_a_range_is_told(tmp_path: Path) -> None:
    spec = _tiny_with(tmp_path, 'lower="-3" upper="3"', 'lower="0" upper="0"')
    assert "unplannable-joint" in {diagnostic.code for diagnostic in check(spec).diagnostics}
