"""Where the packages lie that a description names, and whether a file lies under a folder.

The ament index of the machine is left out: these are packages that come with a spec, under its own folder.
"""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Iterator

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*", re.ASCII)


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
    # The root itself is the package where a description stands in its own repository.
    return (root, *folders) if os.path.basename(os.path.abspath(root)) == name else folders


def find_package(name: str, root: str) -> str | None:
    """Return the first existing folder of a package, or None."""
    return next((folder for folder in package_folders(name, root) if os.path.isdir(folder)), None)


def package_folders(name: str, root: str) -> Iterator[str]:
    """Yield every folder that may be a package: those named, then one in a repository of a workspace or of a device."""
    if _NAME.fullmatch(name) is None:
        return
    yield from searched_folders(name, root)
    yield from sorted(glob.glob(os.path.join(glob.escape(root), "src", "*", name)))
    for device in sorted(glob.glob(os.path.join(glob.escape(root), "*", "device.yaml"))):
        yield os.path.join(os.path.dirname(device), name)


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
