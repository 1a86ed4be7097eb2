"""The elements of the picture: text, boxes with names, arrows; lengths in user units."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable
from xml.etree.ElementTree import Element

from cellc.formats.xml_text import element

LINE = 18
"""Height of a line of text."""

_UNIT = re.compile(r"(?<=\d) (s|Hz)\b")
_HELD = "\N{NO-BREAK SPACE}"


def text(x: int, y: int, said: str, style: dict[str, str]) -> Element:
    """Return a line of text; ``y`` is its base line."""
    return element("text", {"x": str(x), "y": str(y)} | style, text=said)


def arrow(left: int, right: int, y: int) -> Element:
    """Return an arrow to the right."""
    line = {"x1": str(left), "y1": str(y), "x2": str(right), "y2": str(y)}
    return element("line", line | {"stroke": "#000000", "stroke-width": "1.5", "marker-end": "url(#head)"})


def box(x: int, y: int, width: int, lines: list[str]) -> list[Element]:
    """Return a box that is as high as the names in it."""
    size = {"width": str(width), "height": str(LINE * len(lines) + 8), "rx": "5"}
    outline = element("rect", {"x": str(x), "y": str(y)} | size | {"fill": "#eef2f7", "stroke": "#51606f"})
    return [outline, *(text(x + 8, y + 16 + LINE * number, line, {}) for number, line in enumerate(lines))]


def wrapped(parts: Iterable[str], characters: int) -> list[str]:
    """Return lines that are no longer than a number of characters; each part begins one, a unit stays at its number."""
    held = (_UNIT.sub(f"{_HELD}\\1", part) for part in parts)
    return [line.replace(_HELD, " ") for part in held for line in textwrap.wrap(part, characters)]


def arrow_head() -> Element:
    """Return the definition that arrows refer to."""
    attributes = {"id": "head", "viewBox": "0 0 8 8", "refX": "7", "refY": "4", "markerWidth": "7", "markerHeight": "7"}
    marker = element("marker", attributes | {"orient": "auto"}, [element("path", {"d": "M0 0 L8 4 L0 8 Z"})])
    return element("defs", children=[marker])
