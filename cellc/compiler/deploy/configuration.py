"""Which configuration this is: its id, the version tuple, what no person has answered, and the header of its files."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, Field
from enum import Enum
from typing import Any

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.entity import Part
from cellc.compiler.cell.members import field_names
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.urdf.robot import real_description
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.diagnostics import YamlPath
from cellc.contract.entities import Qos, SimulatedNetwork
from cellc.contract.frozen import dataclass
from cellc.contract.manifest import ConfigurationInputs
from cellc.contract.qos import DEFAULT
from cellc.contract.stated import DiscoveryServer, HardwareStatement, RobotProgram, StatedModel
from cellc.contract.vocabulary import UNKNOWN

_DIGITS = 12

_NOT_RESTED_ON = frozenset(
    {
        *("name", "places", "summary", "owners"),  # who answers is no part of what was tried
        "packages",  # where a description was found; what it says is that of the devices
        *("implied", "behaviors", "harmless_plugins", "harmless_programs", "hardware_packages"),  # the catalog's lists
    }
)
"""Fields of a cell that leave evidence as it is."""
_NOT_OF_AN_ENTITY = frozenset(
    {
        *("span", "places", "declared", "own_topics", "owner"),
        *("endpoints", "inside", "version_rows", "commissioning", "mock_cannot_prove"),  # the catalog's
        *("vendor_mounts", "reach_m"),  # the catalog's
        "vendor_description",  # its shapes are those of the links
        "fixed_joint_names",  # a fact of the driver, which the names of the cell follow
        *("plug", "tool_facts", "load_service", "impedance_facts"),  # settings that a tool and its connector accept
    }
)
"""Fields of any part of it that do."""
_IN_ORDER = frozenset({"joints", "pipelines", "positions", "steps"})
"""Fields in which the order says something; elsewhere the user may write things in any order."""

_SORTED = json.JSONEncoder(sort_keys=True)
_OF_CELL = ("os", "kernel", "ros", "rmw", "ros2_control", "moveit")
_OF_DEVICE = ("revision", "serial", "firmware", "driver", "sdk", "description")


def configuration_inputs(graph: CellGraph) -> ConfigurationInputs:
    """Gather what the id is taken over; the same cell on another host gives the same."""
    cell, urdf = graph.cell, graph.once(real_description)
    return ConfigurationInputs(
        calibrations={name: calibration.revision for name, calibration in cell.calibrations.items()},
        tf_publishers={frame.name: frame.authority for frame in cell.frames if frame.parent},
        urdf_sha256=hashlib.sha256(urdf.encode()).hexdigest(),
        cell_sha256=_digest(_settled(cell, _NOT_RESTED_ON)),
    )


def _digest(settled: object) -> str:
    text = json.dumps(settled, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _settled(value: object, left_out: frozenset[str] = _NOT_OF_AN_ENTITY) -> object:
    """Return a linked value as plain data: without its places, what is at its default, and order that says nothing."""
    if names := field_names(value):
        values = {name: getattr(value, name) for name in names if name not in left_out}
        place = "path" if isinstance(values.get("path"), tuple) else None  # a stop has a path too, and that is a text
        stated = {name: member for name, member in values.items() if name != place and member != _default(value, name)}
        settled = {
            name: _settled(member) if name in _IN_ORDER else _unordered(_settled(member))
            for name, member in stated.items()
        }
        return _as_first_taken(settled, value) if isinstance(value, Device) else settled
    if isinstance(value, Mapping):
        return {str(name): _settled(member) for name, member in value.items()}
    if isinstance(value, frozenset):
        return _unordered([_settled(item) for item in value])
    if isinstance(value, tuple):
        return [_settled(item) for item in value]
    if isinstance(value, float):
        return rounded(value)
    if isinstance(value, Enum):
        return str(value.value)
    return value if isinstance(value, (str, int)) or value is None else str(value)


def _as_first_taken(composed: Mapping[str, object], of: Device) -> dict[str, object]:
    """Return a device in the form over which the first ids were taken: evidence of a cell rests on its id."""
    device: dict[str, object] = {}
    for name, value in composed.items():
        device |= value if isinstance(value, dict) and isinstance(getattr(of, name), Part) else {name: value}
    device |= {"robot": device.pop("accepts")} if "accepts" in device else {}
    exposure_s = device.pop("exposure_s", None)
    if isinstance(stamp := device.get("stamp"), dict):
        stamp["exposure_s"] = exposure_s
    if isinstance(camera := device.get("camera"), dict) and exposure_s is not None:
        camera["exposure_s"] = exposure_s
    return device


def _unordered(value: object) -> object:
    """Return a list in one order, unless it is one of numbers."""
    if isinstance(value, list) and len(value) > 1 and not all(isinstance(item, (int, float)) for item in value):
        return sorted(value, key=_SORTED.encode)
    return value


def _default(value: Any, name: str) -> object:
    if isinstance(value, (Qos, SimulatedNetwork)):
        return getattr(DEFAULT, name, MISSING)
    if isinstance(value, StatedModel):  # the first ids were taken over all fields of some of them
        whole = isinstance(value, (DiscoveryServer, HardwareStatement, RobotProgram))
        return MISSING if whole else type(value).model_fields[name].get_default(call_default_factory=True)
    of: Field[Any] = value.__dataclass_fields__[name]
    return of.default if of.default_factory is MISSING else of.default_factory()


def configuration_id(inputs: ConfigurationInputs) -> str:
    """Return ``cfg-`` and 12 hexadecimal digits; the text of the URDF follows from the rest, but for its order."""
    return "cfg-" + _digest(inputs.model_dump(exclude={"urdf_sha256"}))[:_DIGITS]


def version_tuple(cell: Cell) -> dict[str, str]:
    """Return every part by name: ``kernel``, ``rollback.image``, ``arm.firmware``."""
    versions = cell.versions
    parts = {name: str(getattr(versions, name)) for name in _OF_CELL}
    parts |= {
        "rollback.image": versions.rollback.image,
        "rollback.configuration": versions.rollback.configuration,
    }
    for device in cell.devices:
        names = _OF_DEVICE[:2] if device.is_only_switched else _OF_DEVICE
        parts |= {f"{device.name}.{name}": device.software.versions.part(name) for name in names}
    return parts


@dataclass(frozen=True, slots=True)
class OpenQuestion:
    """One UNKNOWN: what is not known, and where the answer belongs."""

    subject: str
    path: YamlPath


def open_questions(graph: CellGraph) -> tuple[OpenQuestion, ...]:
    """Return the questions that block the real target, versions first."""
    return (
        *_versions(graph.cell),
        *_owners(graph),
        *_safety(graph.cell),
        *_effects(graph.cell),
        *_surroundings(graph.cell),
    )


def _versions(cell: Cell) -> Iterator[OpenQuestion]:
    for name, value in version_tuple(cell).items():
        if value == UNKNOWN:
            of, _, part = name.rpartition(".")
            device = of in {device.name for device in cell.devices}
            path = ("devices", of, part) if device else ("versions", *name.split("."))
            subject = f"{part} of {of}" if device else " ".join(name.split("."))
            yield OpenQuestion(subject, path)
    for item in cell.devices:
        if item.body.kinematics is not None and item.body.kinematics.calibration is None:
            yield OpenQuestion(f"kinematic calibration of {item.name}", (*item.path, "calibration"))


def _owners(graph: CellGraph) -> Iterator[OpenQuestion]:
    for item in graph.responsibilities.items:
        if item.open:
            yield OpenQuestion(f"owner of {item.kind} {item.name}", item.path)


def _safety(cell: Cell) -> Iterator[OpenQuestion]:
    stop = cell.safety.stop
    for name, value in (("authority", stop.authority), ("path", stop.path)):
        if value == UNKNOWN:
            yield OpenQuestion(f"stop {name}", ("safety", "stop", name))


def _effects(cell: Cell) -> Iterator[OpenQuestion]:
    for device in cell.devices:
        if device.control.unknown_effects:
            yield OpenQuestion(f"motion of {device.name} at its start", (*device.path, "model"))


def _surroundings(cell: Cell) -> Iterator[OpenQuestion]:
    if any(device.kind == "arm" for device in cell.devices):
        for part, known in cell.surroundings:
            if known.open is not None or not known.is_stated:
                yield OpenQuestion(f"{part} around the arms", ("surroundings", part))


def header_of(cell: Cell) -> Header:
    """Build the header of a cell's files.

    The user may have named the spec from anywhere, so that the command names it from where cells are kept.
    """
    file = cell.places.file_name
    return Header(cell.name, f"cellc build {shell_word(f'cells/{cell.name}/{file}')}")
