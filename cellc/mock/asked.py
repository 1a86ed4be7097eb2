"""Which options of the command go together, for both of its front ends."""

from __future__ import annotations

from collections.abc import Mapping


def contradiction(
    *, rehearsals: bool, modes: Mapping[str, bool], pairs: bool, jobs: bool, paths: Mapping[str, str | None]
) -> str:
    """Say which options do not go together; empty where all do.

    Args:
        rehearsals: declared rehearsals were named.
        modes: what else to do than to run rehearsals, by option, and whether it was asked for.
        pairs: runs with two faults were asked for.
        jobs: a number of processes was asked for.
        paths: files and folders to write, by option.
    """
    asked = [option for option, given in modes.items() if given]
    alone = [option for option in asked if option != "--campaign"]
    if rehearsals and asked:
        return "--rehearsal runs declared rehearsals; it does not go with the options of the campaign"
    if len(alone) > 1:
        return f"{alone[0]} does not go with {alone[1]}"
    if (pairs or jobs) and not asked:
        return f"{'--pairs' if pairs else '--jobs'} is of a campaign; add --campaign"
    if "--list" in alone and any(path is not None for path in paths.values()):
        return f"{next(option for option, path in paths.items() if path is not None)} is of runs; --list runs none"
    empty = [option for option, path in paths.items() if path == ""]
    return f"{empty[0]} cannot be written: its path is empty" if empty else ""
