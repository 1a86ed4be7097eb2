"""`cellc init` of any devices of the catalog makes a cell that passes; each device stands where its kind stands."""

from __future__ import annotations

import itertools
import random
from pathlib import Path

import pytest

from cellc.compiler.catalog.load import device_names, load_device
from cellc.compiler.catalog.starter_mounts import mounts_of
from tests.cli.run import run

_ON_ARMS = {"gripper", "hand", "camera", "sensor"}
_UNDER_ARMS = {"axis", "base"}
_SUBSETS = [random.Random(seed).sample(device_names(), 1 + seed % 6) for seed in range(8)]
_ONE_OF_A_KIND = ["ur5e", "linear_axis", "belt_conveyor", "guard_door", "part_fixture", "digital_io", "realsense_d435i"]
_TWO_RATES = ["ur5e", "franka_fr3", "robotiq_2f_85", "franka_hand", "pedestal"]


def _kinds() -> dict[str, str]:
    found = {name: load_device(name).value for name in device_names()}
    return {name: one.model.kind for name, one in found.items() if one is not None}


def _mounts(*names: str) -> dict[str, str]:
    found = {name: load_device(name).value for name in names}
    return mounts_of({name: one.model for name, one in found.items() if one is not None})


@pytest.mark.parametrize("models", [_ONE_OF_A_KIND, _TWO_RATES, *_SUBSETS], ids=lambda models: "-".join(models))
def test_a_cell_of_any_devices_passes_and_moves(
    models: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("init", "bench", *models).code == 0
    checked = run("check", "cells/bench/cell.yaml")
    assert checked.code == 0, checked.out + checked.err
    assert run("build", "cells/bench/cell.yaml").code == 0
    ran = run("mock", "generated/bench")
    assert (ran.code, "passed  ready: succeeded" in ran.out) == (0, True), ran.out + ran.err


def test_of_any_two_devices_only_tools_stand_on_an_arm() -> None:
    kinds = _kinds()
    for one, other in itertools.permutations(device_names(), 2):
        mounts = _mounts(one, other)
        carrier = mounts[one].partition("parent: ")[2].partition("/")[0]
        if carrier == other and kinds[other] == "arm":
            assert kinds[one] in _ON_ARMS, (one, other)
        elif carrier == other:
            assert (kinds[one], kinds[other] in _UNDER_ARMS) == ("arm", True), (one, other)
        else:
            assert mounts[one].startswith("{parent: world, xyz: "), (one, other)


def test_tool_hangs_on_the_sensor_of_its_arm_and_arm_stands_on_the_rail() -> None:
    names = ("ur5e", "robotiq_2f_85", "ati_axia80", "linear_axis", "realsense_d435i")
    mounts = _mounts(*names)
    assert mounts == {
        "linear_axis": "{parent: world, xyz: 0 0 0 m}",
        "ur5e": "{parent: linear_axis/mount}",
        "ati_axia80": "{parent: ur5e/tool0}",
        "robotiq_2f_85": "{parent: ati_axia80/tool_mount}",
        "realsense_d435i": "{parent: ur5e/tool0, xyz: 0 -110 30 mm}",
    }


def test_outputs_without_an_io_device_get_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    ran = run("init", "bench", "signal_lamp", "part_fixture")
    assert "added io: digital_io, for the outputs of digital, fixture\n" in ran.out
    text = (tmp_path / "cells" / "bench" / "cell.yaml").read_text(encoding="utf-8")
    assert "switching: {outputs: {light: io/io/out_0}}" in text
    assert '"command_interfaces.{prefix}io.interfaces": [out_0, out_1]' in text
