"""Reads a generated folder: the only thing that the mock knows of a cell."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

import yaml
from pydantic import BaseModel

from cellc.contract.bring_up import BringUp, BringUpStep, Watch
from cellc.contract.contract import Contract
from cellc.contract.diagnostics.unsafe_text import hidden_in_json, hidden_on_line
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits, option
from cellc.contract.manifest import Manifest
from cellc.contract.quantities import LARGEST
from cellc.contract.reading import FormatError, read_json
from cellc.contract.rehearsals import RehearsalEntry, Rehearsals
from cellc.contract.store.regular_file import FileTooLargeError, NotRegularError, read_regular
from cellc.contract.uncertainty import UNCERTAINTY_FILE, Uncertainty
from cellc.mock.errors import MockError
from cellc.robot.description.model import Description
from cellc.robot.description.packages import lies_under, repository_of
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.xml_tree import read_xml
from cellc.robot.description.yaml_values import load_values
from cellc.robot.physics.scene import Scene

CONTRACT_FILE = "contract.json"
MANIFEST_FILE = "manifest.json"
_Model = TypeVar("_Model", bound=BaseModel)
_BUILD_OR_EDITED = "build it again, or take `--edited`, which executes edits under an id that signs no gate"


@dataclass(frozen=True, slots=True)
class GeneratedFolder:
    """The parts of a generated folder that the mock executes.

    Attributes:
        urdf: text of the robot description that the mock executes.
        description: what it says.
        allowed_collisions: pairs of links whose collision is not checked, from the SRDF.
        parameters: text of the parameter file of each controller manager, by manager.
        bring_up, real_bring_up: the steps of the mock, and of the real target.
        watches: what lets go of claims as a robot no longer listens.
        notes: how it differs from its manifest, one line each; empty as it was generated.
        edits: paths of the files that differ.
        listed: paths of all files of the manifest.
        uncertainty: what sweeps draw; None where the cell says nothing of it.
        mesh_roots: folders beside which the packages of meshes may lie, as at the build.
        stages: text of the parameters of each stage of commissioning, by its percentage in order.
        stage: the one that is planned in; the last where it is empty.
        scene: that moves joints and parts; None where they are where they are led to.
    """

    contract: Contract
    rehearsals: tuple[RehearsalEntry, ...]
    urdf: str
    description: Description
    allowed_collisions: tuple[tuple[str, str], ...]
    parameters: dict[str, str]
    bring_up: tuple[BringUpStep, ...]
    real_bring_up: tuple[BringUpStep, ...]
    watches: tuple[Watch, ...]
    notes: tuple[str, ...]
    edits: tuple[str, ...]
    listed: tuple[str, ...]
    mesh_roots: tuple[Path, ...] = ()
    uncertainty: Uncertainty | None = None
    stages: dict[str, str] = field(default_factory=dict)
    stage: str = ""
    scene: Scene | None = None

    @property
    def capped_by(self) -> tuple[str, str]:
        """Name and text of the file with the limits that motion is planned in; empty where no stage has some."""
        percent = self.stage or next(reversed(self.stages), "")
        return (self.contract.files.stages[percent], self.stages[percent]) if percent else ("", "")

    @property
    def staged(self) -> tuple[str, ...]:
        """A line on the stage, where another than the last may be meant, and one where joints and parts have mass."""
        stage = (f"motion is planned in stage {self.stage} % of commissioning",) if self.stage else ()
        return stage if self.scene is None else (*stage, "joints and parts have mass, drives and contacts: `--physics`")

    @property
    def masses(self) -> str:
        """What computes with masses, by its version; empty where nothing has any."""
        return "" if self.scene is None else self.scene.computed_by

    @property
    def edited(self) -> bool:
        """Tell whether it is another folder than the one that was generated."""
        return bool(self.notes)


def read_folder(folder: Path, *, edited: bool = False) -> GeneratedFolder:
    """Read and validate what the mock needs.

    Args:
        edited: take a folder that differs from its manifest, under an id of its own.

    Raises:
        MockError: a file is missing, unreadable, not what its name says, lies outside the folder, or was edited.
    """
    if not folder.is_dir():
        problem = "is not a folder" if folder.exists() else "no such folder"
        raise MockError(folder.as_posix(), f"{problem}; name one that `cellc build` wrote")
    if not (folder / CONTRACT_FILE).exists():
        raise MockError(folder.as_posix(), f"holds no {CONTRACT_FILE}; name a folder that `cellc build` wrote")
    contract = _read_model(folder, CONTRACT_FILE, Contract)
    _refuse_dangling(contract)
    rehearsals = _read_model(folder, contract.files.rehearsals, Rehearsals)
    _check_rehearsals(contract.files.rehearsals, rehearsals)
    manifest = _read_model(folder, MANIFEST_FILE, Manifest)
    missing = sorted(set(contract.managers) - set(contract.files.parameters))
    if missing:
        raise MockError(CONTRACT_FILE, f"controller manager `{missing[0]}` has no parameter file")
    urdf = read_text(folder, contract.files.urdf_mock)
    description = _described(urdf, contract.files.urdf_mock)
    _refuse_unexported(contract, description)
    plan = _bring_up(folder, contract)
    notes, edits, own_id = differences(folder, contract, manifest)
    if notes and not edited:
        more = f", and {len(notes) - 1} more" if len(notes) > 1 else ""
        raise MockError(folder.as_posix(), f"{notes[0]}{more}; {_BUILD_OR_EDITED}")
    return GeneratedFolder(
        contract=contract.model_copy(update={"configuration_id": own_id}) if notes else contract,
        rehearsals=rehearsals.rehearsals,
        urdf=urdf,
        description=description,
        allowed_collisions=tuple(_allowed_collisions(folder, contract.files.srdf)),
        parameters={name: read_text(folder, path) for name, path in contract.files.parameters.items()},
        bring_up=plan.proven_steps("mock"),
        real_bring_up=plan.proven_steps("real"),
        watches=plan.watches,
        notes=notes,
        edits=edits,
        listed=tuple(manifest.files),
        mesh_roots=_mesh_roots(folder, contract),
        uncertainty=_read_model(folder, UNCERTAINTY_FILE, Uncertainty) if UNCERTAINTY_FILE in manifest.files else None,
        stages={percent: read_text(folder, path) for percent, path in contract.files.stages.items()},
    )


def in_stage(read: GeneratedFolder, folder: Path, stage: str) -> GeneratedFolder:
    """Return a folder whose motion is planned in a stage of commissioning; raise MockError where it has none such."""
    if stage not in read.stages:
        known = ", ".join(read.stages) or "none"
        raise MockError(folder.as_posix(), f"has no stage `{stage}` of commissioning; its stages are: {known}")
    return replace(read, stage=stage)


def _mesh_roots(folder: Path, contract: Contract) -> tuple[Path, ...]:
    """Return where the spec lies as a rule, and the folders of packages that it names in its repository.

    That is in `cells/NAME` beside `generated`, or beside `generated` itself.
    """
    above = Path(os.path.abspath(folder)).parents
    specs = [root for base in above[:2] for root in (base / "cells" / contract.cell, base)]
    inside = (
        spec / beside
        for spec in specs
        for beside in contract.files.packages
        if spec.is_dir() and lies_under((spec / beside).as_posix(), repository_of(spec.as_posix()))
    )
    return tuple(dict.fromkeys((*specs, *inside)))


def _bring_up(folder: Path, contract: Contract) -> BringUp:
    """Return the plan, whose steps and watches are for managers that the contract has."""
    file = contract.files.bring_up
    plan = _read_model(folder, file, BringUp)
    known = {f"{manager.namespace}/controller_manager" for manager in contract.managers.values()}
    for step in plan.mock:
        asked = getattr(step.request, "manager", None)
        if asked is not None and asked not in known:
            raise MockError(file, f"step `{step.name}` asks `{asked}`, which the contract does not have")
    for watch in plan.watches:
        if watch.manager not in known:
            raise MockError(file, f"a watch asks `{watch.manager}`, which the contract does not have")
    return plan


def _described(urdf: str, file: str) -> Description:
    read = read_urdf(urdf, file)
    if read.value is None:
        problem = read.diagnostics[0]
        advice = f"; {problem.help}" if "--limit" in problem.help else ""
        raise MockError(file, f"line {problem.span.line}: {problem.message}{advice}")
    return read.value


def _refuse_unexported(contract: Contract, description: Description) -> None:
    """Refuse a state interface in the contract that no hardware of the description has."""
    exported = {
        f"{part.name}/{interface.name}"
        for component in description.hardware
        for part in (*component.joints, *component.sensors, *component.gpios)
        for interface in part.state_interfaces
    }
    for name, device in contract.devices.items():
        scaling = device.speed_scaling_interface
        if scaling is not None and scaling not in exported:
            path = f"devices.{name}.speed_scaling_interface"
            message = f"must have the state interface of `{path}` of the contract, got no `{scaling}`"
            raise MockError(contract.files.urdf_mock, message)


def _allowed_collisions(folder: Path, file: str | None) -> Iterator[tuple[str, str]]:
    """Read the pairs of links that the SRDF excuses from the collision check; a cell without groups has none."""
    if file is None:
        return
    read = read_xml(read_text(folder, file), file)
    if read.value is None:
        problem = read.diagnostics[0]
        raise MockError(file, f"line {problem.span.line}: {problem.message}")
    for pair in read.value.all("disable_collisions"):
        first, second = (pair.attributes.get(name) for name in ("link1", "link2"))
        if first is None or second is None:
            raise MockError(file, f"line {pair.span.line}: expected `link1` and `link2`")
        yield first, second


def _refuse_dangling(contract: Contract) -> None:
    """Refuse a name in the contract of a group, device or controller that it does not have."""
    named = [(f"goals.{name}.group", goal.group) for name, goal in contract.goals.items()]
    named += [
        (f"poses.{name}[{at}].group", target.group)
        for name, pose in contract.poses.items()
        for at, target in enumerate(pose)
    ]
    for path, group in named:
        if group not in contract.groups:
            raise MockError(CONTRACT_FILE, f"`{path}` must be a group of the contract, got `{group}`")
    for name, pose in contract.poses.items():
        for at, target in enumerate(pose):
            wanted = len(contract.groups[target.group].joints)
            if len(target.positions) != wanted:
                path = f"poses.{name}[{at}].positions"
                raise MockError(CONTRACT_FILE, f"`{path}` must be {wanted} positions, got {len(target.positions)}")
    _refuse_unknown_servers(contract)
    for of, manager in contract.managers.items():
        for name, controller in manager.controllers.items():
            if controller.device is not None and controller.device not in contract.devices:
                path = f"managers.{of}.controllers.{name}.device"
                raise MockError(CONTRACT_FILE, f"`{path}` must be a device of the contract, got `{controller.device}`")


def _refuse_unknown_servers(contract: Contract) -> None:
    known = {name for manager in contract.managers.values() for name in manager.controllers} | set(contract.adapters)
    named = [(f"groups.{name}.controller", group.controller) for name, group in contract.groups.items()]
    named += [
        (f"devices.{name}.gripper.controller", device.gripper.controller)
        for name, device in contract.devices.items()
        if device.gripper is not None
    ]
    for path, controller in named:
        if controller is not None and controller not in known:
            raise MockError(CONTRACT_FILE, f"`{path}` must be a controller of the contract, got `{controller}`")


def _check_rehearsals(file: str, rehearsals: Rehearsals) -> None:
    """Refuse what no spec makes: a name that a terminal would obey or that is given twice."""
    known: set[str] = set()
    for entry in rehearsals.rehearsals:
        if not entry.name.isprintable() or entry.name in known:
            raise MockError(file, f"has two rehearsals of the name {entry.name!a}, or an unprintable name")
        known.add(entry.name)


def _read_model(folder: Path, name: str, model: type[_Model]) -> _Model:
    try:
        return read_json(read_text(folder, name), model)
    except FormatError as error:
        raise MockError(name, str(error)) from None


def read_text(folder: Path, name: str) -> str:
    """Return the text of a file of a generated folder.

    Raises:
        MockError: it is missing, unreadable, too large, outside of the folder, or hides something from who reads it.
    """
    try:
        text = _read_bytes(folder, name).decode("utf-8")
    except UnicodeDecodeError:
        raise MockError(name, "is not UTF-8 text") from None
    _refuse_hidden(name, text)
    return text


def _read_bytes(folder: Path, name: str) -> bytes:
    most = limits().folder_bytes
    try:
        return read_regular(_inside(folder, name), most)
    except FileTooLargeError as large:
        raise MockError(name, f"{large.strerror}; {option('folder-bytes')}") from None
    except NotRegularError:
        raise MockError(name, "is not a regular file") from None
    except FileNotFoundError:
        raise MockError(name, "is missing from the generated folder") from None
    except OSError as error:
        raise MockError(name, f"cannot be read: {error.strerror}") from None


def _refuse_hidden(name: str, text: str) -> None:
    """Refuse a text that hides something from who reads it; what the compiler writes does not."""
    hidden = hidden_in_json(text) if name.endswith(".json") else hidden_on_line(text)
    if hidden is not None:
        raise MockError(name, f"line {hidden[0]}: {hidden[1]}")


def _inside(folder: Path, name: str) -> Path:
    """Return the path of a file of the folder; a contract must not make the mock read the rest of the disk."""
    file = folder / name
    if not lies_under(file.as_posix(), folder.as_posix()):
        raise MockError(name, "is a link that leads out of the folder")
    return file


def differences(folder: Path, contract: Contract, manifest: Manifest) -> tuple[tuple[str, ...], tuple[str, ...], str]:
    """Return how a folder differs from its manifest, one line each, in which files, and an id of what it holds.

    Raises:
        MockError: the manifest names a file outside of the folder, or more of them than may be read.
    """
    of_contract, of_manifest = contract.configuration_id, manifest.configuration_id
    notes = (
        []
        if of_contract == of_manifest
        else [f"`{MANIFEST_FILE}` belongs to configuration `{of_manifest}`, not `{of_contract}`"]
    )
    edits: list[str] = []
    total, most = 0, limits().folder_total_bytes
    held = hashlib.sha256()
    executed = {CONTRACT_FILE, *named_files(contract)}
    for name in sorted({*manifest.files, *executed}):
        if not _inside(folder, name).is_file():
            notes.append(f"`{name}` is listed in the manifest and missing")
            edits.append(name)
            continue
        content = _read_bytes(folder, name)
        total += len(content)
        if total > most:
            raise MockError(MANIFEST_FILE, f"names more than {most} bytes of files; {option('folder-total-bytes')}")
        digest = hashlib.sha256(content).hexdigest()
        held.update(f"{name}\0{digest}\0".encode())
        if name not in manifest.files:
            notes.append(f"`{name}` is executed and not listed in the manifest")
        elif digest != manifest.files[name].removeprefix("sha256:"):
            notes.append(f"`{name}` differs from the manifest: it was edited after it was generated")
            edits.append(name)
    return tuple(notes), tuple(edits), f"edited-{held.hexdigest()[:12]}"


def named_files(contract: Contract) -> Iterator[str]:
    """Yield the files beside it that a contract has executed."""
    files = contract.files
    yield from (files.rehearsals, files.urdf_mock, files.bring_up, *files.parameters.values(), *files.stages.values())
    if files.srdf is not None:
        yield files.srdf


def path_tolerances(parameters: Mapping[str, str]) -> dict[str, float]:
    """Return `constraints.<joint>.trajectory` of the parameter files, of each joint that has one above zero."""
    return dict(tolerance for text in parameters.values() for tolerance in _tolerances(text, "trajectory"))


def goal_tolerances(parameters: Mapping[str, str]) -> dict[str, float]:
    """Return `constraints.<joint>.goal` of the parameter files, of each joint that has one above zero."""
    return dict(tolerance for text in parameters.values() for tolerance in _tolerances(text, "goal"))


@lru_cache(maxsize=64)
def _tolerances(text: str, key: str) -> tuple[tuple[str, float], ...]:
    return tuple(_tolerances_of(text, key))


def _tolerances_of(text: str, key: str) -> Iterator[tuple[str, float]]:
    try:
        nodes = load_values(text, most=limits().folder_values)
    except (yaml.YAMLError, ValueError, RecursionError):
        return  # the controller manager says what is wrong with it
    for node in nodes.values() if isinstance(nodes, dict) else ():
        parameters = node.get("ros__parameters") if isinstance(node, dict) else None
        constraints = parameters.get("constraints") if isinstance(parameters, dict) else None
        for joint, constraint in constraints.items() if isinstance(constraints, dict) else ():
            value = constraint.get(key) if isinstance(constraint, dict) else None
            if isinstance(value, (int, float)) and not isinstance(value, bool) and 0.0 < value <= LARGEST:
                yield str(joint), float(value)
