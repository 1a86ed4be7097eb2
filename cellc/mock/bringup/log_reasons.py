"""What a controller manager wrote to its log since a moment: where the real stack tells its reasons."""

from __future__ import annotations

from cellc.mock.control import ControllerManager

_LEVELS = ("WARN", "ERROR", "FATAL")


class LogMark:
    """A place in the log of a manager."""

    def __init__(self, manager: ControllerManager) -> None:
        """Mark the present end of the log."""
        self._manager = manager
        self._length = len(manager.log.lines())

    def reasons(self) -> str:
        """Return the warnings and errors written since, joined to one line; empty where there are none."""
        lines = self._manager.log.lines()[self._length :]
        return "; ".join(" ".join(line.text.split()) for line in lines if line.level.value in _LEVELS)
