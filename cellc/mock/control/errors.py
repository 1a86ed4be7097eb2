"""Failures that end the controller manager's process or refuse a description."""

from __future__ import annotations

from cellc.contract.errors import ReasonError


class ManagerAbortedError(ReasonError):
    """The process of the controller manager ended while it started.

    Args:
        reason: the decisive line that the process writes before it ends.
    """


class DescriptionError(ReasonError):
    """The robot description was refused; the manager stays up without any hardware.

    Args:
        reason: the message of the parser.
    """


class UpdateError(ReasonError):
    """The update of a controller threw; the manager deactivates the controller.

    Args:
        reason: the message of the exception.
    """
