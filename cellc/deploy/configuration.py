"""Which configuration this is: its id, the version tuple, what nobody has answered, and the header of its files."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.site import UNKNOWN
from cellc.contract.manifest import ConfigurationInputs
from cellc.diagnostics import YamlPath
from cellc.formats.escape import shell_word
from cellc.formats.header import Header
from cellc.formats.urdf.robot import robot_description
from cellc.formats.xml_text import render
from cellc.graph.cell_graph import CellGraph

_DIGITS = 12

_OF_CELL = ("os", "kernel", "ros", "rmw", "ros2_control", "moveit")
_OF_DEVICE = ("revision", "serial", "firmware", "driver", "sdk", "description")


def configuration_inputs(cell: Cell) -> ConfigurationInputs:
    """Gather what the id is taken over; the same cell on another host gives the same."""
    urdf = render(robot_description(cell, "real"))
    return ConfigurationInputs(
        calibrations={name: written.revision for name, written in cell.calibrations.items()},
        tf_publishers={frame.name: frame.authority for frame in cell.frames if frame.parent},
        urdf_sha256=hashlib.sha256(urdf.encode()).hexdigest(),
    )


def configuration_id(inputs: ConfigurationInputs) -> str:
    """Return ``cfg-`` and 12 hexadecimal digits; the order of calibrations and frames does not matter."""
    canonical = json.dumps(inputs.model_dump(), sort_keys=True, separators=(",", ":"))
    return "cfg-" + hashlib.sha256(canonical.encode()).hexdigest()[:_DIGITS]


def version_tuple(cell: Cell) -> dict[str, str]:
    """Return every part by name: ``kernel``, ``rollback.image``, ``arm.firmware``."""
    versions = cell.versions
    parts = {name: str(getattr(versions, name)) for name in _OF_CELL}
    parts |= {
        "rollback.image": versions.rollback.image,
        "rollback.configuration": versions.rollback.configuration,
    }
    for device in cell.devices:
        parts |= {f"{device.name}.{name}": device.versions.part(name) for name in _OF_DEVICE}
    return parts


@dataclass(frozen=True, slots=True)
class OpenQuestion:
    """One UNKNOWN: what is not known, and where the answer belongs."""

    subject: str
    path: YamlPath


def open_questions(graph: CellGraph) -> tuple[OpenQuestion, ...]:
    """Return the questions that block the real target, versions first."""
    return (*_versions(graph.cell), *_owners(graph), *_safety(graph.cell), *_effects(graph.cell))


def _versions(cell: Cell) -> Iterator[OpenQuestion]:
    for name, value in version_tuple(cell).items():
        if value == UNKNOWN:
            of, _, part = name.rpartition(".")
            device = of in {device.name for device in cell.devices}
            path = ("devices", of, part) if device else ("versions", *name.split("."))
            yield OpenQuestion(f"{part} of {of}" if of else name, path)
    for one in cell.devices:
        if one.kinematics is not None and one.kinematics.calibration is None:
            yield OpenQuestion(f"kinematic calibration of {one.name}", (*one.path, "calibration"))


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
        if device.unknown_effects:
            yield OpenQuestion(f"motion of {device.name} as it comes up", (*device.path, "model"))


def header_of(cell: Cell) -> Header:
    """Build the header of a cell's files.

    The user may have named the spec from anywhere, so that the command names it from where cells are kept.
    """
    file = cell.places.file_name
    return Header(cell.name, f"cellc build {shell_word(f'cells/{cell.name}/{file}')}")
