"""``manifest.json``: the hash of every generated file beside the configuration that they were made from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from cellc.artifact import Artifact
from cellc.contract.manifest import ConfigurationInputs, Manifest
from cellc.formats.json_text import render
from cellc.output.plan import MANIFEST, sha256
from cellc.version import __version__


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
    ordered = sorted(artifacts, key=lambda artifact: artifact.path)
    manifest = Manifest(
        format=1,
        cell=cell,
        cellc_version=__version__,
        configuration_id=configuration_id,
        configuration_inputs=configuration_inputs,
        version_tuple=dict(version_tuple),
        files={artifact.path: sha256(artifact.text.encode()) for artifact in ordered},
    )
    return (*ordered, Artifact(MANIFEST, render(manifest)))
