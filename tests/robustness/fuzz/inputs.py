"""Input N of kind K: its files, which are a function of both and of the documents of the repository."""

from __future__ import annotations

import copy
import hashlib
import json
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from xml.etree import ElementTree

import yaml

from tests.robustness.fuzz import bases, meshes
from tests.robustness.fuzz.byte_mutations import mutate_bytes
from tests.robustness.fuzz.hostile import TEXTS
from tests.robustness.fuzz.tree import Tree, copied, places, put, read_yaml, write_json, write_yaml
from tests.robustness.fuzz.tree_mutations import TreeMutator
from tests.robustness.fuzz.xml_mutations import XmlMutator

SPEC, FOLDER = "cell.yaml", "folder"
URDF, XACRO, OUT = "device/robot.urdf", "device/robot.xacro", "out"
"""What is imported, and the folder that it becomes."""
_PACKAGE = b"<package><name>device</name><license>BSD</license></package>"
_PARAMETERS = (
    b"controller_manager: {ros__parameters: {update_rate: 250}}\n"
    b"arm: {ros__parameters: {joints: [turn, lift], constraints: {goal_time: 0.6}}}\n"
)
_PARSED = ("contract.json", "rehearsals.json", "manifest.json")


@dataclass(frozen=True)
class FuzzInput:
    """One input.

    Args:
        files: by their path in the folder of the input, which also holds ``parts/`` of the corpus.
        damage: what is done to the cache before the last run, in words of `cache_damage`; of the kind "cache" alone.
        later: files that are written between the first run and the last.
    """

    kind: str
    number: int
    files: Mapping[str, bytes]
    damage: Sequence[str] = ()
    later: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def chance(self) -> random.Random:
        """Draws what is done with the input, the same in every run."""
        return random.Random(f"{self.kind} {self.number} done")


def make_input(kind: str, number: int) -> FuzzInput:
    """Return an input.

    Args:
        kind: one of `KINDS`.
    """
    chance = random.Random(f"{kind} {number}")
    return _MAKERS[kind](number, chance)


def _times(chance: random.Random) -> int:
    return chance.choice((1, 1, 1, 1, 2, 2, 3, 6))


def _base(items: Sequence[Tree], small: int, chance: random.Random) -> Tree:
    """Return a copy of an item, in four cases of five one of the first, which are small."""
    return copied(chance.choice(items[:small] if chance.random() < 0.8 else items))


def _mutated(tree: Tree, others: Sequence[Tree], chance: random.Random) -> bytes:
    """Change a YAML document: its structure mostly, its bytes at times, or both."""
    draw = chance.random()
    if draw < 0.92:
        tree = TreeMutator(tree, others, chance, json=False).mutate(_times(chance))
    data = write_yaml(tree).encode("utf-8", "surrogatepass")
    for _ in range(_times(chance) if draw > 0.89 else 0):
        data = mutate_bytes(data, chance)
    return data


def _spec(number: int, chance: random.Random) -> FuzzInput:
    specs = bases.specs()
    if chance.random() < 0.93:
        return FuzzInput("spec", number, {SPEC: _mutated(_base(specs, len(bases.TINY), chance), specs, chance)})
    whole = _base(specs, len(bases.TINY), chance)
    assert isinstance(whole, dict)
    moved = {key: whole.pop(key) for key in chance.sample(sorted(whole), min(3, len(whole)))}
    names = ["part.yaml", "parts/../part.yaml", "./part.yaml", *TEXTS]
    includes: list[Tree] = ["part.yaml", *chance.sample(names, chance.choice((0, 0, 1, 2)))]
    whole["include"] = includes
    part = _mutated(moved, specs, chance)
    return FuzzInput("spec", number, {SPEC: write_yaml(whole).encode("utf-8", "surrogatepass"), "part.yaml": part})


def _device(number: int, chance: random.Random) -> FuzzInput:
    devices = bases.devices()
    base = chance.choice(devices[:4] if chance.random() < 0.75 else devices)
    facts = _mutated(copied(base.facts), [device.facts for device in devices], chance)
    spec = write_yaml(base.spec).encode()
    return FuzzInput(
        "device", number, {SPEC: spec, "device/device.yaml": facts, "device/device.urdf": base.urdf.encode()}
    )


def _description(number: int, chance: random.Random) -> FuzzInput:
    devices = bases.devices()
    index = chance.randrange(4 if chance.random() < 0.75 else len(devices))
    base, draw = devices[index], chance.random()
    files = {SPEC: write_yaml(base.spec).encode()}
    if draw < 0.3:
        return _xacro(number, chance)
    root = copy.deepcopy(bases.descriptions()[index])
    if draw < 0.36:
        files |= _with_mesh(root, chance)
    if draw < 0.34:
        text = ElementTree.tostring(root, encoding="unicode")
    else:
        text = XmlMutator(root, bases.descriptions(), chance, xacro=False).mutate(_times(chance))
    data = text.encode("utf-8", "surrogatepass")
    for _ in range(1 if draw > 0.92 else 0):
        data = mutate_bytes(data, chance)
    files |= {"device/device.yaml": write_yaml(base.facts).encode(), "device/device.urdf": data}
    return FuzzInput("description", number, files)


