"""Where the packages lie that a description names, and whether a file lies under a folder.

Packages come with a spec, under its own folder or in the folders of its repository that it names, or lie in the folders
of the package path, which the caller of cellc sets. Environment variables are ignored: the same call gives the same
answer in every shell.

The package path belongs to the process, as the limits do: the command line alone sets it, for the time of a command,
and hands it to the processes that it starts.
"""

from __future__ import annotations

import glob
import os
import re
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from cellc.contract.limits import KIB
from cellc.contract.store.regular_file import open_regular

MANIFEST = "package.xml"
_MANIFEST_BYTES = 64 * KIB
_DECLARED = re.compile(rb"<name>\s*([A-Za-z][A-Za-z0-9_-]*)\s*</name>")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*", re.ASCII)
_IGNORING = frozenset({"COLCON_IGNORE", "AMENT_IGNORE"})
_DEEPEST = 6
_MOST_FOLDERS = 5_000
"""Of a tree in which a package is looked for: folders below each other, and together."""
_path: tuple[str, ...] = ()


def package_path() -> tuple[str, ...]:
    """Return the folders of packages that the call gave, in their order."""
    return _path


def use_packages(folders: Sequence[str]) -> None:
    """Put a package path in force for the rest of the process: for one that was started with it."""
    global _path
    _path = tuple(folders)


@contextmanager
def on_package_path(folders: Sequence[str]) -> Iterator[None]:
    """Put a package path in force for a while."""
    before = package_path()
    use_packages(folders)
    try:
        yield
    finally:
        use_packages(before)


def is_package_name(name: str) -> bool:
    """Whether a name may be that of a package."""
    return _NAME.fullmatch(name) is not None


def searched_folders(name: str, root: str) -> tuple[str, ...]:
    """List the folders that may hold a package, in the order of the search."""
    below = (
        (name,),
        ("src", name),
        ("share", name),
        ("install", name, "share", name),
        ("install", "share", name),
    )
    folders = tuple("/".join((root.rstrip("/"), *parts)) for parts in below)
    # The root itself is the package where a description is in its own repository.
    return (root, *folders) if os.path.basename(os.path.abspath(root)) == name else folders


def find_package(name: str, *roots: str) -> str | None:
    """Return the first existing folder of a package, below the roots or else on the package path, or None."""
    places = (folder for place in (*roots, *package_path()) for folder in package_folders(name, place))
    return next((folder for folder in places if os.path.isdir(folder)), None)


def package_folders(name: str, root: str) -> Iterator[str]:
    """Yield every folder that may be a package.

    Those of its name come first, then one in a repository of a workspace or of a device, then all that colcon finds,
    by the name of the folder or of the manifest: some repositories are a package of another name.
    """
    if not is_package_name(name):
        return
    yield from searched_folders(name, root)
    yield from sorted(glob.glob(os.path.join(glob.escape(root), "src", "*", name)))
    for device in sorted(glob.glob(os.path.join(glob.escape(root), "*", "device.yaml"))):
        yield os.path.join(os.path.dirname(device), name)
    for folder in _packages_below(root):
        if name in (os.path.basename(folder), declared_name(os.path.join(folder, MANIFEST))):
            yield folder


def _packages_below(root: str) -> Iterator[str]:
    """Yield the folders of packages as colcon finds them: in none that is hidden, ignored or a package itself."""
    waiting = deque([(root, 0)])
    for _ in range(_MOST_FOLDERS):
        if not waiting:
            return
        folder, depth = waiting.popleft()
        try:
            inside = frozenset(os.listdir(folder))
        except OSError:
            continue
        if not _IGNORING.isdisjoint(inside):
            continue
        if MANIFEST in inside:
            yield folder
        if depth < _DEEPEST and (MANIFEST not in inside or not depth):
            below = (os.path.join(folder, name) for name in sorted(inside) if not name.startswith("."))
            waiting += [(path, depth + 1) for path in below if os.path.isdir(path)]  # False for a link to itself


def folders_elsewhere(names: Iterable[str], folder: str, candidates: Sequence[str] = ()) -> tuple[str, ...]:
    """Return where packages lie that a folder does not hold, inside its repository and relative to it, each once.

    Args:
        candidates: folders to be tried before those above the folder.
    """
    top, here = repository_of(folder), os.path.realpath(folder)
    above = [*map(os.path.realpath, candidates), *map(str, Path(here).parents)]
    inside = [place for place in above if lies_under(place, top) and not lies_under(place, here)]
    folders: dict[str, None] = {}
    for name in sorted(set(names)):
        if not any(map(os.path.isdir, package_folders(name, folder))):
            holding = (place for place in inside if any(map(os.path.isdir, package_folders(name, place))))
            folders |= dict.fromkeys([os.path.relpath(place, here).replace(os.sep, "/") for place in holding][:1])
    return tuple(folders)


def root_of(file: Path) -> Path:
    """Return the folder in which a description and the packages that it names lie.

    The workspace of its package, whose `src/` holds it, its repository or a folder of that; else the folder that holds
    the package; else that of the file. It is relative where the file is.
    """
    package = next((above for above in file.absolute().parents if (above / MANIFEST).is_file()), None)
    if package is None:
        return file.parent
    sources = next((above for above in package.parents[:3] if above.name == "src"), None)
    root = package.parent if sources is None else sources.parent
    return root if file.is_absolute() else Path(os.path.relpath(root))


def declared_name(manifest: str) -> str:
    """Return the name of a package as its ``package.xml`` has it; empty where it has none."""
    try:
        with open_regular(Path(manifest)) as file:
            declared = _DECLARED.search(file.read(_MANIFEST_BYTES))
    except OSError:
        return ""
    return "" if declared is None else declared[1].decode("ascii")


def repository_of(folder: str) -> str:
    """Return the folder itself, or the one above it that version control begins in: links may lead about in there."""
    above = os.path.realpath(folder)
    while not os.path.exists(os.path.join(above, ".git")):
        parent = os.path.dirname(above)
        if parent == above:
            return folder
        above = parent
    return above


def lies_under(path: str, folder: str) -> bool:
    """Whether a path lies in a folder or below, every link of both followed."""
    real, top = os.path.realpath(path), os.path.realpath(folder)
    return real == top or real.startswith(top.rstrip(os.sep) + os.sep)
