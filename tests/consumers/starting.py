"""What launching a build starts, and what the started processes are told."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import yaml

from tests.consumers.launch_interpreter import Launch, Process
from tests.consumers.matrix import SPECS, Build, build

CONFIRMED = {"target": "real", "confirm_real": "I_HAVE_PASSED_GATES_G0_TO_G2"}
# What a program calls its node where launching gives no name: ros2_control_node.cpp, spawner.py.
OWN_NAMES = {"ros2_control_node": "controller_manager"}


def launched(built: Build, **given: str) -> Launch:
    """Launch the cell with arguments."""
    return Launch(built.cell, built.texts, given).run("launch/cell.launch.xml")


@lru_cache(maxsize=64)
def processes(cell: str, distro: str, target: str) -> tuple[Process, ...]:
    """Return what launching a target starts, the real one with its confirmation."""
    given = CONFIRMED if target == "real" else {}
    return tuple(launched(build(cell, distro), **given).processes)


def node_name(process: Process) -> str:
    """Return the fully qualified name of the node of a process."""
    return f"{process.namespace}/{process.name or OWN_NAMES.get(process.executable, process.executable)}"


def spawners(cell: str, distro: str, target: str = "mock") -> list[Process]:
    """Return the spawners in order."""
    return [process for process in processes(cell, distro, target) if process.executable == "spawner"]


def written(cell: str) -> Any:
    """Return the spec as plain data, read by a parser that is not cellc's."""
    return yaml.safe_load(SPECS[cell].read_text(encoding="utf-8"))


def written_managers(cell: str) -> list[tuple[str, Any]]:
    """Return namespace and text of each controller manager of the spec."""
    spec = written(cell)
    managers = list(spec.get("managers", {}).values()) or [spec["control"]]
    return [(manager.get("namespace", ""), manager) for manager in managers]
