"""``manifest.json``: the hash of every generated file beside the configuration that they were made from."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from cellc.compiler.artifact import Artifact
from cellc.contract.limits import limits
from cellc.version import __version__

if TYPE_CHECKING:
    from cellc.contract.manifest import ConfigurationInputs

MANIFEST = "manifest.json"
_FORMAT = 1


def with_manifest(
    artifacts: Sequence[Artifact],
    *,
    cell: str,
    configuration_id: str,
    configuration_inputs: ConfigurationInputs,
    version_tuple: Mapping[str, str],
) -> tuple[Artifact, ...]:
    """Return the artifacts in the order of their paths, and last the manifest over all of them.

    Args:
        cell: name of the cell.
        configuration_id: id over ``configuration_inputs``.
        version_tuple: pinned versions by part, ``UNKNOWN`` where one is not known.
    """
    # A build of what is unchanged makes no manifest, and loads no models.
    from cellc.compiler.formats.json_text import render
    from cellc.contract.manifest import Manifest

    ordered = sorted(artifacts, key=lambda artifact: artifact.path)
    manifest = Manifest(
        format=_FORMAT,
        cell=cell,
        cellc_version=__version__,
        configuration_id=configuration_id,
        configuration_inputs=configuration_inputs,
        version_tuple=dict(version_tuple),
        files={artifact.path: sha256(artifact.content) for artifact in ordered},
    )
    return (*ordered, Artifact(MANIFEST, render(manifest)))


def sha256(content: bytes) -> str:
    """Return the digest of a file's bytes as hexadecimal digits."""
    return hashlib.sha256(content).hexdigest()


def hashes_in(content: bytes | None) -> dict[str, str]:
    """Return the hashes of the files that a manifest or a lock lists; none where it is absent or neither.

    Only what is needed is read, without the model of the whole file: a build that changes nothing loads no models.
    """
    if content is None or len(content) > limits().folder_bytes:  # parsed it would take thirty times as much
        return {}
    try:
        manifest = json.loads(content)
    except (ValueError, RecursionError):
        return {}
    if not isinstance(manifest, dict) or manifest.get("format") != _FORMAT:
        return {}
    files = manifest.get("files")
    if not isinstance(files, dict) or not all(isinstance(digest, str) for digest in files.values()):
        return {}
    return {path: digest.removeprefix("sha256:") for path, digest in files.items()}
