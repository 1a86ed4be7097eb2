"""A folder beside the one that is written, where files are made ready and old ones kept until all is done.

It is called ``.<name>.tmp-<process>``; one that a killed process left behind still holds what it was about to write.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path


def staging_of(folder: Path) -> Path:
    """Return the staging folder of this process for a folder."""
    return folder.parent / f".{folder.name}.tmp-{os.getpid()}"


def others(folder: Path) -> tuple[Path, ...]:
    """Return staging folders that other processes made for the same folder."""
    found = folder.parent.glob(f".{_literal(folder.name)}.tmp-*")
    return tuple(sorted(path for path in found if path.is_dir() and not path.is_symlink()))


def is_alive(staging: Path) -> bool:
    """Whether the process that made the staging folder still runs."""
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


def discard(staging: Path) -> None:
    """Remove a staging folder as far as the system lets."""
    shutil.rmtree(staging, ignore_errors=True)


def _literal(name: str) -> str:
    return "".join(f"[{char}]" if char in "*?[" else char for char in name)
