"""A cell in whose answer every kind of file has a part, alone in the current folder, with a cache of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.batch.counting import Counting, counting
from tests.cli.run import MINIMAL

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
_XACRO = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="part.xacro"/>
  <xacro:include filename="parts/*.xacro"/>
  <xacro:include filename="$(find shapes)/shape.xacro"/>
  <xacro:include filename="some_day.xacro" optional="true"/>
  <xacro:property name="facts" value="${xacro.load_yaml('facts.yaml')}"/>
  <link name="base_link"/>
  <link name="tool"/>
  <joint name="lift" type="prismatic">
    <parent link="base_link"/><child link="tool"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="${facts['stroke']}" velocity="1" effort="1"/>
  </joint>
</robot>
"""
_EMPTY = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"/>\n'
_FILES = {
    "my_robot/device.yaml": _DEVICE,
    "my_robot/robot.urdf.xacro": _XACRO,
    "my_robot/part.xacro": _EMPTY,
    "my_robot/parts/one.xacro": _EMPTY,
    "my_robot/facts.yaml": "stroke: 0.3\n",
    "src/shapes/shape.xacro": _EMPTY,
    "more.yaml": "cell: included\n",
}


@pytest.fixture(name="folder")
def folder_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of the cell, which is the current one."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    folder = tmp_path / "cell"
    monkeypatch.chdir(folder.parent)
    for name, text in _FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    text = Path(MINIMAL).read_text(encoding="utf-8").replace("model: ur5e", "model: ./my_robot")
    text = text.replace("cell: minimal", "include: more.yaml")
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture(name="computed")
def computed_fixture(monkeypatch: pytest.MonkeyPatch) -> Counting:
    """Return the count of the answers that are computed."""
    return counting(monkeypatch)
