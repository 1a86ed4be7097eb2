"""What launching a build starts, and what the started processes are told."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any
from xml.etree.ElementTree import fromstring

from tests.consumers.launch_interpreter import Launch, Process
from tests.consumers.matrix import SPECS, Build, build, spec_for
from tests.foreign_yaml import safe_load

CONFIRMED = {"target": "real", "confirm_real": "I_HAVE_PASSED_GATES_G0_TO_G2"}
MOTION_CONFIRMED = {"target": "real", "confirm_motion": "I_HAVE_PASSED_GATES_G0_TO_G6"}
# What a program calls its node where launching gives no name: ros2_control_node.cpp, spawner.py.
OWN_NAMES = {"ros2_control_node": "controller_manager"}


def launched(built: Build, file: str = "cell", **given: str) -> Launch:
    """Launch a file of the cell with arguments."""
    return Launch(built.cell, built.texts, given).run(f"launch/{file}.launch.xml")


def hosts(built: Build) -> list[str]:
    """Return the choices of the argument `host` but for the whole cell; none where it has no such argument."""
    (argument, *_) = [*fromstring(built.texts["launch/cell.launch.xml"]).findall("arg[@name='host']"), None]
    choices = [] if argument is None else [choice.attrib["value"] for choice in argument.findall("choice")]
    return [choice for choice in choices if choice != "all"]


def bring_ups(built: Build, target: str) -> list[Launch]:
    """Launch the cell: the mock and the simulator in one place, the real target on each host, confirmed."""
    if target != "real":
        return [launched(built, target=target)]
    places = [{"host": host} for host in hosts(built)] or [{}]
    return [launched(built, **CONFIRMED, **place) for place in places]


def moves(built: Build, target: str) -> list[Process]:
    """Return what the second launch file starts, the one with what asks for motion."""
    if "launch/move.launch.xml" not in built.texts:
        return []
    return launched(built, "move", **(MOTION_CONFIRMED if target == "real" else {"target": target})).processes


def targets(built: Build) -> tuple[str, ...]:
    """Return the choices of the argument `target`."""
    choices = fromstring(built.texts["launch/cell.launch.xml"]).findall("arg[@name='target']/choice")
    return tuple(choice.attrib["value"] for choice in choices)


def every_process(built: Build) -> list[Process]:
    """Return what every launch file but the one with motion starts, those that a person releases too."""
    files = [path.removeprefix("launch/").removesuffix(".launch.xml") for path in built.texts if "launch.xml" in path]
    started = [
        process for target in targets(built) for launch in bring_ups(built, target) for process in launch.processes
    ]
    for file in files:
        if file in ("activate", "claim", "goal"):
            root = fromstring(built.texts[f"launch/{file}.launch.xml"])
            stated = {arg.attrib["name"]: arg[0].attrib["value"] for arg in root.findall("arg") if len(arg)}
            started += launched(built, file, **stated).processes
    return started


@lru_cache(maxsize=64)
def processes(cell: str, distro: str, target: str) -> tuple[Process, ...]:
    """Return what launching a target starts, the real one with its confirmations, and then what asks for motion."""
    built = build(cell, distro)
    return (*(process for launch in bring_ups(built, target) for process in launch.processes), *moves(built, target))


def node_name(process: Process) -> str:
    """Return the fully qualified name of the node of a process."""
    if process.executable == "bring_up":  # it names its node after the last phase that it takes
        return f"/bring_up_{process.arguments[-1]}"
    return f"{process.namespace}/{process.name or OWN_NAMES.get(process.executable, process.executable)}"


def spawners(cell: str, distro: str, target: str = "mock") -> list[Process]:
    """Return the spawners in order."""
    return [process for process in processes(cell, distro, target) if process.executable == "spawner"]


def written(cell: str) -> Any:
    """Return the spec as plain data, read by a parser that is not cellc's."""
    return safe_load(SPECS[cell].read_text(encoding="utf-8"))


def written_managers(cell: str, distro: str) -> list[tuple[str, Any]]:
    """Return namespace and text of each controller manager of the spec for a distribution."""
    spec = safe_load(spec_for(cell, distro))
    managers = list(spec.get("managers", {}).values()) or [spec["control"]]
    return [(manager.get("namespace", ""), manager) for manager in managers]


@lru_cache(maxsize=64)
def plan(cell: str, distro: str) -> Any:
    """Return the plan of the bring-up, read as the program reads it."""
    return json.loads(build(cell, distro).texts["config/bring_up.json"])


def proven(plan: Any, target: str) -> list[Any]:
    """Return the steps of a target, each with the proofs of the lists that it names."""
    lists = plan["shared"].get(target, {})
    steps = [dict(step) for step in plan.get(target, ())]
    for step in steps:
        named = [lists[one["list"]] if one["kind"] == "shared" else [one] for one in step["proof"]]
        step["proof"] = [one for proofs in named for one in proofs]
    return steps


def activated(cell: str, distro: str, target: str, manager: str) -> list[str]:
    """Return the controllers that the steps of a target activate for the first time, by the node of their manager."""
    requests = (step.get("request") or {} for step in plan(cell, distro)[target])
    wanted = (request for request in requests if request.get("kind") == "controllers" and request["manager"] == manager)
    return [name for one in wanted for name in one["controllers"]]
