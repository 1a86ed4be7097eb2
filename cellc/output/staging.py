"""What a build puts into its staging folder, and what one that was killed has left there.

A staging folder that is left behind holds the manifest of what was being written, by which the next build tells its
files from edited ones.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from cellc.artifact import Artifact
from cellc.output.hashes import MANIFEST, hashes_in
from cellc.output.plan import content_of


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
