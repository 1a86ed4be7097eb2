"""Reads the scene of a generated folder, and which of its bodies may touch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations, product
from pathlib import Path

from cellc.contract.contract import Contract
from cellc.contract.limits import limits
from cellc.contract.store.regular_file import read_regular
from cellc.mock.errors import MockError
from cellc.mock.folder import GeneratedFolder, read_text
from cellc.robot.description.meshes import MeshFile, identify_all
from cellc.robot.description.model import Description, Mesh
from cellc.robot.description.xml_tree import read_xml
from cellc.robot.physics.scene import Scene, SceneError

SCENE_FILE = "sim/scene.xml"


def with_scene(read: GeneratedFolder, folder: Path) -> GeneratedFolder:
    """Return a folder whose joints and parts have mass.

    Raises:
        MissingExtraError: MuJoCo is not installed.
        MockError: it has no scene, or one that cannot be used.
    """
    if SCENE_FILE not in read.listed:
        raise MockError(folder.as_posix(), f"holds no {SCENE_FILE}, which `--physics` needs; build it again")
    text = read_text(folder, SCENE_FILE)
    try:
        return replace(read, scene=Scene(text, _meshes(text, read.mesh_roots)))
    except SceneError as error:
        raise MockError(SCENE_FILE, str(error)) from None


def _meshes(scene: str, roots: tuple[Path, ...]) -> Mapping[str, bytes]:
    """Return the content of each mesh that a scene names."""
    read = read_xml(scene, SCENE_FILE)
    assets = () if read.value is None else tuple(each for each in read.value.all("asset"))
    names = (mesh.attributes.get("file", "") for asset in assets for mesh in asset.all("mesh"))
    found: dict[str, bytes] = {}
    for name, file in identify_all((Mesh(name, (1.0, 1.0, 1.0)) for name in dict.fromkeys(names)), roots).items():
        if not isinstance(file, MeshFile):
            raise MockError(SCENE_FILE, str(file))
        found[name] = read_regular(Path(file.path), limits().mesh_bytes_together)
    return found


def planned_contacts(scene: Scene, fingers: Mapping[str, tuple[str, ...]]) -> frozenset[frozenset[str]]:
    """Return the pairs of bodies that are to touch: parts and what they lie on, fingers and parts, and fingers."""
    pairs = [(part, other) for part in scene.parts for other in (*scene.fixed, *scene.parts)]
    for links in fingers.values():
        pairs += [*product(scene.parts, links), *combinations(links, 2)]
    return frozenset(frozenset(pair) for pair in pairs)


def fingers_by_gripper(contract: Contract, description: Description) -> dict[str, tuple[str, ...]]:
    """Return the links of the fingers of each gripper."""
    grippers = {name: device.gripper for name, device in contract.devices.items() if device.gripper is not None}
    return {name: fingers_of(description, gripper.joint) for name, gripper in grippers.items()}


def fingers_of(description: Description, joint: str) -> tuple[str, ...]:
    """Return the links that move with the joint of a gripper, sorted."""
    joints, moving = description.joints, set[str]()
    for each in joints:
        if each.name == joint or (each.mimic is not None and each.mimic.joint == joint):
            moving.add(each.child)
    while more := {each.child for each in joints if each.parent in moving} - moving:
        moving |= more
    return tuple(sorted(moving))
