"""Elements of the page as a tree, so that no text of the spec is taken for markup, and figures with their units."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from xml.etree.ElementTree import Element, tostring

from cellc.contract.diagnostics.unsafe_text import escaped_within
from cellc.contract.store.regular_file import own_text

Child = Element | str
_NONE = "–"
PREFIXES = ((1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n"))
"""Of units, each with its parts of one."""
_LENGTHS = frozenset({"m", "rad", "rad or m"})
_CODE = re.compile(r"`([^`\n]+)`")
_VERBATIM = frozenset({"code", "mark", "option", "pre", "script", "style", "text", "title"})
"""Elements whose text stays as it is: a backtick in it is a backtick."""


def tag(name: str, *children: Child, **attributes: str) -> Element:
    """Return an element; a trailing underscore of an attribute is dropped, other underscores become hyphens."""
    names = {key: key.removesuffix("_").replace("_", "-") for key in attributes}
    element = Element(name, {names[key]: escaped_within(value) for key, value in attributes.items()})
    return extend(element, children)


def extend(element: Element, children: Iterable[Child]) -> Element:
    """Add children to an element and return it; what a text has in backticks is set as code."""
    for child in chain.from_iterable(_parts(each, element.tag) for each in children):
        if isinstance(child, Element):
            element.append(child)
        elif len(element):
            element[-1].tail = (element[-1].tail or "") + escaped_within(child)
        else:
            element.text = (element.text or "") + escaped_within(child)
    return element


def _parts(child: Child, tag_name: str) -> Iterator[Child]:
    if isinstance(child, Element) or tag_name in _VERBATIM or "`" not in child:
        yield child
        return
    for number, part in enumerate(_CODE.split(child)):
        yield tag("code", part) if number % 2 else part


def cards(names: Sequence[str], rows: Iterable[Sequence[Child]]) -> Element:
    """Return a table whose rows are cards on a phone, each value with its name; a value may be a cell already."""
    body = (tag("tr", *(_named(cell, name) for name, cell in zip(names, row, strict=True))) for row in rows)
    head = tag("thead", tag("tr", *(tag("th" if name else "td", name) for name in names)))
    return tag("div", tag("table", head, tag("tbody", *body), class_="cards"), class_="wide")


def _named(cell: Child, name: str) -> Element:
    element = cell if isinstance(cell, Element) and cell.tag == "td" else tag("td", cell)
    if element.find("code") is not None:  # the cell of a card is a grid, in which all of its text is one item
        whole = tag("span")
        whole.text, whole[:], element.text, element[:] = element.text, element[:], None, [whole]
    element.set("data-name", name)
    return element


def breakable(name: str) -> Element:
    """Return a long name of an interface, a type or a node: a line breaks after `/`, `:` or `_`, not inside a word."""
    words = [word for word in re.split(r"(?<=[/:_])", name) if word]
    return extend(tag("span"), [part for word in words for part in (word, tag("wbr"))][:-1])


def section(title: str, *children: Child, id_: str = "") -> Element:
    """Return a section under its title; the head of the page leads to those that have an id."""
    element = tag("section", tag("h2", title), *children)
    if id_:
        element.set("id", id_)
    return element


def hint(*children: Child) -> Element:
    """Return a paragraph that explains what is around it."""
    return tag("p", *children, class_="hint")


def pairs(rows: Iterable[tuple[str, Child]], class_: str) -> Element:
    """Return names with what belongs to each; a value may be a ``dd`` already."""
    values = ((name, value if isinstance(value, Element) else tag("dd", value)) for name, value in rows)
    return tag("dl", *(tag("div", tag("dt", name), value) for name, value in values), class_=class_)


def svg(width: float, height: float, label: str, *children: Child, class_: str = "plot") -> Element:
    """Return a drawing that fills the width of its place; the label is read aloud in its stead."""
    element = tag("svg", tag("title", label), *children, class_=class_, role="img")
    element.set("viewBox", f"0 0 {width:g} {height:g}")
    return element


def style() -> str:
    """Return the style sheet of reports."""
    return own_text(Path(__file__).with_name("style.css"))


def to_page(title: str, style: str, body: Element, *, policy: str = "") -> str:
    """Return a whole page.

    Args:
        policy: Content-Security-Policy that the browser holds the page to; none if empty.
    """
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        *([tag("meta", http_equiv="Content-Security-Policy", content=policy)] if policy else []),
        tag("meta", name_="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name_="color-scheme", content="light dark"),
        tag("title", title),
        tag("style", style),
    )
    html = tag("html", head, body, lang="en")
    return "<!DOCTYPE html>\n" + tostring(html, encoding="unicode", method="html") + "\n"


def seconds(value_s: float | None) -> str:
    """Return a time: milliseconds below one second."""
    if value_s is None:
        return _NONE
    if abs(value_s) < 1.0:
        return "below 1 µs" if 0.0 < abs(value_s) < 1e-6 else f"{value_s * 1e3:.3g} ms"
    return f"{value_s:.4g} s"


def at(stamp_ns: int) -> str:
    """Return an instant of simulated time."""
    return f"{stamp_ns / 1e9:.3f} s"


def span(low: float, high: float, unit: str) -> str:
    """Return the range of a joint's positions, with four digits after the point."""
    return f"{low:.4f} … {high:.4f} {unit}".replace("-", "−")


def small(value: float, unit: str) -> str:
    """Return a deviation in thousandths or millionths of its unit, whatever reads best; rounding is no deviation."""
    for factor, prefix in PREFIXES:
        if abs(value) * factor >= 1.0:
            return f"{value * factor:.3g} {_prefixed(prefix, unit)}"
    return f"0 {unit}" if value == 0.0 else f"below 1 {_prefixed('n', unit)}"


def _prefixed(prefix: str, unit: str) -> str:
    """Return a unit, or the units of which it is one: `mrad or mm`."""
    return " or ".join(prefix + each for each in unit.split(" or "))


def plain(value: float | None, unit: str) -> str:
    """Return a figure of the checkpoint, or one that was measured."""
    if value is None:
        return _NONE
    if unit == "s":
        return seconds(value)
    if unit in _LENGTHS:
        return small(value, unit)
    if unit == "share":
        return f"{value:.0%}"
    return f"{value:{'g' if value % 1.0 == 0.0 else '.4g'}} {unit.removesuffix('s') if value == 1 else unit}"
