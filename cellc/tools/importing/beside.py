"""What a vendor lays beside a description: an SRDF of the same robot, and parameters of its controllers."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from cellc.contract.limits import limits
from cellc.contract.store.regular_file import read_regular
from cellc.robot.description.packages import MANIFEST
from cellc.robot.description.xml_tree import read_xml
from cellc.robot.description.yaml_values import load_values

_PARAMETERS = "ros__parameters"
_DEFAULT_HZ, _DEFAULT_S = 100.0, 1.0


@dataclass(frozen=True, slots=True)
class ControllerFacts:
    """What a first cell takes from the parameters of controllers: Hz and s, and the file, or None."""

    update_rate_hz: float = _DEFAULT_HZ
    goal_time_s: float = _DEFAULT_S
    file: Path | None = None


def semantic_file(description: Path, robot: str) -> Path | None:
    """Return the one SRDF of a robot near its description; of several that which has the name of the description."""
    matching = [file for file in _near(description, ".srdf") if _robot_of(file) == robot]
    alike = [file for file in matching if file.stem == description.name.partition(".")[0]]
    return matching[0] if len(matching) == 1 else alike[0] if len(alike) == 1 else None


def _robot_of(file: Path) -> str | None:
    root = read_xml(_text(file, limits().xml_bytes), file.as_posix()).value
    return None if root is None or root.tag != "robot" else root.attributes.get("name")


def controllers_near(description: Path, joints: Sequence[str]) -> ControllerFacts:
    """Return what the one file near a description says that has a trajectory controller of all of some joints."""
    controllers = [
        facts for file in _near(description, ".yaml") if (facts := read_controllers(file, joints)) is not None
    ]
    return controllers[0] if len(controllers) == 1 else ControllerFacts()


def read_controllers(file: Path, joints: Sequence[str]) -> ControllerFacts | None:
    """Return what a file of parameters says of the controller that moves some joints; None where none does."""
    text = _text(file, limits().xacro_yaml_bytes)
    if _PARAMETERS not in text:
        return None
    try:
        nodes = dict(_nodes(load_values(text), set()))
    except (yaml.YAMLError, ValueError, RecursionError):
        return None
    moving = (node for node in nodes.values() if set(joints) <= set(_listed(node.get("joints"))))
    parameters = next(
        (mapping for mapping in moving if "constraints" in mapping or "command_interfaces" in mapping), None
    )
    if parameters is None:
        return None
    constraints = parameters.get("constraints")
    goal_time = constraints.get("goal_time") if isinstance(constraints, dict) else None
    rate = nodes.get("controller_manager", {}).get("update_rate")
    return ControllerFacts(_positive(rate, _DEFAULT_HZ), _positive(goal_time, _DEFAULT_S), file)


def _near(description: Path, suffix: str) -> Iterator[Path]:
    """Yield the files beside a description and in the other folders of its package, each once and in one order."""
    folder = description.absolute().parent
    # What lies above a package, or above a folder of none, is somebody else's.
    package = folder.parent.glob(f"*/*{suffix}") if (folder.parent / MANIFEST).is_file() else ()
    left = limits().xml_bytes
    for file in sorted({*folder.glob(f"*{suffix}"), *package}):
        left -= file.stat().st_size if file.is_file() else 0
        if left < 0:
            return  # as much is no robot's, and a person can name the file
        yield file


def _text(file: Path, most: int) -> str:
    """Return what a file holds; nothing of one that cannot be read, or is larger than it may be."""
    try:
        return read_regular(file, most).decode("utf-8", "replace")
    except OSError:
        return ""


def _nodes(data: Any, seen: set[int]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each node with its parameters; what is below a name space or a wildcard too, an alias once."""
    if not isinstance(data, dict) or id(data) in seen:
        return
    seen.add(id(data))
    for name, value in data.items():
        parameters = value.get(_PARAMETERS) if isinstance(value, dict) else None
        if isinstance(parameters, dict):
            yield str(name).rpartition("/")[2], parameters
        else:
            yield from _nodes(value, seen)


def _listed(value: Any) -> list[str]:
    return [item for item in value if isinstance(item, str)] if isinstance(value, list) else []


def _positive(value: Any, default: float) -> float:
    return float(value) if isinstance(value, (int, float)) and 0.0 < value <= sys.float_info.max else default
