"""Elements of the page as a tree, so that no text of the spec is ever taken for markup."""

from __future__ import annotations

import re
from collections.abc import Iterable
from xml.etree.ElementTree import Element, tostring

Child = Element | str
_UNPRINTABLE = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]")
"""Characters that HTML text must not hold."""


def tag(name: str, *children: Child, **attributes: str) -> Element:
    """Return an element; a trailing underscore of an attribute is dropped, other underscores become hyphens."""
    names = {key: key.removesuffix("_").replace("_", "-") for key in attributes}
    element = Element(name, {names[key]: _clean(value) for key, value in attributes.items()})
    return extend(element, children)


def extend(element: Element, children: Iterable[Child]) -> Element:
    """Add children to an element and return it."""
    for child in children:
        if isinstance(child, Element):
            element.append(child)
        elif len(element):
            element[-1].tail = (element[-1].tail or "") + _clean(child)
        else:
            element.text = (element.text or "") + _clean(child)
    return element


def svg(width: float, height: float, label: str, *children: Child, class_: str = "plot") -> Element:
    """Return a drawing that fills the width of its place; the label is read aloud in its stead."""
    element = tag("svg", tag("title", label), *children, class_=class_, role="img")
    element.set("viewBox", f"0 0 {width:g} {height:g}")
    return element


def to_page(title: str, style: str, body: Element) -> str:
    """Return a whole page."""
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name_="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name_="color-scheme", content="light dark"),
        tag("title", title),
        tag("style", style),
    )
    html = tag("html", head, body, lang="en")
    return "<!DOCTYPE html>\n" + tostring(html, encoding="unicode", method="html") + "\n"


def _clean(text: str) -> str:
    return _UNPRINTABLE.sub("\ufffd", text)
