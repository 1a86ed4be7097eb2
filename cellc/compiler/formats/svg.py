"""SVG 1.1 without scripts, styles or fonts from elsewhere: a sheet, lines of text, and heads of arrows."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from xml.etree.ElementTree import Element

from cellc.compiler.formats.escape import one_line
from cellc.compiler.formats.xml_text import element

Style = Mapping[str, str]


def sheet(title: str, width: float, height: float, font_size: float, children: Iterable[Element]) -> Element:
    """Return a white sheet with what is drawn on it, in the order in which it is drawn; its title is read aloud."""
    attributes = {
        "xmlns": "http://www.w3.org/2000/svg",
        "viewBox": f"0 0 {number(width)} {number(height)}",
        "font-family": "sans-serif",
        "font-size": f"{font_size:g}",
    }
    background = element("rect", {"width": "100%", "height": "100%", "fill": "#ffffff"})
    return element("svg", attributes, [element("title", text=one_line(title)), background, *children])


def text(x: float, y: float, content: str, style: Style | None = None) -> Element:
    """Return a line of text; ``y`` is its base line."""
    return element("text", {"x": number(x), "y": number(y), **(style or {})}, text=one_line(content))


def name_lines(name: str, characters: int) -> list[str]:
    """Return a name in lines that a box holds; it breaks behind an underscore or a slash where it can."""
    words = one_line(name.strip()).replace("_", "_ ").replace("/", "/ ").split()
    lines, line = [], ""
    for word in words:
        if line and len(line) + len(word) > characters:
            lines.append(line)
            line = ""
        line += word
    return [part for whole in [*lines, line] for part in textwrap.wrap(whole, characters)] or [""]


def rectangle(left: float, top: float, width: float, height: float, style: Style) -> Element:
    """Return a rectangle."""
    place = {"x": number(left), "y": number(top), "width": number(width), "height": number(height)}
    return element("rect", {**place, **style})


def number(value: float) -> str:
    """Return a length to a tenth of a unit, without zeros at its end."""
    return f"{round(value, 1) + 0.0:g}"


def arrow_head(name: str, color: str) -> Element:
    """Return the head that arrows name as ``url(#NAME)``; its size does not follow the width of the line."""
    size = {"markerWidth": "8", "markerHeight": "8", "markerUnits": "userSpaceOnUse", "orient": "auto"}
    attributes = {"id": name, "viewBox": "0 0 8 8", "refX": "7", "refY": "4"} | size
    return element("marker", attributes, [element("path", {"d": "M0 0 L8 4 L0 8 Z", "fill": color})])
