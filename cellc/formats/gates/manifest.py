"""Gate G0: the version tuple against what is installed and what the nameplates say."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.formats.gates.gate import Check, Gate
from cellc.formats.version_tuple import version_tuple
from cellc.graph.responsibilities import UNKNOWN

_OF_SYSTEM = {"os": "lsb_release -ds", "kernel": "uname -r", "ros": "printenv ROS_DISTRO"}
_PACKAGES = {"ros2_control": "controller_manager", "moveit": "moveit_ros_move_group"}
# Pinned as a package and its version; the rest is read on the device or its panel.
_INSTALLED = ("rmw", "driver", "sdk", "description")


def manifest(cell: Cell) -> Gate:
    """Return the gate of the powered-off inventory."""
    return Gate(
        code="G0",
        title="Manifest",
        shows="every part of the version tuple is the one that stands here",
        state="power off",
        checks=(
            Check("The manifest is that of this configuration", (f"cat generated/{cell.name}/manifest.json",)),
            *_installed(cell),
            *_read_by_people(cell),
        ),
        evidence="G0-inventory.md",
        owner=cell.spec.owners.approvals.vendor,
        stop=(f"a part that is {UNKNOWN}", "a part that differs from the tuple"),
    )


def _installed(cell: Cell) -> Iterator[Check]:
    for name, value in version_tuple(cell).items():
        command = _command(name, value)
        if command:
            yield Check(f"{name} is `{value}`", (command,))


def _read_by_people(cell: Cell) -> Iterator[Check]:
    for name, value in version_tuple(cell).items():
        if not _command(name, value):
            unknown = f"{name} is {UNKNOWN}: it is found out, and written into the spec"
            yield Check(unknown if value == UNKNOWN else f"{name} is `{value}`, by nameplate or panel")


def _command(name: str, value: str) -> str:
    part, words = name.rpartition(".")[2], value.split()
    if value == UNKNOWN:
        return ""
    if part in _OF_SYSTEM:
        return _OF_SYSTEM[part]
    if part in _PACKAGES:
        return f"ros2 pkg xml -t version {_PACKAGES[part]}"
    return f"ros2 pkg xml -t version {words[0]}" if part in _INSTALLED and len(words) == 2 else ""
