"""Failures that end the controller manager's process or refuse a description."""

from __future__ import annotations

from cellc.contract.errors import CellcError


class ManagerAbortedError(CellcError):
    """The process of the controller manager ended while it started.

    Args:
        reason: the decisive line that the process writes before it ends.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class DescriptionError(CellcError):
    """The robot description was refused; the manager stays up without any hardware.

    Args:
        reason: the message of the parser.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class UpdateError(CellcError):
    """The update of a controller threw; the manager deactivates the controller.

    Args:
        reason: the message of the exception.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason
