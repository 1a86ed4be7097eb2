"""Names of files for rehearsals, whose own names may be anything."""

from __future__ import annotations

from collections.abc import Iterable
from urllib.parse import quote

_LONGEST = 100


def file_names(rehearsals: Iterable[str]) -> dict[str, str]:
    """Return the stem of the files of each rehearsal: its name where every file system takes it.

    Other characters are escaped as in a URL; names that are one where case does not count get a number.
    """
    stems: dict[str, str] = {}
    taken = {"report", "evidence"}
    for name in rehearsals:
        if name in stems:
            continue
        plain = quote(name, safe=" ")[:_LONGEST].replace("~", "%7E").strip(" ")
        plain = f"_{plain}" if not plain or plain.startswith(".") else plain
        stem, number = plain, 2
        while stem.casefold() in taken:
            stem, number = f"{plain}-{number}", number + 1
        taken.add(stem.casefold())
        stems[name] = stem
    return stems
