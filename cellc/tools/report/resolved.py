"""The resolved cell as a tree of values, each with its source: spec line, catalog, or default."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Union

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import Device, DeviceJoint, DeviceVersions, LimitShares
from cellc.compiler.cell.entity import ELSEWHERE, STATED, Entity
from cellc.compiler.cell.frame import Frame
from cellc.compiler.cell.members import field_names, members
from cellc.compiler.cell.site import JointFigure
from cellc.contract.diagnostics import YamlPath
from cellc.contract.transforms import Pose

Tree = Union["Leaf", dict[str, "Tree"]]

_BOOKKEEPING = {"name", "path", "span"}
_DERIVED = {"measured_on", "joints"}
# Resolved field → keys of which the user writes one, where dropping the unit's suffix does not give it.
_KEYS = {
    "transform_to_parent": ("xyz",),
    "transform_root_to_parent": ("mount",),
    "parent_frame": ("mount",),
    "transform_tip_to_frame": ("xyz",),
    "base_link": ("base",),
    "tip_frame": ("tip",),
    "authority": ("published_by",),
    "size": ("box",),
    "package": ("run",),
    "executable": ("run",),
    "kind": ("type", "topic", "service", "action"),
    "type": ("topic", "service", "action"),
    "sources": ("from", "server"),
    "sinks": ("to", "client"),
    "velocity": ("limits",),
    "acceleration": ("limits",),
}
_FROM_CATALOG = {
    Device: {"root_link", "frames", "joints", "hardware", "tool_frame"},
    Controller: {"behavior", "plugin", "joints", "command_interfaces", "state_interfaces", "action", "action_type"},
    Frame: {"parent", "transform_to_parent", "kind", "moving", "device"},
}


@dataclass(frozen=True, slots=True)
class Leaf:
    """One value as text, and its origin."""

    text: str
    origin: str


def resolved_tree(cell: Cell) -> dict[str, Tree]:
    """Return the whole cell under the keys that the spec uses."""
    tree: dict[str, Tree] = {"cell": Leaf(cell.name, _written(cell, ("cell",)))}
    for section in ("versions", "hosts", "network", "calibrations"):
        tree[section] = _section(cell, getattr(cell, section), (section,))
    tree |= {
        "devices": _entities(cell, cell.devices),
        "frames": _entities(cell, cell.frames),
        "scene": _entities(cell, cell.scene),
        "areas": _entities(cell, cell.areas),
        "nodes": {node.full_name.lstrip("/"): _entity(cell, node) for node in cell.nodes},
        "interfaces": _entities(cell, cell.interfaces),
        "managers": _entities(cell, cell.managers),
        "controllers": _entities(cell, cell.controllers),
    }
    tree["motion"] = {
        "groups": _entities(cell, cell.groups),
        "poses": {f"{pose.name}.{pose.group}": _entity(cell, pose) for pose in cell.poses},
        "goals": _entities(cell, cell.goals),
        **{key: _section(cell, part, ("motion", key)) for key in ("octomap", "servo") if (part := getattr(cell, key))},
    }
    tree["rehearsals"] = _entities(cell, cell.rehearsals)
    sections = (
        "surroundings",
        "owners",
        "safety",
        "bringup",
        "kpis",
        "recording",
        "targets",
        "mock_plugins",
        "mock_programs",
    )
    for section in sections:
        tree[section] = _section(cell, getattr(cell, section), (section,))
    return tree


def _entities(cell: Cell, entities: tuple[Entity, ...]) -> Tree:
    return {entity.name: _entity(cell, entity) for entity in entities}


def _entity(cell: Cell, entity: Entity) -> Tree:
    tree: dict[str, Tree] = {}
    for member in members(entity):
        name, value, path = member.name, member.value, (*entity.path, member.name)
        if name in _BOOKKEEPING or value == () or ELSEWHERE in member.marks:
            continue
        if STATED in member.marks:
            tree[_key(name)] = _section(cell, value, (*entity.path, _key(name)))
        elif isinstance(value, DeviceVersions):
            tree |= {part: _section(cell, text, (*entity.path, part)) for part, text in value.items()}
        elif isinstance(value, LimitShares):
            tree["limits"] = _section(cell, value, (*entity.path, "limits"))
        elif isinstance(entity, Device) and name == "stamp":
            tree[name] = _stamp(cell, entity)
        elif value is not None:
            tree[name] = _value(cell, value, _origin(cell, entity, name), path)
    return tree


def _stamp(cell: Cell, device: Device) -> Tree:
    """Return the stamp of a sensor, whose clock the spec writes beside the source."""
    stamp, path = device.sensing.stamp, (*device.path, "stamp")
    if stamp is None:
        return _section(cell, None, path)
    clock = _section(cell, replace(stamp.clock, domain=""), path)
    assert isinstance(clock, dict)
    shown = {"source": stamp.source, "clock": stamp.clock.domain, "exposure": device.sensing.exposure_s}
    return {key: _section(cell, value, (*path, key)) for key, value in shown.items()} | {
        key: value for key, value in clock.items() if key != "domain"
    }


def _value(cell: Cell, value: object, origin: str, path: YamlPath) -> Tree:
    if isinstance(value, tuple) and value and all(isinstance(item, Entity) for item in value):
        return {f"{item.name or index}": _entity(cell, item) for index, item in enumerate(value)}
    if isinstance(value, Mapping):
        return {str(key): _value(cell, item, origin, path) for key, item in value.items()}
    if isinstance(value, tuple) and value and all(map(field_names, value)):
        return {str(index): _value(cell, item, origin, path) for index, item in enumerate(value)}
    if (names := field_names(value)) and not isinstance(value, Pose):
        shown = (name for name in names if name not in ("path", "span"))
        return {name: _value(cell, getattr(value, name), origin, path) for name in shown}
    return Leaf(_text(value), origin)


def _section(cell: Cell, value: object, path: YamlPath) -> Tree:
    """Return what is under a key of the spec, as written where the user wrote it."""
    if (names := field_names(value)) and not isinstance(value, JointFigure):
        hidden = {*_BOOKKEEPING, *_DERIVED} if isinstance(value, Entity) else set[str]()
        keys = {_key(name): name for name in names if name not in hidden}
        return {key: _section(cell, getattr(value, name), (*path, key)) for key, name in keys.items()}
    if isinstance(value, Mapping):
        return {str(key): _section(cell, item, (*path, key)) for key, item in value.items()}
    if isinstance(value, tuple) and value and all(isinstance(item, Entity) for item in value):
        return {item.name: _section(cell, item, item.path) for item in value}
    if isinstance(value, tuple) and value and all(map(field_names, value)):
        return {str(index): _section(cell, item, (*path, index)) for index, item in enumerate(value)}
    return Leaf(cell.text(*path) or _text(value), _written(cell, path))


def _key(field: str) -> str:
    """Return the key of the spec behind a field: its name without the unit."""
    return field.removesuffix("_hz").removesuffix("_kg").removesuffix("_s").removesuffix("_m").removesuffix("_v")


def _written(cell: Cell, path: YamlPath) -> str:
    if not cell.states(*path):
        return "default"
    span = cell.locate(*path)
    return f"{span.file}:{span.line}"


def _origin(cell: Cell, entity: Entity, field: str) -> str:
    keys = _KEYS.get(field) or (_key(field),)
    key = next((key for key in keys if cell.states(*entity.path, key)), keys[0])
    path = (*entity.path, key)
    catalog = f"catalog {_catalog_entry(cell, entity)}"
    if isinstance(entity, DeviceJoint):
        tightened = key == "limits" and cell.states(*path, field)
        return f"{_written(cell, (*path, field))} of {catalog}" if tightened else catalog
    if isinstance(entity, Controller) and field == "parameters":
        # Some follow from the controller's keys, some from its device, some from its kind.
        return f"{_written(cell, entity.path)} with {catalog}"
    if cell.states(*path):
        return _written(cell, path)
    if isinstance(entity, Frame) and entity.device is None and field in _FROM_CATALOG[Frame]:
        return _written(cell, entity.path)  # a frame of the spec is what its entry makes it
    known = next((names for kind, names in _FROM_CATALOG.items() if isinstance(entity, kind)), set[str]())
    derived = field in known or getattr(entity, "derived", False)
    return catalog if derived else "default"


def _catalog_entry(cell: Cell, entity: Entity) -> str:
    if isinstance(entity, Controller):
        return f"controllers/{entity.kind}"
    device = next((device for device in cell.devices if entity.path[:2] == device.path), None)
    return "interfaces" if device is None else f"devices/{device.model}"


def _text(value: object) -> str:
    if isinstance(value, Pose):
        xyz = " ".join(_number(part) for part in value.position)
        rpy = " ".join(_number(math.degrees(part)) for part in value.rpy())
        return f"xyz {xyz} m, rpy {rpy} deg"
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "none"}[value]
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, (tuple, frozenset)):
        items = map(_text, value)
        return f"[{', '.join(items if isinstance(value, tuple) else sorted(items))}]"
    return str(value)


def _number(value: float) -> str:
    """Write a number for reading: nine digits, so that rounding of the last bits does not show."""
    return f"{value + 0.0:.9g}"


def resolved_at(tree: Tree, path: YamlPath) -> list[tuple[Tree, str]]:
    """Return what becomes of a path of the spec, with its dotted names: one key may become several values, or none."""
    trees = [(tree, "")]
    for part in ("managers", *path) if path[:1] == ("control",) else path:
        trees = [pair for inner, name in trees for pair in _step(inner, name, str(part))]
    return trees


def _step(tree: Tree, name: str, part: str) -> Iterator[tuple[Tree, str]]:
    if isinstance(tree, Leaf) or part in name.split("."):
        # The rest of the path is part of this value, as `xyz` of a mount, or of its name, as the group of a pose.
        yield tree, name
        return
    for key, value in tree.items():
        if part in (key, _key(key), *_KEYS.get(key, ()), key.partition(".")[0]):
            yield value, f"{name}.{key}" if name else key


def flatten(tree: Tree, prefix: str = "") -> Iterator[tuple[str, Leaf]]:
    """Yield the leaves with their dotted paths, in order."""
    if isinstance(tree, Leaf):
        yield prefix, tree
        return
    for key, value in tree.items():
        yield from flatten(value, f"{prefix}.{key}" if prefix else key)
