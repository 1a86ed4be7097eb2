"""Read one file as text, refusing all but small regular UTF-8 files; and the texts that a report may show."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from cellc.compiler.source.findings import finding
from cellc.contract.diagnostics import Diagnostic, Outcome, Span, meant, nearest
from cellc.contract.diagnostics.unsafe_text import HIDDEN, hidden
from cellc.contract.errors import reason_of
from cellc.contract.file_names import SPEC_FILE
from cellc.contract.limits import MIB, limits
from cellc.contract.store.regular_file import NotRegularError, open_regular, read_regular

_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
# `<<` is not meant: that is a merge key.
_XML_START = re.compile(r"\s*<[?!a-zA-Z]")


def read_text(path: Path, name: str, place: Span) -> Outcome[str]:
    """Return the text of a file with line breaks as ``\\n`` and without byte order mark.

    Args:
        name: the file in messages and spans.
        place: what is marked when the file as a whole cannot be read, such as the include that names it.

    Returns:
        The text wherever there is one, so that a finding in it can be shown; it is no YAML where there is a finding.
    """
    content = bytes_of(path, name, place)
    return Outcome(None, (content,)) if isinstance(content, Diagnostic) else text_of(content, name)


def text_of(content: bytes, name: str) -> Outcome[str]:
    """Return the same for the content of a file, or the diagnostics in its place."""
    if len(content) > limits().spec_bytes:
        return Outcome(None, (_too_large(name, "larger", Span(name, 1, 1, 1, 1)),))
    text = _decode(content, name)
    if isinstance(text, Diagnostic):
        return Outcome(None, (text,))
    return as_yaml(text, name)


def as_yaml(text: str, name: str) -> Outcome[str]:
    """Return the text of a file, with a finding where it is no YAML; none of one that is larger than may be read."""
    if len(text) > limits().spec_bytes:
        return Outcome(None, (_too_large(name, "larger", Span(name, 1, 1, 1, 1)),))
    problem = _unlike_yaml(text, name)
    return Outcome(text, () if problem is None else (problem,))


def showable(content: bytes) -> str | None:
    """Return the text of a file of any format for a report; None where it is no text that a terminal may show."""
    text = _decode(content, "")
    return None if isinstance(text, Diagnostic) or HIDDEN.search(text) else text


def bytes_of(path: Path, name: str, place: Span) -> bytes | Diagnostic:
    """Return what a file of a spec holds, or why it cannot be read; the arguments are those of `read_text`."""
    try:
        with open_regular(path) as file:
            size = os.fstat(file.fileno()).st_size
            if size > limits().spec_bytes:
                return _too_large(name, f"{size / MIB:.1f} MiB", place)
            # What is larger than allowed nevertheless grew meanwhile, or its size the system does not tell.
            content = file.read(limits().spec_bytes + 1)
    except (NotRegularError, IsADirectoryError):
        kind = "a folder" if path.is_dir() else "not a regular file"
        return finding("not-a-file", f"`{name}` is {kind}", place, advice=_file_in(path))
    except (FileNotFoundError, NotADirectoryError):
        return finding("file-not-found", f"there is no file `{name}`", place, advice=_similar_file(path))
    except OSError as error:
        reason = reason_of(error)
        return finding("file-unreadable", f"`{name}` cannot be read: {reason}", place)
    except ValueError:
        # A zero character in the name: no system call takes it.
        return finding("file-unreadable", f"`{name}` is not a file name", place, advice="correct the path")
    return content if len(content) <= limits().spec_bytes else _too_large(name, "larger", place)


def _file_in(folder: Path) -> str:
    """Return the file of a folder that was meant; an empty text where there is no clear candidate."""
    if os.path.isfile(folder / SPEC_FILE):
        return f"name the spec in it: `{(folder / 'cell.yaml').as_posix()}`"
    if os.path.isfile(folder / "contract.json"):
        return "this is a generated folder: name the spec that it was built from"
    return "there is no `cell.yaml` in it: `cellc init NAME arm=MODEL` writes one" if os.path.isdir(folder) else ""


def _too_large(name: str, size: str, place: Span) -> Diagnostic:
    message = f"`{name}` is {size}; at most {limits().spec_bytes // MIB} MiB are read"
    return finding("file-too-large", message, place)


def _similar_file(path: Path) -> str:
    try:
        names = sorted(os.listdir(path.parent))
    except OSError:
        return f"check the folder: `{path.parent.as_posix()}` cannot be listed"
    close = nearest(path.name, names)
    return meant(path.name, close) if close else ""


def _decode(content: bytes, name: str) -> str | Diagnostic:
    if content.startswith(_UTF16_MARKS) or b"\0" in content[:4]:
        message = f"`{name}` is binary or UTF-16, not UTF-8 text"
        return finding("not-utf8", message, Span(name, 1, 1, 1, 1))
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = content[: error.start].decode("utf-8-sig")
        message = f"byte 0x{content[error.start]:02x} is not UTF-8"
        return finding("not-utf8", message, _span_after(_normalize(before), name, 0))
    return _normalize(text)


def _normalize(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _unlike_yaml(text: str, name: str) -> Diagnostic | None:
    zero = text.find("\0")
    if zero >= 0:
        return finding("not-utf8", f"`{name}` is binary: it holds a zero byte", _span_after(text[:zero], name, 1))
    if match := HIDDEN.search(text):
        message = hidden(match[0]) or ""
        return finding("control-character", message, _span_after(text[: match.start()], name, 1))
    if _XML_START.match(text):
        before = text[: len(text) - len(text.lstrip())]
        advice = "name the cell spec; a URDF or xacro belongs into the folder of a device, `model: ./my_robot`"
        span = _span_after(before, name, 1)
        return finding("not-yaml", "this looks like XML/URDF, not a cell spec", span, advice=advice)
    return None


def _span_after(before: str, name: str, width: int) -> Span:
    line = before.count("\n") + 1
    column = len(before) - before.rfind("\n")
    return Span(name, line, column, line, column + width)


_PACKAGE = "cellc/"
"""Spans in the package's own data begin so; they name no file of the current folder."""


def with_shown_texts(texts: Mapping[str, str], found: Iterable[Diagnostic], root: Path) -> dict[str, str]:
    """Add the files of devices and descriptions that findings point into; one that cannot be shown is left out.

    Args:
        texts: of the spec and what it includes, by the name that spans carry.
        root: the folder of the spec; what a link leads to outside of it is not shown.
    """
    named = {
        span.file for diagnostic in found for span in (diagnostic.span, *(other.span for other in diagnostic.related))
    }
    missing = sorted(name for name in named if name and name not in texts and not name.startswith(_PACKAGE))
    added = {name: text for name in missing if lies_under(Path(name), root) and (text := _text(name)) is not None}
    return {**texts, **added}


def lies_under(path: Path, folder: Path) -> bool:
    """Whether a file lies in a folder or below, once every symbolic link of both is followed."""
    try:
        return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))
    except (OSError, ValueError):
        # A zero character in the name, say.
        return False


def _text(name: str) -> str | None:
    try:
        return showable(read_regular(Path(name), limits().spec_bytes))
    except (OSError, ValueError):
        return None
