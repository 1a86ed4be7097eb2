"""Where the cache is."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

OFF = "CELLC_NO_CACHE"


def cache_folder(environment: Mapping[str, str] = os.environ, platform: str = sys.platform) -> Path | None:
    """Return the folder of cellc in the user's cache folder; it need not exist.

    `XDG_CACHE_HOME` counts on every platform, as the XDG Base Directory Specification has it where it is absolute.

    Returns:
        None where the cache is turned off, or the user has no home.
    """
    if environment.get(OFF, "") not in ("", "0"):
        return None
    chosen = Path(environment.get("XDG_CACHE_HOME", ""))
    if chosen.is_absolute():
        return chosen / "cellc"
    try:
        home = Path.home()
    except RuntimeError:
        return None
    if platform == "win32":
        return Path(environment.get("LOCALAPPDATA", "") or home / "AppData" / "Local") / "cellc" / "cache"
    return home / ("Library/Caches" if platform == "darwin" else ".cache") / "cellc"
