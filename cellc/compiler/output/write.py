"""Write a folder so that a reader, a crash or a full disk never meets half of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from pathlib import Path

from cellc.compiler.artifact import NewFile
from cellc.compiler.output.findings import finding
from cellc.compiler.output.manifest import MANIFEST, hashes_in
from cellc.compiler.output.plan import Plan, check_paths, check_places, content_of, plan
from cellc.contract.diagnostics import Diagnostic, Outcome
from cellc.contract.frozen import dataclass
from cellc.contract.store.staging import contested, discard, make_staging, others, staging_of
from cellc.contract.store.swap import Swap, remove_folder, write_new


@dataclass(frozen=True, slots=True, repr=False)
class WriteReport:
    """What a build did to its folder: paths in it that were written, removed, and left untouched."""

    written: tuple[str, ...]
    removed: tuple[str, ...]
    unchanged: tuple[str, ...]

    def __repr__(self) -> str:
        counts = f"{len(self.written)} written, {len(self.removed)} removed, {len(self.unchanged)} unchanged"
        return f"<WriteReport: {counts}>"


def write(
    files: Sequence[NewFile],
    folder: Path,
    *,
    force: bool = False,
    index: str = MANIFEST,
    known: Mapping[str, str] | None = None,
) -> Outcome[WriteReport]:
    """Make the folder hold the files; files that cellc did not make stay.

    Only changed files are touched, the index last. All new files are on the disk before the first old one is
    replaced; where a later step fails or is interrupted, every file is put back. A build that is killed leaves its
    staging folder, from which the next one tells half-replaced files from edited ones.

    Args:
        files: with the index of them, as `with_manifest` returns them.
        folder: the generated package or the imported device, made where it is absent.
        force: discard edits of generated files.
        index: the file that lists the hashes of the others.
        known: hashes of what is in the folder and may be replaced beside what the index lists, by path.

    Raises:
        KeyboardInterrupt: the user interrupted; the folder is as it was before.
    """
    refused = tuple(check_paths(files, folder))
    if refused:
        return Outcome(None, refused)
    try:
        return _Writing(files, folder, force, index, known or {}).outcome()
    except BlockingIOError:
        return Outcome(None, (_busy(folder),))
    except OSError as error:
        reason = error.strerror or type(error).__name__
        message = f"`{folder.as_posix()}` cannot be written: {reason.lower()}"
        return Outcome(None, (finding("output-unwritable", message, folder),))


@dataclass(frozen=True, slots=True)
class _Writing:
    """One call of `write`.

    Whether a person edited a file is decided only while this build holds the folder: what another build is about to
    replace looks like an edit.
    """

    files: Sequence[NewFile]
    folder: Path
    force: bool
    index: str
    known: Mapping[str, str] = field(default_factory=dict)

    def outcome(self) -> Outcome[WriteReport]:
        """Write what there is to write, unless something is in the way."""
        refused = tuple(check_places(self.files, self.folder)) or self._busy()
        if refused:
            return Outcome(None, refused)
        stagings = others(self.folder)
        planned = self._planned(stagings)
        if not (planned.write or planned.remove):
            self._forget(stagings, planned)
            return Outcome(WriteReport((), (), planned.unchanged))
        return self._carry_out()

    def _planned(self, stagings: Sequence[Path]) -> Plan:
        return plan(self.files, self.folder, (self.known, *_of_interrupted(stagings, self.index)), self.index)

    def _edited(self, planned: Plan) -> tuple[Diagnostic, ...]:
        return () if self.force else tuple(_edited(path, self.folder) for path in planned.edited)

    def _busy(self) -> tuple[Diagnostic, ...]:
        return (_busy(self.folder),) if contested(self.folder) else ()

    def _carry_out(self) -> Outcome[WriteReport]:
        """Replace files, once this build holds the folder.

        The staging folder announces this build to others. Of two builds that start together, the one that makes its
        staging folder later sees the other's, so at most one continues. The plan is then computed again, because no
        other build can change the folder from here on.
        """
        staging = staging_of(self.folder)
        try:
            try:
                return self._in_turn(staging)
            finally:
                discard(staging)
        finally:
            discard(staging)  # again, because an interrupt may have cut the first one short

    def _in_turn(self, staging: Path) -> Outcome[WriteReport]:
        swap = Swap(self.folder, staging)
        try:
            swap.make_folder(self.folder.parent)
            make_staging(self.folder)
            refused = self._busy()  # first, so that what `others` finds after it was left by killed builds
            stale = others(self.folder)
            planned = self._planned(stale)
            refused = refused or self._edited(planned)
            if not refused:
                _replace(planned, swap)
        except BaseException:  # Ctrl-C too: what was replaced is put back
            swap.undo()
            raise
        if refused:
            swap.undo()
            return Outcome(None, refused)
        self._forget(stale, planned)
        paths = tuple(file.path for file in planned.write)
        return Outcome(WriteReport(paths, planned.remove, planned.unchanged))

    def _forget(self, stale: Sequence[Path], planned: Plan) -> None:
        """Let go what killed builds left, now that nothing needs it to tell half-replaced files from edited ones."""
        _prune(planned.former, self.folder)
        for staging in stale:
            discard(staging)


def _replace(planned: Plan, swap: Swap) -> None:
    for file in planned.write:
        write_new(swap.staging / "new" / file.path, file.content, executable=file.executable, durable=True)
    swap.make_folder(swap.folder)
    for path in planned.remove:
        swap.remove(path)
    for file in planned.write:
        swap.put(file.path)
    swap.settle()


def _prune(former: Sequence[str], folder: Path) -> None:
    """Remove the folders that held nothing but files of earlier builds."""
    parents = {folder / parent for path in former for parent in Path(path).parents if parent != Path()}
    for parent in sorted(parents, key=lambda path: len(path.parts), reverse=True):
        if parent.is_dir() and not parent.is_symlink() and not any(parent.iterdir()):
            remove_folder(parent)


def _busy(folder: Path) -> Diagnostic:
    return finding("output-busy", f"another build is writing `{folder.as_posix()}`", folder)


def _edited(path: str, folder: Path) -> Diagnostic:
    message = f"`{path}` is not as cellc wrote it"
    return finding("edited-by-hand", message, folder / path)


def _of_interrupted(stagings: Sequence[Path], index: str) -> tuple[Mapping[str, str], ...]:
    """Return the hashes of the files that killed builds were writing, and of those that they replaced."""
    indexes = (staging / which / index for staging in stagings for which in ("new", "old"))
    return tuple(hashes_in(content_of(path)) for path in indexes)
