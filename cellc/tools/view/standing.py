"""What is in the cell, and how it may move: all of a package, or as much of a spec with errors as can be linked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Union

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import WORLD
from cellc.contract.contract import ContractFrame, ContractGoal, ContractGroup, ContractPoseTarget
from cellc.contract.diagnostics import Diagnostic, YamlPath
from cellc.mock.folder import GeneratedFolder
from cellc.robot.description.model import Description

Wanted = Mapping[YamlPath, Union[Diagnostic, None]]
"""Devices, frames, things of the scene, poses and goals that the cell names, each with the error that takes it out."""


@dataclass(frozen=True, slots=True)
class Standing:
    """What is drawn is computed from this alone.

    Attributes:
        roots: the root link of each device.
        description: the robot model, every link of which hangs from the world.
        mesh_roots: folders beside which the packages of meshes may lie.
    """

    roots: Mapping[str, str]
    frames: Mapping[str, ContractFrame]
    groups: Mapping[str, ContractGroup]
    poses: Mapping[str, tuple[ContractPoseTarget, ...]]
    goals: Mapping[str, ContractGoal]
    description: Description
    mesh_roots: tuple[Path, ...]


def of_package(folder: GeneratedFolder) -> Standing:
    """Return what is in the cell of a package."""
    contract = folder.contract
    return Standing(
        {name: device.root_link for name, device in contract.devices.items()},
        contract.frames,
        contract.groups,
        contract.poses,
        contract.goals,
        folder.description,
        folder.mesh_roots,
    )


def of_cell(cell: Cell) -> Standing | None:
    """Return what is in a cell that no package was made of; None where not even its description can be read.

    Links that hang from nothing or in a circle are left out, and poses and goals that do not fit their group.
    """
    # What is written into packages says it too; a folder is shown without the compiler.
    from cellc.compiler.emit.contract.motion import frames, goals, groups, poses
    from cellc.compiler.feasibility.meshes import mesh_roots
    from cellc.compiler.formats.urdf.robot import robot_description
    from cellc.compiler.formats.xml_text import render
    from cellc.robot.description.urdf_reader import read_urdf

    read = read_urdf(render(robot_description(cell, "mock"), ""), cell.locate("cell").file)
    if read.value is None:
        return None
    apart = set(read.value.unreached(WORLD))
    description = replace(
        read.value,
        links=tuple(link for link in read.value.links if link.name not in apart),
        joints=tuple(joint for joint in read.value.joints if joint.child not in apart),
    )
    known = groups(cell)
    fitting = {
        name: targets
        for name, targets in poses(cell).items()
        if all(target.group in known and len(known[target.group].joints) == len(target.positions) for target in targets)
    }
    roots = {device.name: device.body.root_link for device in cell.devices if device.body.root_link not in apart}
    reached = {name: goal for name, goal in goals(cell).items() if goal.group in known}
    return Standing(roots, frames(cell), known, fitting, reached, description, mesh_roots(cell))


def wanted_of(standing: Standing) -> Wanted:
    """Return what a package names."""
    return dict.fromkeys(_wanted(standing))


def _wanted(standing: Standing) -> Iterator[YamlPath]:
    yield from (("devices", name) for name in standing.roots)
    yield from (("frames", name) for name, frame in standing.frames.items() if frame.kind not in ("link", "mount"))
    yield from (("motion", "poses", name) for name in standing.poses)
    yield from (("motion", "goals", name) for name in standing.goals)
