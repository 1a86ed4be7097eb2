"""What has one safe answer: misspelled keys and units, and a missing modeline.

A number without any unit is left alone: each field takes several, and which one was meant only its author knows.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, is_slip, only_suggestion
from cellc.tools.edit.rewrite import Edit


def misspelled_keys(diagnostics: Iterable[Diagnostic], document: SourceDocument) -> Iterator[Edit]:
    """Yield the edit of each unknown key that can mean only one thing, and that does not stand there already."""
    unknown = [found for found in diagnostics if found.code == "unknown-key" and found.yaml_path]
    # An alias brings one line into several places, where its key may mean different things.
    times = Counter(found.span for found in unknown)
    taken = set()
    for found in unknown:
        meant = only_suggestion(found.help)
        if meant is None or times[found.span] > 1:
            continue
        key, place = str(found.yaml_path[-1]), (*found.yaml_path[:-1], meant)
        if document.has(place) or place in taken or not _is_safe(key, meant, found, document):
            continue
        taken.add(place)
        span = found.span
        yield Edit(span.file, span.line, span.column, span.end_column, meant, f"`{key}` becomes `{meant}`")


def _is_safe(key: str, meant: str, found: Diagnostic, document: SourceDocument) -> bool:
    """Whether the span holds the bare key itself, one slip away from what is meant."""
    span = found.span
    lines = document.texts.get(span.file, "").split("\n")
    if span.line != span.end_line or span.line > len(lines):
        return False
    written = lines[span.line - 1][span.column - 1 : span.end_column - 1]
    return written == key and is_slip(key, meant)


# Unit of the spec → other spellings, in lower case. Left out: `mhz`, which may be a millihertz, and `min` for minute of
# arc; a prefix is never guessed.
_SPELLINGS = {
    "Hz": ("hz", "hertz", "1/s"),
    "kHz": ("khz", "kilohertz"),
    "s": ("sec", "secs", "second", "seconds"),
    "ms": ("msec", "msecs", "millisecond", "milliseconds"),
    "us": ("usec", "µs", "μs", "microsecond", "microseconds"),
    "min": ("minute", "minutes"),
    "h": ("hour", "hours", "hr"),
    "deg": ("degree", "degrees", "°"),
    "rad": ("radian", "radians"),
    "mm": ("millimeter", "millimeters", "millimetre", "millimetres"),
    "cm": ("centimeter", "centimeters", "centimetre", "centimetres"),
    "m": ("meter", "meters", "metre", "metres"),
    "kg": ("kilogram", "kilograms", "kgs"),
    "g": ("gram", "grams"),
    "%": ("percent", "pct"),
    "N": ("newton", "newtons"),
    "deg/s": ("deg/sec", "degrees/s", "°/s"),
    "rad/s": ("rad/sec", "radians/s"),
    "m/s": ("m/sec",),
    "mm/s": ("mm/sec",),
}
_UNITS = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings}
_WRITTEN_UNIT = re.compile(r"[\d.][\s]*([^\s\d.][^\s\"']*)[\"']?$")


def misspelled_units(diagnostics: Iterable[Diagnostic], document: SourceDocument) -> Iterator[Edit]:
    """Yield the edit of each wrong unit that is another spelling of one that its field takes."""
    wrong = [found for found in diagnostics if found.code == "wrong-unit"]
    # An alias brings one text into several fields, which may take different units.
    times = Counter(found.span for found in wrong)
    for found in wrong:
        span = found.span
        written = _written(found, document)
        match = _WRITTEN_UNIT.search(written)
        unit = _UNITS.get(match[1].lower()) if match is not None else None
        if match is None or unit is None or times[span] > 1 or f"`{unit}`" not in found.help:
            continue
        start, end = (span.column + column for column in match.span(1))
        yield Edit(span.file, span.line, start, end, unit, f"unit `{match[1]}` becomes `{unit}`")


def _written(found: Diagnostic, document: SourceDocument) -> str:
    """Return the text of a value as it is in its file, quotes included; empty where it spans lines."""
    span = found.span
    lines = document.texts.get(span.file, "").split("\n")
    if span.line != span.end_line or span.line > len(lines):
        return ""
    return lines[span.line - 1][span.column - 1 : span.end_column - 1]


_MODELINE = "yaml-language-server:"
_SCHEMAS = Path("schemas")


def missing_modeline(file: str, text: str, schema_of: str = "cell") -> Iterator[Edit]:
    """Yield the edit that puts the modeline first, where the file has none and a schema lies beside or above it.

    Args:
        file: the root spec, or the file of a device, as the user named it.
        schema_of: what it is: a cell or a device.
    """
    schema = _schema_above(Path(file), _SCHEMAS / f"{schema_of}.schema.json")
    if schema is None or any(_MODELINE in line for line in text.split("\n") if line.lstrip().startswith("#")):
        return
    line = f"# {_MODELINE} $schema={schema}"
    yield Edit(file, 1, 1, 1, f"{line}\n", f"`{line}` is added")


def _schema_above(file: Path, schema: Path) -> str | None:
    folder = file.resolve().parent
    for above in (folder, *folder.parents):
        if (above / schema).is_file():
            return Path(os.path.relpath(above / schema, folder)).as_posix()
    return None
