"""When and how terminal output is coloured."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from cellc.diagnostics import Severity

_RESET = "\x1b[0m"
BOLD = "\x1b[1m"
BLUE = "\x1b[1;34m"
GREEN = "\x1b[32m"
SEVERITY_COLOURS: Mapping[Severity, str] = {
    Severity.ERROR: "\x1b[1;31m",
    Severity.BLOCKER: "\x1b[1;35m",
    Severity.WARNING: "\x1b[1;33m",
    Severity.AUDIT: "\x1b[1;36m",
}


class Stream(Protocol):
    """What is asked of an output stream."""

    def isatty(self) -> bool:
        """Whether a person reads it on a terminal."""


def wants_colour(stream: Stream, environment: Mapping[str, str]) -> bool:
    """Return whether to colour what goes to ``stream``.

    NO_COLOR (no-color.org) wins over FORCE_COLOR (force-color.org) and CLICOLOR_FORCE, these over CLICOLOR
    (bixense.com/clicolors); without them a terminal is coloured unless it is dumb.
    """
    if environment.get("NO_COLOR"):
        return False
    for name in ("FORCE_COLOR", "CLICOLOR_FORCE"):
        if environment.get(name, "0") not in ("", "0"):
            return True
    if environment.get("CLICOLOR") == "0" or environment.get("TERM") == "dumb":
        return False
    return stream.isatty()


def paint(text: str, style: str, colour: bool) -> str:
    """Return ``text`` in a style where colour is wanted."""
    return f"{style}{text}{_RESET}" if colour and text else text
