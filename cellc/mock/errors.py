"""The one exception of the mock: a folder that cannot be executed."""

from __future__ import annotations


class MockError(Exception):
    """A generated folder cannot be loaded, or a name given to the mock does not exist.

    Args:
        file: the file at fault as the user named it, or its path inside the folder; empty where no file is.
        reason: one line, lower case.
    """

    def __init__(self, file: str, reason: str) -> None:
        super().__init__(f"{file}: {reason}" if file else reason)
        self.file = file
        self.reason = reason
