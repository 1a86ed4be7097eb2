"""What a build changes in its folder, decided before the first byte is written."""

from __future__ import annotations

import stat
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath

from cellc.compiler.artifact import NewFile
from cellc.compiler.output.findings import finding
from cellc.compiler.output.manifest import MANIFEST, hashes_in, sha256
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.file_names import opens_a_device
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.contract.store.regular_file import open_regular
from cellc.contract.store.swap import link_above, link_on_the_way

# Forbidden in names of one of the common file systems.
_RESERVED = frozenset('<>:"|?*\\')
_LONGEST_NAME, _LONGEST_PATH = 255, 1000  # bytes; Linux takes 4095 with the folder's own path (limits.h, PATH_MAX)


@dataclass(frozen=True, slots=True)
class Plan:
    """The difference between the folder as it is and as it shall be.

    Args:
        write: files that are absent or have other content; the index is the last one.
        former: paths that an earlier build made and this one does not.
        remove: those of them where there still is a file.
        unchanged: paths whose files already are as they shall be.
        edited: paths whose content cellc did not write and would overwrite or remove.
    """

    write: tuple[NewFile, ...]
    former: tuple[str, ...]
    remove: tuple[str, ...]
    unchanged: tuple[str, ...]
    edited: tuple[str, ...]


def plan(
    files: Sequence[NewFile], folder: Path, interrupted: Sequence[Mapping[str, str]] = (), index: str = MANIFEST
) -> Plan:
    """Compare the folder with the files that it shall hold.

    Args:
        interrupted: hashes that a build would have left which was killed while it replaced files: a file that has
            one of them was made by cellc, though the index in the folder does not know it.
        index: the file that lists the hashes of the others.

    Raises:
        OSError: a file cannot be read.
    """
    known: list[Mapping[str, str]] = [hashes_in(content_of(folder / index)), *interrupted]
    write, unchanged, edited = [], [], []
    for file in sorted(files, key=lambda one: (one.path == index, one.path)):
        wanted = file.content
        content = content_of(folder / file.path, len(wanted))
        if content == wanted:
            unchanged.append(file.path)
            continue
        write.append(file)
        if content is not None and file.path != index and not _is_ours(file.path, content, known):
            edited.append(file.path)
    made = {file.path for file in files}
    former = sorted({path for hashes in known for path in hashes if is_inside(path, folder)} - made)
    remove = []
    for path in former:
        content = content_of(folder / path, limits().mesh_bytes)
        if content is not None:
            remove.append(path)
            edited += [] if _is_ours(path, content, known) else [path]
    return Plan(tuple(write), tuple(former), tuple(remove), tuple(unchanged), tuple(sorted(edited)))


def content_of(path: Path, least: int = 0) -> bytes | None:
    """Return the bytes of a regular file, or None; links are not followed.

    Args:
        least: bytes that are read at least. Of a file beyond them and the limits one byte more is read than it may
            have: that is not the content of any file that cellc wrote.
    """
    try:
        if not stat.S_ISREG(path.lstat().st_mode):
            return None
        with open_regular(path, follow=False) as file:
            return file.read(max(least, limits().folder_bytes) + 1)
    except (FileNotFoundError, NotADirectoryError):
        return None


def check_places(artifacts: Sequence[NewFile], folder: Path) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each link, file or folder that is in the place of something else."""
    linked = folder if folder.is_symlink() else link_on_the_way(folder)
    if linked is not None:
        yield finding("output-symlink", f"`{linked.as_posix()}` is a symbolic link", linked)
        return
    if folder.exists() and not folder.is_dir():
        yield finding("output-blocked", f"`{folder.as_posix()}` is not a folder", folder)
        return
    folders = {parent for artifact in artifacts for parent in Path(artifact.path).parents if parent != Path()}
    files = {Path(artifact.path) for artifact in artifacts}
    for relative in sorted(folders | files):
        path = folder / relative
        if path.is_symlink():
            yield finding("output-symlink", f"`{path.as_posix()}` is a symbolic link", path)
        elif path.exists() and (path.is_dir() if relative in files else not path.is_dir()):
            expected, actual = ("a file", "a folder") if relative in files else ("a folder", "a file")
            message = f"expected {expected} at `{path.as_posix()}`, got {actual}"
            yield finding("output-blocked", message, path)


def _is_ours(path: str, content: bytes, known: Sequence[Mapping[str, str]]) -> bool:
    return any(hashes.get(path) == sha256(content) for hashes in known)


def is_inside(path: str, folder: Path) -> bool:
    """Whether a path that a manifest names is one that cellc makes, and lies in the folder."""
    # A manifest is data that others may have written, and so are the links in the folder: neither must make a build
    # remove files elsewhere. Every file of cellc has a path that cellc makes.
    return not unusable(path) and link_above(path, folder) is None


def check_paths(artifacts: Sequence[NewFile], folder: Path) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each path that leads out of the folder, is not portable, or collides with another."""
    seen: dict[str, str] = {}
    for artifact in artifacts:
        reason = unusable(artifact.path)
        key = unicodedata.normalize("NFC", artifact.path).casefold()
        if not reason and key in seen:
            reason = f"is the same file as `{seen[key]}` where case does not count"
        seen.setdefault(key, artifact.path)
        if reason:
            shown = artifact.path.encode("unicode_escape").decode().replace("`", "'")
            yield finding("bad-artifact-path", f"`{shown}` {reason}", folder)
    yield from _files_as_folders(seen, folder)


def _files_as_folders(seen: dict[str, str], folder: Path) -> Iterator[Diagnostic]:
    for key, path in seen.items():
        parent = next((seen[str(p)] for p in PurePosixPath(key).parents if str(p) in seen), None)
        if parent is not None:
            yield finding("bad-artifact-path", f"`{path}` needs a folder where there is the file `{parent}`", folder)


def unusable(path: str) -> str:
    """Say why a path cannot be that of a file in a folder; empty where it can."""
    parts = path.split("/")
    if path.startswith("/"):
        return "is absolute"
    if any(part in ("", ".", "..") for part in parts):
        return "leads out of the folder or has an empty part"
    if any(map(opens_a_device, parts)):
        return "holds a name that Windows keeps for a device"
    if any(char in _RESERVED or not char.isprintable() for char in path):
        return "holds a character that not every file system allows"
    is_long = any(len(part.encode()) > _LONGEST_NAME for part in parts) or len(path.encode()) > _LONGEST_PATH
    return "is longer than file systems allow" if is_long else ""
