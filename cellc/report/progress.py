"""A line on the terminal that shows that a slow command is alive."""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from cellc.report.terminal import escape

_SILENT_S = 1.0
_REDRAW_S = 0.1


@contextmanager
def progress(
    label: str, stream: TextIO | None = None, clock: Callable[[], float] = time.monotonic
) -> Iterator[Callable[[str], None]]:
    """Give a function that tells what is being done; what it says shows after a second and is erased at the end.

    Only a terminal gets it. Erasing uses spaces and a carriage return, so that it needs neither colour nor a terminal
    that knows escape sequences.

    Args:
        stream: standard error if None.
        clock: time in s, for tests.
    """
    line = _ProgressLine(label, sys.stderr if stream is None else stream, clock)
    try:
        yield line.update
    finally:
        line.erase()


class _ProgressLine:
    def __init__(self, label: str, stream: TextIO | None, clock: Callable[[], float]) -> None:
        self._label = label
        self._stream = stream if stream is not None and stream.isatty() else None
        self._clock = clock
        self._next_s = clock() + _SILENT_S
        self._width = 0

    def update(self, step: str) -> None:
        """Show the step that begins now, unless the line was drawn a moment ago."""
        now_s = self._clock()
        if self._stream is None or now_s < self._next_s:
            return
        self._next_s = now_s + _REDRAW_S
        # The last cell stays free: some terminals wrap after it. Escapes of wide text may need two cells a character.
        room = shutil.get_terminal_size().columns - 1
        text = escape(f"{self._label}: {step}")
        text = text[: room if text.isascii() else room // 2]
        self._draw(text)

    def erase(self) -> None:
        """Leave the terminal as it was."""
        if self._width:
            self._draw("")

    def _draw(self, text: str) -> None:
        width = len(text) if text.isascii() else 2 * len(text)
        if self._stream is not None:
            self._stream.write("\r" + " " * self._width + "\r" + text)
            self._stream.flush()
        self._width = width
