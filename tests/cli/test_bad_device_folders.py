"""A device of the user's own, `model: ./my_robot`, broken in one way: the place, and the line that names it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.refused import assert_refused
from tests.cli.run import MINIMAL, run

_DEVICE = """\
format: 1
model: my_robot
vendor: me
summary: one joint
kind: arm
as_of: 2026-07-01
sources: [own drawing]
description: {file: robot.urdf.xacro}
base: base_link
frames: {base_link: base_link}
packages: {}
"""
_XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">BODY</robot>\n'


def _cell(tmp_path: Path, device: str, xacro: str | None) -> str:
    text = Path(MINIMAL).read_text(encoding="utf-8").replace("model: ur5e", "model: ./my_robot")
    (tmp_path / "cell.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "my_robot").mkdir()
    (tmp_path / "my_robot/device.yaml").write_text(device, encoding="utf-8")
    if xacro is not None:
        (tmp_path / "my_robot/robot.urdf.xacro").write_text(xacro, encoding="utf-8")
    return (tmp_path / "cell.yaml").as_posix()


BROKEN = {
    "empty device.yaml": ("", "", "empty-file"),
    "device.yaml that is no YAML": ("kind: [arm", "", "not-yaml"),
    "device.yaml with an unknown key": (_DEVICE + "frobnicate: 3\n", "", "there is no key `frobnicate`"),
    "device.yaml without a key": (_DEVICE.replace("base: base_link\n", ""), "", "`base` is missing"),
    "no description": (_DEVICE, None, "xacro-file-not-found"),
    "description that is no XML": (_DEVICE, "<robot><link", "xml-not-well-formed"),
    "description without the base": (_DEVICE, _XACRO.replace("BODY", '<link name="l"/>'), "no link `base_link`"),
    "include out of the folder": (
        _DEVICE,
        _XACRO.replace("BODY", '<xacro:include filename="../../../../../etc/passwd"/>'),
        "xacro-outside-root",
    ),
    "include from the root": (
        _DEVICE,
        _XACRO.replace("BODY", '<xacro:include filename="/etc/passwd"/>'),
        "xacro-outside-root",
    ),
    "expression that runs a command": (
        _DEVICE,
        _XACRO.replace("BODY", "<link name=\"${__import__('os').getcwd()}\"/>"),
        "xacro-refused-expression",
    ),
    "substitution that asks the environment": (
        _DEVICE,
        _XACRO.replace("BODY", '<link name="$(env HOME)"/>'),
        "xacro-refused-substitution",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_device_folder_is_reported_with_the_line_that_names_it(name: str, tmp_path: Path) -> None:
    device, xacro, words = BROKEN[name]
    file = _cell(tmp_path, device, xacro)
    ran = run("check", file)
    assert_refused(ran, words)
    lines = Path(file).read_text().splitlines()
    number = next(number for number, text in enumerate(lines, 1) if "my_robot" in text)
    assert f"{file}:{number}:12" in ran.out


def test_line_of_a_device_and_of_its_description_is_shown(tmp_path: Path) -> None:
    spec = _cell(tmp_path, _DEVICE + "frobnicate: 3\n", "")
    for _ in range(2):  # computed, and kept
        assert "\n12 | frobnicate: 3\n   | ^^^^^^^^^^" in run("check", spec).out
    (tmp_path / "my_robot/device.yaml").write_text(_DEVICE, encoding="utf-8")
    link = '<xacro:include filename="none.xacro"/>'
    (tmp_path / "my_robot/robot.urdf.xacro").write_text(_XACRO.replace("BODY", link), encoding="utf-8")
    assert f"{link}</robot>\n" in run("check", spec).out


def test_line_that_would_steer_a_terminal_is_not_shown(tmp_path: Path) -> None:
    spec = _cell(tmp_path, _DEVICE, _XACRO.replace("BODY", "<link/>\u202e"))
    out = run("check", spec).out
    assert "robot.urdf.xacro" in out
    assert "\u202e" not in out


@pytest.mark.parametrize(
    "name", ["cell.yaml", "my_robot/device.yaml", "my_robot/robot.urdf.xacro", "my_robot/robot.urdf"]
)
@pytest.mark.parametrize(
    "secret", ["root:x:0:0:secret\n", "secret: {a: secret}\n", "<secret/>\n", "<robot name='secret'>\n"]
)
def test_nothing_is_shown_of_a_file_that_a_link_leads_to(name: str, secret: str, tmp_path: Path) -> None:
    folder = tmp_path / "cell"
    folder.mkdir()
    device = _DEVICE.replace("robot.urdf.xacro", "robot.urdf") if name.endswith(".urdf") else _DEVICE
    spec = _cell(folder, device, _XACRO)
    (tmp_path / "outside").write_text(secret, encoding="utf-8")
    (folder / name).unlink(missing_ok=True)
    (folder / name).symlink_to(tmp_path / "outside")
    for arguments in (("check", spec), ("check", spec, "--format", "json"), ("build", spec), ("show", spec)):
        out = run(*arguments).out
        assert "secret" not in out
        assert "root:x" not in out
