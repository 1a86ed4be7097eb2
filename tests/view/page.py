"""A page as a browser's parser sees it."""

from __future__ import annotations

import json
from html.parser import HTMLParser
from typing import Any


class Page(HTMLParser):
    """Elements with their attributes in order, the text of scripts and styles, and all text that is shown.

    What is set as code is shown between backticks.
    """

    def __init__(self, html: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str]]] = []
        self.scripts: list[str] = []
        self.styles: list[str] = []
        self.shown: list[str] = []
        self._within = ""
        self.feed(html.replace("<wbr>", "").replace("<code>", "`").replace("</code>", "`"))
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, {name: value or "" for name, value in attrs}))
        self._within = tag if tag in ("script", "style") else ""
        if tag == "script":
            self.scripts.append("")

    def handle_endtag(self, tag: str) -> None:
        self._within = ""

    def handle_data(self, data: str) -> None:
        if self._within == "script":
            self.scripts[-1] += data
        else:
            (self.styles if self._within == "style" else self.shown).append(data)

    @property
    def text(self) -> str:
        """All text that is shown."""
        return " ".join(" ".join(self.shown).split())

    @property
    def data(self) -> Any:
        """What the script of the page reads."""
        return json.loads(self.scripts[0])

    @property
    def policy(self) -> dict[str, list[str]]:
        """The Content-Security-Policy by directive."""
        (content,) = (found["content"] for _, found in self.elements if found.get("http-equiv"))
        return {name: sources for name, *sources in (part.split() for part in content.split(";"))}


def unheard(html: str) -> list[str]:
    """Return what a screen reader has no word for, or tells in the wrong order (WCAG 2.2, 1.1.1, 1.3.1, 4.1.2).

    Headings that skip a level, heads of columns and buttons without a text, pictures and controls without a name.
    """
    reader = _ScreenReader()
    reader.feed(html)
    reader.close()
    return reader.unheard + [f"no {tag}" for tag in ("main", "h1", "title") if tag not in reader.met]


class _ScreenReader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.unheard: list[str] = []
        self.met: set[str] = set()
        self._level = 0
        self._said: dict[str, str] = {}

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        self.met.add(tag)
        if tag in ("h1", "h2", "h3", "h4", "h5", "h6"):
            if int(tag[1]) > self._level + 1:
                self.unheard.append(f"{tag} behind h{self._level}")
            self._level = int(tag[1])
        if tag in ("th", "button", "summary"):
            self._said[tag] = found.get("aria-label") or ""
        if tag == "img" and "alt" not in found:
            self.unheard.append("img without alt")
        if tag == "select" and "aria-label" not in found:
            self.unheard.append("select without a name")
        if tag == "html" and not found.get("lang"):
            self.unheard.append("html without lang")

    def handle_data(self, data: str) -> None:
        for tag in self._said:
            self._said[tag] += data

    def handle_endtag(self, tag: str) -> None:
        if not self._said.pop(tag, "said").strip():
            self.unheard.append(f"{tag} without a text")
