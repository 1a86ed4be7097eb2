"""Small sets of artifacts, and what a folder holds."""

from __future__ import annotations

import fcntl
from pathlib import Path
from typing import BinaryIO

from cellc.compiler.artifact import Artifact
from cellc.compiler.output.manifest import with_manifest
from cellc.contract.manifest import ConfigurationInputs

_at_work: list[BinaryIO] = []


def staging_at_work(place: Path) -> None:
    """Make the staging folder of somebody who is at work until the tests end: marked, and locked, as cellc does it."""
    place.mkdir(0o1777)
    lock = (place / ".cellc-lock").open("wb")
    fcntl.flock(lock, fcntl.LOCK_EX)
    _at_work.append(lock)


def build_of(**texts: str) -> tuple[Artifact, ...]:
    """Return artifacts with their manifest; ``config__a_yaml`` stands for ``config/a.yaml``."""
    named = {name.replace("__", "/").replace("_", "."): text for name, text in texts.items()}
    return artifacts_of(named)


def artifacts_of(texts: dict[str, str]) -> tuple[Artifact, ...]:
    """Return artifacts with their manifest, by path."""
    return with_manifest(
        [Artifact(path, text) for path, text in texts.items()],
        cell="small",
        configuration_id="cfg-000000000000",
        configuration_inputs=ConfigurationInputs(calibrations={}, tf_publishers={}, urdf_sha256="0" * 64),
        version_tuple={"ros": "jazzy"},
    )


def contents(folder: Path) -> dict[str, str]:
    """Return the text of every file below a folder, hidden ones too, by path; empty folders end in a slash."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_file():
            found[name] = path.read_text(encoding="utf-8")
        elif not any(path.iterdir()):
            found[name + "/"] = ""
    return found


def as_contents(artifacts: tuple[Artifact, ...]) -> dict[str, str]:
    """Return what a folder holds right after the artifacts were written into it."""
    return {artifact.path: artifact.text for artifact in artifacts}
