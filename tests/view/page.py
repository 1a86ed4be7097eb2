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
