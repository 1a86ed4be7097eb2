"""The only module that writes to standard output and standard error.

Every text is untrusted. It stays on its line, with an escape for each character that hides text or controls a terminal,
and no line of it can be a command to the program that runs CI. Colors are ours and are passed beside the text. Escape
sequences: ECMA-48, SGR.
"""

from __future__ import annotations

import io
import os
import re
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from enum import Enum
from typing import TextIO

from cellc.contract.diagnostics.unsafe_text import escaped, harmless_line
from cellc.contract.errors import reason_of
from cellc.contract.extras import MissingExtraError
from cellc.contract.folding import LEAST, Piece, folded
from cellc.contract.frozen import dataclass
from cellc.contract.signals import CLOSED_PIPE, drop_output


class Style(Enum):
    """How a piece of a line looks; the values are what a terminal gets."""

    BOLD = "\x1b[1m"
    DIM = "\x1b[2m"
    GREEN = "\x1b[32m"
    BLUE = "\x1b[1;34m"
    RED = "\x1b[1;31m"
    MAGENTA = "\x1b[1;35m"
    YELLOW = "\x1b[1;33m"
    CYAN = "\x1b[1;36m"


_RESET = "\x1b[0m"


@dataclass(frozen=True, slots=True)
class Styled:
    """A piece of a line with a style of ours."""

    text: str
    style: Style


@dataclass(frozen=True, slots=True)
class WorkflowCommand:
    """A line that GitHub Actions obeys: ``::name key=value,…::message``.

    Source: GitHub Docs, "Workflow commands for GitHub Actions"; escapes as in ``@actions/core``.

    Attributes:
        name: such as ``error``.
        message: lines, of which GitHub shows each on its own.
    """

    name: str
    properties: Mapping[str, str | int]
    message: tuple[str, ...]

    def text(self) -> str:
        """Return the line."""
        properties = ",".join(f"{key}={_of_property(str(value))}" for key, value in self.properties.items())
        return f"::{self.name} {properties}::{'%0A'.join(_of_message(line) for line in self.message)}"


def _of_message(text: str) -> str:
    return harmless_line(escaped(text)).replace("%", "%25")


def _of_property(text: str) -> str:
    # The name of a file must reach GitHub as it is, so its line breaks are not shown as escapes of ours.
    pieces = re.split("([\r\n])", text)
    named = (_OF_LINES.get(piece) or escaped(piece).replace("%", "%25") for piece in pieces)
    return "".join(named).replace(":", "%3A").replace(",", "%2C")


_OF_LINES = {"\r": "%0D", "\n": "%0A"}


Line = str | tuple[str | Styled, ...]
"""One line of output: a text, or pieces of which some have a style."""


class Stream(Enum):
    """Where output goes."""

    OUT = "standard output"
    ERR = "standard error"

    def opened(self) -> TextIO:
        """Return the stream as it is now."""
        return sys.stdout if self is Stream.OUT else sys.stderr


def show(*lines: Line | WorkflowCommand, to: Stream = Stream.OUT) -> None:
    """Print lines, colored where that is wanted, and folded at the width of a terminal."""
    stream = to.opened()
    wide = max(shutil.get_terminal_size().columns, LEAST) if stream.isatty() else 0
    _write(stream, as_text(lines, color=wants_color(stream.isatty(), os.environ), wide=wide))


def refuse(reason: str) -> None:
    """Print on standard error why there is no result of a command."""
    show(f"error: {reason}", to=Stream.ERR)


def remark(line: Line) -> None:
    """Print a line beside the output where a person reads it on a terminal."""
    if sys.stderr.isatty():
        show(line, to=Stream.ERR)


def clear() -> None:
    """Begin at the top of an empty screen, where a person reads the output on a terminal."""
    if sys.stdout.isatty() and os.environ.get("TERM") != "dumb":
        _write(sys.stdout, "\x1b[2J\x1b[3J\x1b[H")


