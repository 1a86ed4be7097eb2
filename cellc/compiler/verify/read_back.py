"""Read our artifacts back with parsers that we did not write.

Common parsers read every XML, YAML and JSON file, published schemas hold the JSON files, and two robot libraries read
each description.
"""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match
from pydantic import BaseModel

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.files import SCENE
from cellc.compiler.verify.description import check_description
from cellc.compiler.verify.disagreement import Disagreement
from cellc.compiler.verify.meant import Meant
from cellc.compiler.verify.scene import check_scene
from cellc.contract.base import contract_schema
from cellc.contract.contract import Contract
from cellc.contract.manifest import Manifest
from cellc.contract.rehearsals import Rehearsals

_XML = (".xml", ".urdf", ".srdf", ".xacro", ".svg")
_YAML = (".yaml", ".yml", ".repos", ".rviz")

_MODELS: Mapping[str, type[BaseModel]] = {
    "contract.json": Contract,
    "manifest.json": Manifest,
    "rehearsals.json": Rehearsals,
}


def read_back(artifacts: Sequence[Artifact], meant: Meant) -> Iterator[Disagreement]:
    """Yield everything that foreign parsers make of the artifacts and the cell does not mean.

    Importing this module takes a quarter of a build.
    """
    malformed = tuple(_check_text(artifacts))
    yield from malformed
    yield from _check_json(artifacts)
    broken = {disagreement.path for disagreement in malformed}
    for artifact in artifacts:
        if artifact.path.endswith(".urdf") and artifact.path not in broken:
            yield from check_description(artifact, meant.parts.get(artifact.path, meant))
        elif artifact.path == SCENE and artifact.path not in broken:
            yield from check_scene(artifact, meant)


def _check_text(artifacts: Sequence[Artifact]) -> Iterator[Disagreement]:
    """Yield the files that are not what the end of their name says."""
    for artifact in artifacts:
        if artifact.path.endswith(_XML):
            yield from _check_xml(artifact)
        elif artifact.path.endswith(_YAML):
            yield from _check_yaml(artifact)


def _check_xml(artifact: Artifact) -> Iterator[Disagreement]:
    try:
        root = ElementTree.fromstring(artifact.text)
    except ElementTree.ParseError as error:
        yield Disagreement("verify-text", artifact.path, f"is not well-formed XML: {error}")
        return
    if _flat(ElementTree.fromstring(ElementTree.tostring(root))) != _flat(root):
        yield Disagreement("verify-text", artifact.path, "changes when it is read and written again")


def _flat(root: ElementTree.Element) -> list[tuple[str, dict[str, str], str | None, str | None]]:
    return [(element.tag, element.attrib, element.text, element.tail) for element in root.iter()]


def _check_yaml(artifact: Artifact) -> Iterator[Disagreement]:
    try:
        # The rules of YAML 1.1, as rcl reads parameters and most Python nodes read files.
        yaml.load(artifact.text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except (yaml.YAMLError, ValueError) as error:
        yield Disagreement("verify-text", artifact.path, f"is not YAML: {error}")


def _check_json(artifacts: Sequence[Artifact]) -> Iterator[Disagreement]:
    """Yield the JSON files that do not fit their schema, or name another configuration than the contract."""
    read: dict[str, Any] = {}
    for artifact in artifacts:
        if not artifact.path.endswith(".json"):
            continue
        try:
            read[artifact.path] = json.loads(artifact.text, parse_constant=_refuse)
        except ValueError as error:
            yield Disagreement("verify-json", artifact.path, f"is not JSON: {error}")
            continue
        yield from _check_schema(artifact.path, read[artifact.path])
    yield from _check_configuration(read)
    yield from _check_files(read, {artifact.path for artifact in artifacts})


def _refuse(constant: str) -> float:
    raise ValueError(f"{constant} is not a number of JSON")


def _check_schema(path: str, data: object) -> Iterator[Disagreement]:
    if path not in _MODELS:
        return
    error = best_match(_validator(path).iter_errors(data))
    if error is not None:
        yield Disagreement("verify-json", path, f"{error.json_path} does not fit the schema: {error.message[:200]}")


@cache
def _validator(path: str) -> Draft202012Validator:
    return Draft202012Validator(contract_schema(_MODELS[path]))


def _check_configuration(read: Mapping[str, Any]) -> Iterator[Disagreement]:
    contract, manifest = read.get("contract.json"), read.get("manifest.json")
    if isinstance(contract, dict) and isinstance(manifest, dict):
        ours, theirs = manifest.get("configuration_id"), contract.get("configuration_id")
        if ours != theirs:
            yield Disagreement("verify-json", "manifest.json", f"names configuration {ours}, the contract {theirs}")


def _check_files(read: Mapping[str, Any], made: set[str]) -> Iterator[Disagreement]:
    contract = read.get("contract.json")
    files = contract.get("files") if isinstance(contract, dict) else None
    if not isinstance(files, dict):
        return
    parameters = files.get("parameters")
    named = [*files.values(), *(parameters.values() if isinstance(parameters, dict) else ())]
    for path in sorted({name for name in named if isinstance(name, str)} - made):
        yield Disagreement("verify-json", "contract.json", f"names the file `{path}`, which is not made")
