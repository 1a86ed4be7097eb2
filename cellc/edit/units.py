"""Units spelt in a way that can mean only one unit.

A number without any unit is left alone: each field takes several, and which one was meant only its author knows.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator

from cellc.diagnostics import Diagnostic
from cellc.edit.edit import Edit
from cellc.source.document import SourceDocument

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


def misspelt_units(diagnostics: Iterable[Diagnostic], document: SourceDocument) -> Iterator[Edit]:
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
    """Return the text of a value as it stands in its file, quotes included; empty where it spans lines."""
    span = found.span
    lines = document.texts.get(span.file, "").split("\n")
    if span.line != span.end_line or span.line > len(lines):
        return ""
    return lines[span.line - 1][span.column - 1 : span.end_column - 1]
