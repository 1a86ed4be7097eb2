"""Have common parsers read the generated XML and YAML files."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Sequence

import yaml

from cellc.artifact import Artifact
from cellc.verify.disagreement import Disagreement

_XML = (".xml", ".urdf", ".srdf", ".xacro", ".svg")
_YAML = (".yaml", ".yml", ".repos")


def check_text(artifacts: Sequence[Artifact]) -> Iterator[Disagreement]:
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