def _with_mesh(root: ElementTree.Element, chance: random.Random) -> dict[str, bytes]:
    """Let a link collide as a mesh, and return the mesh's file."""
    name = chance.choice(sorted(meshes.shapes()))
    data = meshes.shapes()[name]
    for _ in range(_times(chance)):
        data = meshes.damaged(name, data, chance)
    written = [
        f"package://device/{name}",
        f"device/{name}",
        name,
        f"package://{name}",
        f"file://{name}",
        f"package://device/../device/{name}",
    ]
    named = chance.choice(written[:2] * 8 + written + [text for text in TEXTS if "/" in text])
    links = list(root.iter("link"))
    geometry = ElementTree.SubElement(ElementTree.SubElement(chance.choice(links), "collision"), "geometry")
    mesh = ElementTree.SubElement(geometry, "mesh", {"filename": named})
    if chance.random() < 0.3:
        mesh.set(
            "scale",
            chance.choice(("1 1 1", "0.001 0.001 0.001", "0 0 0", "-1 1 1", "nan 1 1", "1e300 1e300 1e300", "1", "")),
        )
    return {f"device/{name}": data}


def _xacro(number: int, chance: random.Random) -> FuzzInput:
    base = bases.devices()[0]
    assert isinstance(base.facts, dict)
    facts: dict[str, Tree] = {**base.facts, "description": {"file": "robot.xacro"}, "frames": {"base": "base"}}
    root = ElementTree.fromstring(chance.choice(bases.xacros()))
    text = XmlMutator(root, bases.descriptions(), chance, xacro=True).mutate(_times(chance))
    data = text.encode("utf-8", "surrogatepass")
    for _ in range(1 if chance.random() < 0.1 else 0):
        data = mutate_bytes(data, chance)
    beside = bases.xacro_files()
    if chance.random() < 0.15:
        name = chance.choice(sorted(beside))
        beside[name] = mutate_bytes(beside[name], chance)
    files = {
        SPEC: write_yaml(base.spec).encode(),
        "device/device.yaml": write_yaml(facts).encode(),
        "device/robot.xacro": data,
        **beside,
    }
    return FuzzInput("description", number, files)


def _folder(number: int, chance: random.Random) -> FuzzInput:
    base = chance.choice(bases.folders())
    files = {f"{FOLDER}/{name}": data for name, data in base.files.items()}
    names = _read_by_the_mock(base)
    for _ in range(chance.choice((1, 1, 1, 2))):
        name = chance.choice(names)
        files[f"{FOLDER}/{name}"] = _damaged_artifact(name, files[f"{FOLDER}/{name}"], chance)
    if chance.random() < 0.03:
        del files[f"{FOLDER}/{chance.choice(names)}"]
    return FuzzInput("folder", number, files)


def _read_by_the_mock(base: bases.FolderBase) -> list[str]:
    """Return the files that the mock reads, the contract most often."""
    parsed = [
        name
        for name in base.files
        if name.endswith((".srdf", "controllers.yaml", "controllers.mock.yaml", ".mock.urdf"))
    ]
    return ["contract.json"] * 5 + ["rehearsals.json"] * 3 + ["manifest.json", *parsed]


def _damaged_artifact(name: str, data: bytes, chance: random.Random) -> bytes:
    if chance.random() < 0.15:
        return mutate_bytes(data, chance)
    try:
        if name.endswith(".json"):
            tree: Tree = json.loads(data)
            return write_json(TreeMutator(tree, _parsed_jsons(), chance, json=True).mutate(_times(chance))).encode(
                "utf-8", "surrogatepass"
            )
        if name.endswith(".yaml"):
            return write_yaml(
                TreeMutator(read_yaml(data.decode()), bases.specs(), chance, json=False).mutate(_times(chance)), 9
            ).encode("utf-8", "surrogatepass")
        root = ElementTree.fromstring(data)
        return (
            XmlMutator(root, bases.descriptions(), chance, xacro=False)
            .mutate(_times(chance))
            .encode("utf-8", "surrogatepass")
        )
    except (ValueError, RecursionError, SyntaxError, yaml.YAMLError):  # what was damaged before is damaged in its bytes
        return mutate_bytes(data, chance)


@cache
def _parsed_jsons() -> tuple[Tree, ...]:
    return tuple(json.loads(folder.files[name]) for folder in bases.folders() for name in _PARSED)


