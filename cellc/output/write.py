"""Write the generated folder so that a reader, a crash or a full disk never meets half of it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from cellc.artifact import Artifact
from cellc.diagnostics import Diagnostic, Outcome
from cellc.output.codes import finding
from cellc.output.manifest import MANIFEST, hashes_in
from cellc.output.plan import Plan, check_paths, check_places, content_of, plan
from cellc.store.swap import Swap, discard, is_alive, make_staging, others, staging_of


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
    busy = _busy(folder)
    if busy:
        return Outcome(None, busy)
    stagings = others(folder)
    planned = plan(artifacts, folder, _hashes_of_interrupted(stagings))
    if planned.edited and not force:
        return Outcome(None, tuple(_edited(path, folder) for path in planned.edited))
    if not (planned.write or planned.remove):
        _forget(stagings, planned, folder)
        return Outcome(WriteReport((), (), planned.unchanged))
    return _carry_out(artifacts, folder, force=force)


def _busy(folder: Path) -> tuple[Diagnostic, ...]:
    if any(is_alive(staging) for staging in others(folder)):
        return (finding("output-busy", f"another build is writing `{folder.as_posix()}`", folder),)
    return ()


def _carry_out(artifacts: Sequence[Artifact], folder: Path, *, force: bool) -> Outcome[WriteReport]:
    """Replace files, after it was settled who does.

    The staging folder is what tells others of this build. Of two that begin at once, the later one to make its own sees
    the other's, so that never both go on; and what there is to write is asked again, now that nobody else changes it.
    """
    staging = staging_of(folder)
    try:
        try:
            return _in_turn(artifacts, folder, staging, force=force)
        finally:
            discard(staging)
    finally:
        discard(staging)  # again, because an interrupt may have cut the first one short


def _in_turn(artifacts: Sequence[Artifact], folder: Path, staging: Path, *, force: bool) -> Outcome[WriteReport]:
    swap = Swap(folder, staging)
    try:
        swap.make_folder(folder.parent)
        make_staging(folder)
        refused, stale = _busy(folder), others(folder)
        planned = plan(artifacts, folder, _hashes_of_interrupted(stale))
        if not refused and not force:
            refused = tuple(_edited(path, folder) for path in planned.edited)
        if not refused:
            _replace(planned, swap)
    except BaseException:  # Ctrl-C too: what was replaced is put back
        swap.undo()
        raise
    if refused:
        swap.undo()
        return Outcome(None, refused)
    _forget(stale, planned, folder)
    written = tuple(artifact.path for artifact in planned.write)
    return Outcome(WriteReport(written, planned.remove, planned.unchanged))


def _forget(stale: Sequence[Path], planned: Plan, folder: Path) -> None:
    """Let go what killed builds left, now that nothing needs it to tell half-replaced files from edited ones."""
    _prune(planned.former, folder)
    for staging in stale:
        discard(staging)


def _replace(planned: Plan, swap: Swap) -> None:
    fill(swap.staging, planned.write)
    swap.make_folder(swap.folder)
    for path in planned.remove:
        swap.remove(path)
    for artifact in planned.write:
        swap.put(artifact.path)
    swap.settle()


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
    """Return the hashes of the files that killed builds were writing, and of those that they replaced."""
    manifests = (staging / which / MANIFEST for staging in stagings for which in ("new", "old"))
    return tuple(hashes_in(content_of(manifest)) for manifest in manifests)


def fill(staging: Path, artifacts: Sequence[Artifact]) -> None:
    """Write artifacts below ``new`` and have the system put them on the disk.

    Raises:
        OSError: the disk is full, or writing is refused.
    """
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
