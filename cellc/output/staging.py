"""A folder beside the output where files are made ready, and old ones kept until all is done.

It is called ``.<name>.tmp-<process>``. One that a killed build left behind still holds the manifest of what it was
writing, by which the next build tells its files from edited ones; then it is removed.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from cellc.artifact import Artifact
from cellc.output.hashes import MANIFEST, hashes_in
from cellc.output.plan import content_of


def staging_of(folder: Path) -> Path:
    """Return the staging folder of this process for an output folder."""
    return folder.parent / f".{folder.name}.tmp-{os.getpid()}"


def others(folder: Path) -> tuple[Path, ...]:
    """Return staging folders that other builds of the same output folder made."""
    found = folder.parent.glob(f".{_literal(folder.name)}.tmp-*")
    return tuple(sorted(path for path in found if path.is_dir() and not path.is_symlink()))


def is_alive(staging: Path) -> bool:
    """Whether the build that made the staging folder still runs."""
    number = staging.name.rpartition("-")[2]
    if os.name != "posix" or not number.isdigit() or int(number) in (0, os.getpid()):
        return False
    try:
        os.kill(int(number), 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


def hashes_of_interrupted(stagings: Sequence[Path]) -> tuple[Mapping[str, str], ...]:
    """Return the hashes of the files that killed builds were writing."""
    return tuple(hashes_in(content_of(staging / "new" / MANIFEST)) for staging in stagings)


def fill(staging: Path, artifacts: Sequence[Artifact]) -> None:
    """Write artifacts below ``new`` and have the system put them on the disk.

    Raises:
        OSError: the disk is full, or writing is refused.
    """
    os.mkdir(staging)
    for artifact in artifacts:
        path = staging / "new" / artifact.path
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("xb") as file:
            file.write(artifact.text.encode())
            file.flush()
            os.fsync(file.fileno())


def discard(staging: Path) -> None:
    """Remove a staging folder as far as the system lets."""
    shutil.rmtree(staging, ignore_errors=True)


def _literal(name: str) -> str:
    return "".join(f"[{char}]" if char in "*?[" else char for char in name)
