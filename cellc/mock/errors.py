"""The exceptions of the mock: a folder that cannot be executed, and a run that asks for more than it may."""

from __future__ import annotations

from cellc.contract.errors import CellcError
from cellc.contract.limits import option


class MockError(CellcError):
    """A generated folder cannot be loaded, or a name given to the mock does not exist.

    Args:
        file: the file at fault as the user named it, or its path inside the folder; empty where no file is.
        reason: one line, lower case.
    """

    def __init__(self, file: str, reason: str) -> None:
        super().__init__(file, reason)  # so that it can be sent between processes
        self.file = file
        self.reason = reason

    def __str__(self) -> str:
        return f"{self.file}: {self.reason}" if self.file else self.reason


class LimitReachedError(CellcError):
    """A run asks for more than the limits allow, which only running it shows; the run ends, others go on.

    Args:
        text: what it asked for, and how much is allowed.
        limit: the limit that an option raises; empty where the bound is fixed.
    """

    def __init__(self, text: str, limit: str = "") -> None:
        super().__init__(f"{text}; {option(limit)}" if limit else text)


class FaultMissedError(CellcError):
    """A fault that was to begin has nothing to begin with; the message says why."""


class OversleptError(CellcError):
    """A task slept over what it would have seen by looking all the time; the run is made again, with every look."""
