"""Write the generated folder so that a reader, a crash or a full disk never meets half of it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from cellc.artifact import Artifact
from cellc.diagnostics import Diagnostic, Outcome
from cellc.output.codes import finding
from cellc.output.plan import MANIFEST, Plan, check_paths, check_places, content_of, hashes_in, plan
from cellc.store.swap import Swap, discard, is_alive, others, staging_of


@dataclass(frozen=True, slots=True)
class WriteReport:
    """What a build did to its folder: paths in it that were written, removed, and left untouched."""

    written: tuple[str, ...]
    removed: tuple[str, ...]
    unchanged: tuple[str, ...]


def write(artifacts: Sequence[Artifact], folder: Path, *, force: bool = False) -> Outcome[WriteReport]:
    """Make the folder hold the artifacts; files that cellc did not make stay.

    Only changed files are touched, the manifest last. All new files are on the disk before the first old one is
    replaced; where a later step fails or is interrupted, every file is put back. A build that is killed leaves its
    staging folder, from which the next one tells half-replaced files from edited ones.

    Args:
        artifacts: with the manifest over them, as `with_manifest` returns them.
        folder: the generated package, made where it is absent.
        force: discard edits of generated files.

    Raises:
        KeyboardInterrupt: the user interrupted; the folder is as it was before.
    """
    refused = tuple(check_paths(artifacts, folder))
    if refused:
        return Outcome(None, refused)
    try:
        return _write(artifacts, folder, force=force)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        message = f"`{folder.as_posix()}` cannot be written: {reason.lower()}"
        return Outcome(None, (finding("output-unwritable", message, folder),))


def _write(artifacts: Sequence[Artifact], folder: Path, *, force: bool) -> Outcome[WriteReport]:
    refused = tuple(check_places(artifacts, folder))
    if refused:
        return Outcome(None, refused)
    stagings = others(folder)
    if any(is_alive(staging) for staging in stagings):
        message = f"another build is writing `{folder.as_posix()}`"
        return Outcome(None, (finding("output-busy", message, folder),))
    planned = plan(artifacts, folder, _hashes_of_interrupted(stagings))
    if planned.edited and not force:
        return Outcome(None, tuple(_edited(path, folder) for path in planned.edited))
    for staging in stagings if not (planned.write or planned.remove) else ():
        discard(staging)
    if planned.write or planned.remove:
        _carry_out(planned, folder, stagings)
    written = tuple(artifact.path for artifact in planned.write)
    return Outcome(WriteReport(written, planned.remove, planned.unchanged))


def _carry_out(planned: Plan, folder: Path, stale: Sequence[Path]) -> None:
    staging = staging_of(folder)
    try:
        try:
            _replace(planned, Swap(folder, staging))
        finally:
            discard(staging)
    finally:
        discard(staging)  # again, because an interrupt may have cut the first one short
    # Only now: until here they are what tells half-replaced files from edited ones.
    for leftover in stale:
        discard(leftover)
    _prune(planned.former, folder)


def _replace(planned: Plan, swap: Swap) -> None:
    try:
        swap.make_folder(swap.folder.parent)
        fill(swap.staging, planned.write)
        swap.make_folder(swap.folder)
        for path in planned.remove:
            swap.remove(path)
        for artifact in planned.write:
            swap.put(artifact.path)
        swap.settle()
    except BaseException:  # Ctrl-C too: what was replaced is put back
        swap.undo()
        raise


def _prune(former: Sequence[str], folder: Path) -> None:
    """Remove the folders that held nothing but files of earlier builds."""
    parents = {folder / parent for path in former for parent in Path(path).parents if parent != Path()}
    for parent in sorted(parents, key=lambda path: len(path.parts), reverse=True):
        if parent.is_dir() and not parent.is_symlink() and not any(parent.iterdir()):
            parent.rmdir()


def _edited(path: str, folder: Path) -> Diagnostic:
    message = f"`{path}` is not as cellc wrote it"
    return finding("edited-by-hand", message, folder / path)


def _hashes_of_interrupted(stagings: Sequence[Path]) -> tuple[Mapping[str, str], ...]:
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
        if artifact.executable:
            mode = path.stat().st_mode
            path.chmod(mode | (mode & 0o444) >> 2)
