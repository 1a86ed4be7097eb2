"""The secret by which cellc knows its own entries of the cache, and the folders that it trusts with either.

A cache is restored by CI, shared and copied; its entries decide whether a collision is reported. So each is signed with
random bytes that this user alone can read, in a folder that is no cache: the user's state folder.
"""

from __future__ import annotations

import contextlib
import os
import stat
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from cellc.contract.store.regular_file import open_regular
from cellc.contract.store.swap import make_folder, replace_whole

_SIZE = 32
_OTHERS_MAY_WRITE = stat.S_IWGRP | stat.S_IWOTH


def state_folder(environment: Mapping[str, str] = os.environ, platform: str = sys.platform) -> Path | None:
    """Return the folder of cellc in the user's state folder; it need not exist.

    `XDG_STATE_HOME` counts on every platform where it is absolute (XDG Base Directory Specification 0.8).

    Returns:
        None where the user has no home.
    """
    places = {"win32": "AppData/Local/cellc", "darwin": "Library/Application Support/cellc"}
    return user_folder("XDG_STATE_HOME", {"": ".local/state/cellc", **places}, environment, platform)


def user_folder(variable: str, places: Mapping[str, str], environment: Mapping[str, str], platform: str) -> Path | None:
    """Return a folder of cellc among those of the user; None where the user has no home.

    Args:
        variable: of the environment, which counts on every platform where it is absolute.
        places: by platform, from the home of the user; under "" that of any other platform.
    """
    chosen = Path(environment.get(variable, ""))
    if chosen.is_absolute():
        return chosen / "cellc"
    try:
        home = Path.home()
    except RuntimeError:
        return None
    local = environment.get("LOCALAPPDATA", "") if platform == "win32" else ""
    place = places.get(platform, places[""])
    return Path(local, place.removeprefix("AppData/Local/")) if local else home / place


def cache_key(asked_by: Path | None) -> bytes | None:
    """Return the secret, creating it if it is missing; None where it cannot be kept private.

    Args:
        asked_by: the spec; what lies in its working tree may have come with it.
    """
    folder = state_folder()
    return None if folder is None or is_shipped_with(folder, asked_by) else _key_in(folder)


@cache
def _key_in(folder: Path) -> bytes | None:
    with contextlib.suppress(OSError):
        if not is_private(folder):
            return None
        try:
            return _read(folder / "cache.key")
        except FileNotFoundError:
            _make(folder / "cache.key")
            return _read(
                folder / "cache.key"
            )  # where two make one at the same time, the later stays, and one asks again
    return None


def is_private(folder: Path) -> bool:
    """Return whether a folder, created if missing, belongs to this user and is writable for no other.

    Raises:
        OSError: it cannot be created.
    """
    make_folder(folder, 0o700)
    status = folder.lstat()
    return stat.S_ISDIR(status.st_mode) and _is_own(status) and not _may_others(status, _OTHERS_MAY_WRITE)


def is_shipped_with(folder: Path, spec: Path | None) -> bool:
    """Return whether a folder lies in the working tree of a spec, where an untrusted branch can have put it."""
    tree = None if spec is None else _working_tree(os.path.dirname(os.path.realpath(spec)))
    return tree is not None and Path(os.path.realpath(folder)).is_relative_to(tree)


@cache
def _working_tree(folder: str) -> Path | None:
    above = (Path(folder), *Path(folder).parents)
    return next((path for path in above if os.path.lexists(path / ".git")), None)


def _read(file: Path) -> bytes | None:
    with open_regular(file, follow=False) as stream:
        status = os.fstat(stream.fileno())
        key = stream.read(_SIZE + 1)
    is_secret = _is_own(status) and not _may_others(status, stat.S_IRWXG | stat.S_IRWXO)
    return key if is_secret and len(key) == _SIZE else None


def _make(file: Path) -> None:
    replace_whole(file, os.urandom(_SIZE), mode=0o600)


def _is_own(status: os.stat_result) -> bool:
    return not hasattr(os, "getuid") or status.st_uid == os.getuid()


def _may_others(status: os.stat_result, bits: int) -> bool:
    return hasattr(os, "getuid") and bool(status.st_mode & bits)