def _import(number: int, chance: random.Random) -> FuzzInput:
    """Return the package of a robot as its vendor ships it, and at times what an earlier import left."""
    devices, descriptions = bases.devices(), bases.descriptions()
    index = chance.randrange(4 if chance.random() < 0.85 else len(devices))
    root, base = copy.deepcopy(descriptions[index]), devices[index]
    is_xacro = chance.random() < 0.12
    files = _with_mesh(root, chance) if chance.random() < 0.4 else {}
    if is_xacro:
        root = ElementTree.fromstring(chance.choice(bases.xacros()))
        files |= bases.xacro_files()
    text = XmlMutator(root, descriptions, chance, xacro=is_xacro).mutate(_times(chance))
    data = text.encode("utf-8", "surrogatepass")
    for _ in range(_times(chance) if chance.random() < 0.15 else 0):
        data = mutate_bytes(data, chance)
    files[XACRO if is_xacro else URDF] = data
    links = [link.get("name", "") for link in root.iter("link")]
    for name, share, content in (
        ("device/package.xml", 0.4, _PACKAGE),
        ("device/robot.srdf", 0.4, _semantic(root.get("name", ""), links)),
        ("device/controllers.yaml", 0.3, _PARAMETERS),
    ):
        if chance.random() < share:
            files[name] = mutate_bytes(content, chance) if chance.random() < 0.7 else content
    return FuzzInput("import", number, files | (_imported_before(base, chance) if chance.random() < 0.25 else {}))


def _semantic(robot: str, links: Sequence[str]) -> bytes:
    root = ElementTree.Element("robot", {"name": robot})
    for first, second in pairwise(links):
        ElementTree.SubElement(root, "disable_collisions", {"link1": first, "link2": second, "reason": "Adjacent"})
    return ElementTree.tostring(root)


def _imported_before(base: bases.DeviceBase, chance: random.Random) -> dict[str, bytes]:
    """Return a device folder that the import shall replace."""
    urdf = base.urdf.encode()
    files: dict[str, Tree] = {"robot.urdf": f"sha256:{hashlib.sha256(urdf).hexdigest()}"}
    lock: Tree = {"format": 1, "source": "robot.urdf", "files": files, "device": copied(base.facts)}
    if chance.random() < 0.7:
        lock = TreeMutator(lock, _parsed_jsons(), chance, json=True).mutate(_times(chance))
    facts = _mutated(copied(base.facts), [device.facts for device in bases.devices()], chance)
    left = {"robot.urdf": urdf, "device.yaml": facts, "import.lock.json": write_json(lock).encode("utf-8", "replace")}
    return {f"{OUT}/{name}": data for name, data in left.items() if chance.random() < 0.9}


DAMAGES = (
    "cut", "empty", "noise", "swap", "copy", "folder", "link", "fifo", "huge", "bomb", "garbled", "wrong shape",
    "not json", "other version", "old part", "no folder", "file for folder", "link for folder", "unreadable",
)  # fmt: skip

_CHEAP = [name for name in DAMAGES if name not in ("huge", "bomb")]


def _cache(number: int, chance: random.Random) -> FuzzInput:
    """Return a cell with a mesh whose answers are kept, what happens to the cache, and what changes meanwhile."""
    files, later = _kept_cell(chance), {}
    damage = chance.sample(DAMAGES if chance.random() < 0.2 else _CHEAP, chance.choice((0, 1, 1, 1, 2)))
    if not damage or chance.random() < 0.5:
        other = _kept_cell(chance)
        names = chance.sample(sorted(files), chance.choice((1, 1, 2)))
        later = {name: other[name] for name in names if name in other}
    return FuzzInput("cache", number, files, damage, later)


def _kept_cell(chance: random.Random) -> dict[str, bytes]:
    """Return a cell of one stage whose shapes, limits, poses and goals differ in few ways, so that answers recur."""
    base = bases.devices()[0]
    spec = read_yaml(bases.TINY[1].replace("./parts/stage", "./device"))
    for holder, key in places(spec):
        if key == "xyz" and chance.random() < 0.4:
            put(holder, key, chance.choice(("0.3 0 0 m", "2 0 0 m")))
    side = chance.choice(("0.02", "1"))
    shape = chance.choice((f'<box size="{side} {side} {side}"/>', '<mesh filename="package://device/shape.stl"/>'))
    urdf = base.urdf.replace(
        '<link name="arm"/>', f'<link name="arm"><collision><geometry>{shape}</geometry></collision></link>'
    )
    urdf = urdf.replace('lower="-3"', chance.choice(('lower="-3"', 'lower="1"')))
    scale = chance.choice((1, 1, 30))
    return {
        SPEC: write_yaml(spec).encode(),
        "device/device.yaml": write_yaml(base.facts).encode(),
        "device/device.urdf": urdf.encode(),
        "device/shape.stl": meshes.binary_stl(scale),
    }


_MAKERS: Mapping[str, Callable[[int, random.Random], FuzzInput]] = {
    "spec": _spec,
    "device": _device,
    "description": _description,
    "folder": _folder,
    "cache": _cache,
    "import": _import,
}
KINDS = tuple(_MAKERS)
