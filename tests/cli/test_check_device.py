"""A device is checked by itself: its shape, its names, its figures and its description, at their lines."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.compiler.catalog.compiled import device_file
from cellc.compiler.catalog.load import device_names
from tests.cells import ROOT
from tests.cli.run import run
from tests.cli.test_bad_device_folders import BROKEN

ARM = ROOT / "tests/corpus/invalid/base/demo_arm"
FILE = "my_robot/device.yaml"


@pytest.fixture
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the demo arm's folder in the current folder."""
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copytree(ARM, tmp_path / "my_robot"))


@pytest.mark.parametrize("named", ["my_robot", FILE])
def test_a_sound_device_passes_by_its_folder_and_by_its_file(arm: Path, named: str) -> None:
    ran = run("check", named)
    assert (ran.code, ran.out) == (0, f"no findings in {FILE}\n")


def test_a_device_in_the_current_folder_passes(arm: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(arm)
    assert run("check", "device.yaml").code == 0
    assert run("check", ".").code == 0


@pytest.mark.parametrize("name", device_names())
def test_every_device_of_the_catalog_passes(name: str) -> None:
    ran = run("check", device_file(name).as_posix())
    assert ran.code == 0, ran.out


CHANGES = {
    "a key that is not there": ("vendor:", "vendour:", "there is no key `vendour`"),
    "a kind that is none": ("kind: arm", "kind: robot", "kind"),
    "a link that is not there": ("base: base_link", "base: base_lnk", "no link `base_lnk`"),
    "a home beyond its limits": ("packages:", "home: {elbow_joint: 400 deg}\npackages:", "home"),
    "a limit in another unit": (
        "  acceleration:",
        "  velocity_everywhere: {'*': {value: 1 m/s, source: x}}\n  acceleration:",
        "must be in `rad/s`",
    ),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_what_is_wrong_in_the_file_is_told_at_its_line(arm: Path, change: tuple[str, str, str]) -> None:
    before, after, told = change
    file = arm / "device.yaml"
    text = file.read_text(encoding="utf-8")
    assert before in text
    file.write_text(text.replace(before, after, 1), encoding="utf-8")
    ran = run("check", "my_robot")
    line = text[: text.index(before)].count("\n") + 1
    assert ran.code == 1
    assert told in ran.out
    assert f"--> {FILE}:{line}:" in ran.out


def test_what_is_wrong_in_its_description_is_told_there(arm: Path) -> None:
    (urdf,) = arm.glob("*.urdf")
    urdf.write_text(urdf.read_text(encoding="utf-8").replace('lower="-', 'lower="9'), encoding="utf-8")
    ran = run("check", "my_robot", "--format", "json")
    assert ran.code == 1
    assert urdf.name in ran.out


@pytest.mark.parametrize(("device", "xacro", "told"), BROKEN.values(), ids=BROKEN)
def test_a_folder_that_a_cell_cannot_use_is_refused_by_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, device: str, xacro: str | None, told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my_robot").mkdir()
    (tmp_path / FILE).write_text(device, encoding="utf-8")
    if xacro is not None:
        (tmp_path / "my_robot/robot.urdf.xacro").write_text(xacro, encoding="utf-8")
    ran = run("check", FILE)
    assert ran.code == 1
    assert told in ran.out
    assert "bug of cellc" not in ran.out + ran.err


@pytest.mark.parametrize(
    "command",
    [
        ("audit", FILE),
        ("build", FILE),
        ("build", "--check", "my_robot"),
        ("compare", FILE, FILE),
        ("diff", FILE, FILE),
        ("show", FILE, "devices"),
        ("upgrade", FILE, "--ros", "kilted"),
    ],
    ids=" ".join,
)
def test_every_command_that_needs_a_cell_says_that_a_device_is_none(arm: Path, command: tuple[str, ...]) -> None:
    ran = run(*command)
    assert ran.code in (1, 2)
    assert f"`{FILE}` is a device, not a cell" in ran.out + ran.err
    assert "bug of cellc" not in ran.out + ran.err


def test_fix_gives_a_device_the_schema_of_devices(arm: Path) -> None:
    (arm.parent / "schemas").mkdir()
    (arm.parent / "schemas/cell.schema.json").write_text("{}")
    (arm.parent / "schemas/device.schema.json").write_text("{}")
    assert run("check", "--fix", "my_robot").code == 0
    assert (
        (arm / "device.yaml")
        .read_text(encoding="utf-8")
        .startswith("# yaml-language-server: $schema=../schemas/device.schema.json\n")
    )
