"""A package of a cell as facts: the leaves of its data, and the lines of what is text alone."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import yaml
from pydantic import BaseModel

from cellc.compiler.cell.cell import Cell
from cellc.contract.base import Json
from cellc.contract.bring_up import Activation, BringUp
from cellc.contract.contract import Contract
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.entities import TARGETS, ContractInterface
from cellc.contract.errors import CellcError
from cellc.contract.gates import GATES, Gates
from cellc.contract.limits import limits
from cellc.contract.manifest import Manifest
from cellc.contract.reading import FormatError, read_json
from cellc.contract.rehearsals import Rehearsals
from cellc.contract.transforms import identity
from cellc.robot.description.model import Box, Collision, Cylinder, Description, Sphere
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.xml_tree import XmlElement, read_xml
from cellc.robot.description.yaml_values import load_values
from cellc.tools.review.cameras import of_cameras, without_images
from cellc.tools.review.faults import of_rehearsals
from cellc.tools.review.graded import graded_values
from cellc.tools.review.leaves import Leaf, Leaves, Path, Prose, as_json, flatten
from cellc.tools.review.rights import COMMON, POLICY, of_checklist, rights
from cellc.tools.review.steps import CALLED, OBSERVED
from cellc.tools.review.units import shown

CONTRACT, MANIFEST, OBSERVATION = "contract.json", "manifest.json", "config/observe.json"
_MIDDLEWARE = re.compile(r"middleware/(.+)\.sh")
_EXPORT = re.compile(r"^export (\w+)=(.*)$", re.MULTILINE)
OF_SPEC = ("spec", "area", "frame", "device", "excused")
"""First parts of the paths of what a spec says and a package does not."""
OF_GATES = ("check", "matrix")
"""First parts of the paths of what the gates have as data."""
_XML = (".xml", ".urdf", ".srdf", ".svg")
_ANY_NODE = "/**"
_TURN, _ANGLES = "rotation_vector", "rpy"
_MOVEIT = "config/moveit"
_OLDER = dict.fromkeys(
    (
        f"{_MOVEIT}/{name}.yaml"
        for name in ("planning_pipelines", "trajectory_execution", "planning_scene", "cartesian_limits")
    ),
    f"{_MOVEIT}/move_group.yaml",
)
"""Files of packages that an older cellc wrote, and where their values are now."""
_Model = TypeVar("_Model", bound=BaseModel)


class FactsError(CellcError):
    """A file of a package is not what its name says; the text is one line."""


@dataclass(frozen=True, slots=True)
class Facts:
    """What one package says.

    Attributes:
        leaves: every value of its data by path; the first part of a path is the file, or what several files make up.
        lines: lines of every file that is no data, by file.
        description: that for the real target.
        edited: files that are not as the manifest has them.
        has_gates: whether it has the gates as data; a package of an older cellc has checklists alone.
        cell: what the package was made of, which says more than it (``OF_SPEC``); None where only the package is
            there.
    """

    contract: Contract
    manifest: Manifest
    leaves: Leaves
    lines: Mapping[str, tuple[str, ...]]
    description: Description
    edited: frozenset[str]
    has_gates: bool
    cell: Cell | None


def facts_of(files: Mapping[str, str], cell: Cell | None = None, excused: Sequence[Diagnostic] = ()) -> Facts:
    """Return what a package says.

    Args:
        files: text by path in the package.
        cell: what it was made of; None where only the package is there.
        excused: findings of the check that comments of the spec excuse.

    Raises:
        FactsError: a file is missing or not what its name says.
    """
    contract, manifest = _model(files, CONTRACT, Contract), _model(files, MANIFEST, Manifest)
    gates = contract.gates or (_model(files, GATES, Gates) if GATES in files else None)
    named = contract.files
    real, mock = _described(files, named.urdf_real), _described(files, named.urdf_mock)
    # What an observer compares follows from contract, bring-up and catalog; the manifest shows an edit by hand.
    read = {CONTRACT, MANIFEST, GATES, named.rehearsals, named.bring_up, OBSERVATION, POLICY, COMMON}
    read |= set(named.stages.values())
    leaves: dict[Path, Leaf] = {}
    for facts in (
        _of_contract(contract),
        _of_manifest(manifest),
        _of_claims(contract),
        _of_placements(contract, real),
        _of_description("real", real),
        flatten(as_json(mock.hardware), ("mock", "hardware")),
        flatten(of_rehearsals(_model(files, named.rehearsals, Rehearsals), real), ("rehearsals",)),
        _of_bring_up(_model(files, named.bring_up, BringUp), contract),
        () if gates is None else (*of_checklist(files), *_of_gates(gates, contract.cell)),
        _of_middleware(files),
        _of_pairs(files, named.srdf),
        _of_policy(files, contract.cell),
        _of_stages(files, contract),
        () if cell is None else _of_spec(cell),
        _of_excuses(excused),
    ):
        leaves.update(facts)
    of_manager = {path: ("parameters", of) for of, path in named.parameters.items()}
    for path in sorted(files.keys() - read):
        if path.endswith((".yaml", ".json")):
            read.add(path)
            data = _loaded(path, files[path])
            leaves.update(flatten(data, of_manager.get(path) or _place(path, data)))
    known_files = {named.urdf_real: "urdf/real", named.urdf_mock: "urdf/mock", named.srdf: "config/moveit/srdf"}
    lines = {
        known_files.get(path, path): _lines(path, files[path], is_srdf=path == named.srdf)
        for path in sorted(files.keys() - read)
    }
    edited = {path for path, known in manifest.files.items() if path in files and _sha256(files[path]) != known}
    return Facts(contract, manifest, leaves, lines, real, frozenset(edited), gates is not None, cell)


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _lines(path: str, text: str, *, is_srdf: bool) -> tuple[str, ...]:
    # One tag a line, however an XML file is laid out.
    apart = re.sub(r">\s*<", ">\n<", text) if path.endswith(_XML) else text
    lines = (line.strip() for line in apart.split("\n"))
    return tuple(line for line in lines if line and not (is_srdf and line.startswith("<disable_collisions ")))


def _text(files: Mapping[str, str], path: str) -> str:
    if path not in files:
        raise FactsError(f"{path}: is missing from the package")
    return files[path]


def _model(files: Mapping[str, str], path: str, model: type[_Model]) -> _Model:
    try:
        return read_json(_text(files, path), model)
    except FormatError as error:
        raise FactsError(f"{path}: {error}") from None


def _dumped(model: BaseModel) -> dict[str, Json]:
    dumped: dict[str, Json] = model.model_dump(mode="json")
    return dumped


def _described(files: Mapping[str, str], path: str) -> Description:
    read = read_urdf(_text(files, path), path)
    if read.value is None:
        raise FactsError(f"{path}: line {read.diagnostics[0].span.line}: {read.diagnostics[0].message}")
    return read.value


def _loaded(path: str, text: str) -> Json:
    try:
        return _plain(load_values(text, most=limits().folder_values, aliases=False))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        reason = str(error).partition("\n")[0]
        raise FactsError(f"{path}: is not YAML that cellc writes: {reason}") from None


def _place(path: str, data: Json) -> Path:
    """Return the path that the values of a file are compared under: parameters by node, whatever file has them."""
    sections = [*data.values()] if isinstance(data, dict) and _ANY_NODE not in data else []
    if sections and all(isinstance(section, dict) and "ros__parameters" in section for section in sections):
        return "parameters", "nodes"
    return "file", _OLDER.get(path, path)


def _plain(value: object) -> Json:
    """Return what was loaded with every key as text, and every other kind of scalar, such as a date, too."""
    if isinstance(value, dict):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_plain(inner) for inner in value]
    return value if value is None or isinstance(value, (str, int, float, bool)) else str(value)


def _of_manifest(manifest: Manifest) -> Iterator[tuple[Path, Leaf]]:
    """Yield what is reported nowhere else: the id and the hashes are of what other leaves and lines tell."""
    yield ("manifest", "cellc_version"), manifest.cellc_version
    yield from flatten(dict(manifest.version_tuple), ("manifest", "version_tuple"))


def _of_contract(contract: Contract) -> Iterator[tuple[Path, Leaf]]:
    """Yield the contract with the ends of its interfaces named by what they are, and without what others tell."""
    data = _dumped(contract.model_copy(update={"devices": without_images(contract.devices)}))
    interfaces = data.pop("interfaces")
    for name, interface in contract.interfaces.items():
        facts = interfaces[name] if isinstance(interfaces, dict) else None
        assert isinstance(facts, dict)
        sources, sinks = _ends(interface)
        facts[sources], facts[sinks] = facts.pop("sources"), facts.pop("sinks")
        yield from flatten(facts, ("interface", name))
    for of, manager in contract.managers.items():
        for name, controller in manager.controllers.items():
            yield from flatten(_dumped(controller), ("controller", name))
            yield ("controller", name, "manager"), of
        yield from flatten({**_dumped(manager), "controllers": None}, ("manager", of))
    for key in ("managers", "configuration_id", "format", "gates"):
        del data[key]
    for name, inner in data.items():
        yield from flatten(inner, ("contract", name))
    yield from of_cameras(contract.devices)


def _ends(interface: ContractInterface) -> tuple[str, str]:
    return ("publishers", "subscribers") if interface.kind == "topic" else ("servers", "clients")


def _of_claims(contract: Contract) -> Iterator[tuple[Path, Leaf]]:
    """Yield who holds each command interface from the start, and who may."""
    holders: dict[str, list[str]] = {}
    for manager in contract.managers.values():
        for name, controller in manager.controllers.items():
            for claim in controller.command_interfaces:
                holders.setdefault(claim, []).append(name if controller.active else f"{name} (inactive)")
    for claim, names in holders.items():
        yield ("claim", claim), ", ".join(sorted(names))


def _of_placements(contract: Contract, description: Description) -> Iterator[tuple[Path, Leaf]]:
    for joint in description.joints:
        yield ("placement", joint.child), joint.pose
    for name, frame in contract.frames.items():
        if frame.pose is not None:
            yield ("placement", name), frame.pose.pose


def _of_description(target: str, description: Description) -> Iterator[tuple[Path, Leaf]]:
    """Yield what moves, collides and weighs, and what drives it; where joints stand is reported as placements."""
    for link in description.links:
        yield from flatten(as_json(link.inertial), (target, "inertia", link.name))
        if link.collisions:
            yield (target, "shapes", link.name), tuple(map(_shape, link.collisions))
        yield from flatten(as_json(link.visuals), (target, "visuals", link.name))
    for joint in description.joints:
        data = as_json(joint)
        assert isinstance(data, dict)
        yield from flatten({key: each for key, each in data.items() if key != "pose"}, (target, "joint", joint.name))
    yield from flatten(as_json(description.hardware), (target, "hardware"))


def _shape(collision: Collision) -> str:
    """Return a shape with its size and place as people read them."""
    geometry = collision.geometry
    if isinstance(geometry, Box):
        text = f"box {shown(geometry.size, 'm')}"
    elif isinstance(geometry, Cylinder):
        text = f"cylinder of radius {shown(geometry.radius, 'm')}, length {shown(geometry.length, 'm')}"
    elif isinstance(geometry, Sphere):
        text = f"sphere of radius {shown(geometry.radius, 'm')}"
    else:
        text = f"mesh {geometry.filename} by {shown(geometry.scale, '')}"
    return text if collision.pose == identity() else f"{text} at {shown(collision.pose, '')}"


def _of_bring_up(plan: BringUp, contract: Contract) -> Iterator[tuple[Path, Leaf]]:
    """Yield each step with what it waits for; of the order, what steps before one leave behind for its proof."""
    controllers = (named for manager in contract.managers.values() for named in manager.controllers.items())
    claiming = {name for name, each in controllers if each.command_interfaces or each.real_command_interfaces}
    for target in TARGETS:
        steps = plan.proven_steps(target)
        for number, step in enumerate(steps):
            path = ("step", target, step.name)
            asked = _dumped(step)
            if isinstance(step.request, Activation) and claiming.isdisjoint(step.request.controllers):
                asked[OBSERVED] = asked.pop("request")
            yield from flatten({**asked, "name": None, CALLED: step.name}, path)
            feeding = (before for before in steps[:number] if any(proof in step.proof for proof in before.effect))
            earlier = tuple(sorted(before.name for before in feeding))
            if earlier:
                yield (*path, "after"), earlier
    for watch in plan.watches:
        yield from flatten(_dumped(watch), ("watch", watch.device))


def _of_gates(gates: Gates, cell: str) -> Iterator[tuple[Path, Leaf]]:
    for pin in gates.versions:
        part = pin.part if pin.holder == cell else f"{pin.holder}.{pin.part}"
        yield ("matrix", part), Prose(f"{pin.answer}: {pin.reason}")
    for setting in gates.settings:
        for name, value in setting.values.items():
            # What a vendor has people do is one text; the rest is compared figure by figure.
            what = () if name == "does" else (name,)
            if name == _TURN and _ANGLES in setting.values:
                continue  # the same turn in other figures
            yield ("check", setting.sets, setting.device, *what), Prose(value)


def _of_middleware(files: Mapping[str, str]) -> Iterator[tuple[Path, Leaf]]:
    for path, text in files.items():
        host = _MIDDLEWARE.fullmatch(path)
        if host is not None:
            for variable in _EXPORT.finditer(text):
                yield ("middleware", host[1], variable[1]), variable[2].strip("\"'")


def _of_pairs(files: Mapping[str, str], srdf: str | None) -> Iterator[tuple[Path, Leaf]]:
    if srdf is None:
        return
    for pair in _xml(files, srdf).all("disable_collisions"):
        names = sorted(pair.attributes.get(key, "") for key in ("link1", "link2"))
        yield ("pair", " and ".join(names)), pair.attributes.get("reason", "")


def _of_policy(files: Mapping[str, str], cell: str) -> Iterator[tuple[Path, Leaf]]:
    if POLICY in files:
        yield from rights(_xml(files, POLICY), _xml(files, COMMON) if COMMON in files else None, cell)


def _xml(files: Mapping[str, str], path: str) -> XmlElement:
    read = read_xml(_text(files, path), path)
    if read.value is None:
        raise FactsError(f"{path}: line {read.diagnostics[0].span.line}: {read.diagnostics[0].message}")
    return read.value


def _of_spec(cell: Cell) -> Iterator[tuple[Path, Leaf]]:
    """Yield what a spec says and no other file of the package holds as data."""
    yield from flatten(as_json(cell.safety), ("spec", "safety"))
    yield from flatten(as_json(cell.surroundings), ("spec", "surroundings"))
    yield ("spec", "bringup", "gates"), cell.bringup.gates
    moving = Counter(first.name.partition("/")[0] for first in cell.bringup.first_motions)
    for first in cell.bringup.first_motions:
        of = first.name.partition("/")[0]
        path = ("spec", "bringup", "first_motion", of if moving[of] == 1 else first.name)
        yield from flatten(_without_place(as_json(first)), path)
    if cell.bringup.caps is not None:
        yield from flatten(as_json(cell.bringup.caps), ("spec", "bringup", "commissioning"))
    for section in ("recording", "network", "targets"):
        yield from flatten(as_json(getattr(cell, section)), ("spec", section))
    yield from flatten(as_json({**cell.mock_plugins, **cell.mock_programs}), ("spec", "mock_statements"))
    for frame in cell.frames:
        yield from graded_values(frame, ("frame", frame.name))
    for area in cell.areas:
        yield from flatten(_without_place(as_json(area)), ("area", area.name))
    for device in cell.devices:
        yield from graded_values(device, ("device", device.name))
        if device.site.connection is not None:
            yield ("device", device.name, "host"), device.site.connection.host
            yield from flatten(device.site.connection.nic, ("device", device.name, "nic"))
        yield from flatten(as_json(device.robot.program), ("spec", "program", device.name))
        least = None if device.gripper is None else device.gripper.min_force
        yield from flatten(least, ("device", device.name, "min_force"))
    for name, host in cell.hosts.items():
        yield from flatten(_without_place(as_json(host)), ("spec", "hosts", name))
    for node in cell.nodes:
        own = node if node.device is None else replace(node, host="")  # a driver runs where its device is connected
        yield from flatten(_without_place(as_json(own)), ("spec", "nodes", node.full_name))


def _of_stages(files: Mapping[str, str], contract: Contract) -> Iterator[tuple[Path, Leaf]]:
    """Yield what each stage of commissioning leaves, of joints as a share of their limits."""
    for percent, file in contract.files.stages.items():
        known = {".".join(map(str, path[2:])): leaf for path, leaf in flatten(_loaded(file, _text(files, file)), ())}
        for name, value in known.items():
            joint, _, of = name.removeprefix("robot_description_planning.joint_limits.").partition(".max_")
            limit = getattr(contract.joint_limits.get(joint), of, None) if of else None
            if limit is not None and isinstance(value, float):
                yield ("stage", f"{percent} %", joint, of), round(value / limit, 6)
            elif not name.startswith("robot_description_planning.joint_limits."):
                yield ("stage", f"{percent} %", name), value


def _of_excuses(excused: Sequence[Diagnostic]) -> Iterator[tuple[Path, Leaf]]:
    for diagnostic in excused:
        yield (
            ("excused", diagnostic.severity.value, f"{diagnostic.code}: {diagnostic.message}"),
            "by a comment in the spec",
        )


def _without_place(entity: Json) -> Json:
    assert isinstance(entity, dict)
    return {key: value for key, value in entity.items() if key not in ("name", "path", "span")}