def columns(of_file: int = 100) -> int:
    """Return how wide the terminal is; of a file as many columns as are stated, so that it is the same everywhere."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else of_file


def show_document(text: str) -> None:
    """Print a text of several lines that we wrote, such as Markdown or JSON; what it quotes may be untrusted."""
    _write(sys.stdout, as_text(text.removesuffix("\n").split("\n"), color=False) if text else "")


def as_text(lines: Iterable[Line | WorkflowCommand], *, color: bool, wide: int = 0) -> str:
    """Return lines as they are printed, each ending in a line break.

    Args:
        wide: columns of the terminal; zero where lines have no end.
    """
    return "".join(f"{_line(line, color, wide)}\n" for line in lines)


def _line(line: Line | WorkflowCommand, color: bool, wide: int) -> str:
    if isinstance(line, WorkflowCommand):
        return line.text()
    pieces = [_piece(piece) for piece in ((line,) if isinstance(line, str) else line)]
    plain = "".join(text for text, _ in pieces)
    harmless = harmless_line(plain)
    if not color or harmless != plain:  # nothing of ours looks like a command
        pieces = [(harmless, "")]
    return "\n".join("".join(map(_shown, each)) for each in folded(pieces, wide))


def _piece(piece: str | Styled) -> Piece:
    return (escaped(piece), "") if isinstance(piece, str) else (escaped(piece.text), piece.style.value)


def _shown(piece: Piece) -> str:
    text, style = piece
    return f"{style}{text}{_RESET}" if style and text else text


def _write(stream: TextIO, text: str) -> None:
    if _progress is not None:
        _progress.hide()
    _put(stream, text)


def _put(stream: TextIO, text: str) -> None:
    with _terminal:
        stream.write(text)
        stream.flush()


_terminal = threading.RLock()
"""Held while something is written, and while the descriptors of output lead elsewhere."""
_HEARD_BYTES = 64 * 1024


@contextmanager
def overheard() -> Iterator[list[str]]:
    """Keep what a library that is not Python writes to the descriptors of output, where it would not be escaped.

    What this program prints meanwhile, on other threads, waits.

    Yields:
        A list that holds the lines when the block has ended.
    """
    from cellc.contract.store.swap import temporary_file  # most commands ask no such library

    lines: list[str] = []
    with _terminal, temporary_file() as file:
        before: dict[int, int] = {}
        try:
            for descriptor in (1, 2):
                with suppress(OSError):  # closed by the caller
                    before[descriptor] = os.dup(descriptor)
            for descriptor in before:
                os.dup2(file.fileno(), descriptor)
            yield lines
        finally:
            for descriptor, copy in before.items():
                os.dup2(copy, descriptor)
                os.close(copy)
            file.seek(0)
            lines += file.read(_HEARD_BYTES).decode(errors="backslashreplace").splitlines()


def wants_color(is_terminal: bool, environment: Mapping[str, str]) -> bool:
    """Return whether to color what goes to a stream.

    NO_COLOR (no-color.org) wins over FORCE_COLOR (force-color.org) and CLICOLOR_FORCE, these over CLICOLOR
    (bixense.com/clicolors); without them a terminal is colored unless it is dumb.
    """
    if environment.get("NO_COLOR"):
        return False
    for name in ("FORCE_COLOR", "CLICOLOR_FORCE"):
        if environment.get(name, "0") not in ("", "0"):
            return True
    if environment.get("CLICOLOR") == "0" or environment.get("TERM") == "dumb":
        return False
    return is_terminal


FAILED = 70
"""Exit code where the program itself failed: a bug, or a full disk under its output (EX_SOFTWARE, sysexits.h)."""


def run_to_end(run: Callable[[], int]) -> int:
    """Run a command and return its exit code; a closed pipe or a full disk end without a traceback."""
    _prepare_streams()
    try:
        code = run()
        sys.stdout.flush()
        return code
    except BrokenPipeError:  # the reader of our output has closed it (`cellc show … | head`)
        drop_output()
        return CLOSED_PIPE
    except OSError as error:
        # What a command expects of the disk it reports itself: this is a full disk under the output, and the like.
        drop_output()
        place = f"{error.filename}: " if error.filename else ""
        refuse(f"{place}{reason_of(error)}")
        return FAILED
    except MissingExtraError as missing:
        refuse(str(missing))
        return 2
    except Exception:
        _show_bug()
        return FAILED


def _show_bug() -> None:
    """Print the traceback of the exception in work: what it quotes may be untrusted."""
    import traceback  # loads for 5 ms, and is for bugs alone

    show(*traceback.format_exc().rstrip("\n").split("\n"), "error: this is a bug of cellc", to=Stream.ERR)


def _prepare_streams() -> None:
    # Python gives None where who started us closed the descriptor.
    sys.stdout = sys.stdout or _nowhere()
    sys.stderr = sys.stderr or _nowhere()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # A spec may quote what the terminal's encoding cannot: show it escaped instead of failing.
            stream.reconfigure(errors="backslashreplace")


def _nowhere() -> io.TextIOWrapper:
    return io.TextIOWrapper(io.FileIO(os.devnull, "w"))


_SILENT_S = 2.0
_REDRAW_S = 0.1
_LOOK_S = 0.25
_clock: Callable[[], float] = time.monotonic
_progress: _ProgressLine | None = None
"""What this process tells of its progress; who works deep inside names its stage and knows no command."""


@contextmanager
def progress(
    label: str, stream: TextIO | None = None, clock: Callable[[], float] | None = None
) -> Iterator[Callable[[str], None]]:
    """Give a function that tells what is being done; it shows after two seconds and is erased at the end.

    Only a terminal gets it, on one line that is written again. Erasing uses spaces and a carriage return, so that it
    needs no color. Inside another one, it takes over the line and gives it back.

    Args:
        stream: standard error if None.
        clock: time in s, for tests.
    """
    global _progress
    outer, line = _progress, _progress
    if line is None:
        line = _progress = _ProgressLine(sys.stderr if stream is None else stream, clock or _clock)
    line.begin(label)
    try:
        yield line.update
    finally:
        line.end()
        if outer is None:
            line.close()
            _progress = None


def stage(text: str) -> None:
    """Show the stage of a command where its progress is shown; elsewhere do nothing."""
    if _progress is not None:
        _progress.stage(text)


class _ProgressLine:
    """One line of a terminal: what the innermost of several commands and loops does, and the stage that it is in."""

    def __init__(self, stream: TextIO | None, clock: Callable[[], float]) -> None:
        shows = stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"
        self._stream = stream if shows else None
        self._clock = clock
        self._next_s = clock() + _SILENT_S
        self._told: list[list[str]] = []
        self._drawn = ""
        self._lock = threading.RLock()
        self._closed = threading.Event()
        if self._stream is not None:
            threading.Thread(target=self._watch, daemon=True).start()

    def begin(self, label: str) -> None:
        """Enter a level: label, step and stage are shown from now on."""
        with self._lock:
            self._told.append([label, "", ""])

    def end(self) -> None:
        """Leave a level: the level above is shown again."""
        with self._lock:
            self._told.pop()

    def update(self, step: str) -> None:
        """Tell the step that begins now."""
        with self._lock:
            self._told[-1][1:] = [step, ""]
            self._show()

    def stage(self, text: str) -> None:
        """Tell the stage that begins now."""
        with self._lock:
            if self._told:
                self._told[-1][2] = text
                self._show()

    def hide(self) -> None:
        """Clear the line; progress shows again when it changes, or some time later."""
        with self._lock:
            if self._drawn:
                self._draw("")

    def close(self) -> None:
        """Leave the terminal as it was for good."""
        self._closed.set()
        self.hide()

    def _watch(self) -> None:
        """Show progress without a call for a long time: one cell with heavy meshes is one step."""
        while not self._closed.wait(_LOOK_S):
            with self._lock, suppress(OSError, ValueError):  # a terminal that was closed
                if not self._closed.is_set():
                    self._show()

    def _show(self) -> None:
        if self._stream is None or not self._told or self._clock() < self._next_s:
            return
        label, step, stage = self._told[-1]
        # The last cell stays free: some terminals wrap after it. Escapes of wide text may need two cells a character.
        room = shutil.get_terminal_size().columns - 1
        text = harmless_line(escaped(f"{label}: {', '.join(item for item in (step, stage) if item) or 'at work'}"))
        text = text[: room if text.isascii() else room // 2]
        if text != self._drawn:
            self._next_s = self._clock() + _REDRAW_S
            self._draw(text)

    def _draw(self, text: str) -> None:
        before, self._drawn = self._drawn, text
        if self._stream is not None:
            blank = len(before) if before.isascii() else 2 * len(before)
            _put(self._stream, "\r" + " " * blank + "\r" + text)
