"""The log of the simulated nodes: the only place where the real stack tells many of its reasons."""

from __future__ import annotations

from enum import Enum

from cellc.contract.frozen import dataclass


class LogLevel(str, Enum):
    """Severity of a log line, spelled as rosconsole prints it."""

    INFO = "INFO"
    WARN = "WARN"
    ERROR = "ERROR"
    FATAL = "FATAL"


@dataclass(frozen=True, slots=True)
class LogLine:
    """One line of the log.

    Attributes:
        stamp_ns: simulated time of the line.
        level: severity.
        logger: name of the node or component that speaks.
        text: the message, worded as the real node words it where that is known.
    """

    stamp_ns: int
    level: LogLevel
    logger: str
    text: str

    def __str__(self) -> str:
        return f"[{self.level.value}] [{self.logger}]: {self.text}"


class Log:
    """Collects log lines in the order in which they were written."""

    def __init__(self) -> None:
        self.now_ns = 0
        self._lines: list[LogLine] = []
        self._throttled: dict[str, int] = {}

    def info(self, logger: str, text: str) -> None:
        """Append a line of level INFO."""
        self._lines.append(LogLine(self.now_ns, LogLevel.INFO, logger, text))

    def warn(self, logger: str, text: str) -> None:
        """Append a line of level WARN."""
        self._lines.append(LogLine(self.now_ns, LogLevel.WARN, logger, text))

    def error(self, logger: str, text: str) -> None:
        """Append a line of level ERROR."""
        self._lines.append(LogLine(self.now_ns, LogLevel.ERROR, logger, text))

    def fatal(self, logger: str, text: str) -> None:
        """Append a line of level FATAL."""
        self._lines.append(LogLine(self.now_ns, LogLevel.FATAL, logger, text))

    def throttle(self, key: str, period_ns: int) -> bool:
        """Tell whether a throttled message may be written now, and start its next silence if so."""
        if key in self._throttled and self.now_ns < self._throttled[key]:
            return False
        self._throttled[key] = self.now_ns + period_ns
        return True

    def silent_until_ns(self, key: str) -> int:
        """The time until which a throttled message stays silent."""
        return self._throttled.get(key, 0)

    def lines(self) -> tuple[LogLine, ...]:
        """All lines so far."""
        return tuple(self._lines)

    def texts(self) -> tuple[str, ...]:
        """The text of all lines so far."""
        return tuple(line.text for line in self._lines)
