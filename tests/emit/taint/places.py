"""Every place of a folder of YAML and XML files where a text stands: values, keys and attributes."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from xml.sax.saxutils import escape

import yaml

_TAG = re.compile(r"<!--.*?-->|<\?.*?\?>|<[^>]*>", re.S)
_ATTRIBUTE = re.compile(r"""[\w:.-]+\s*=\s*("[^"]*"|'[^']*')""")
_NUMBERS = re.compile(r"[-+.\deE\s]*")
_TEXT = re.compile(r">([^<>]*[^<>\s][^<>]*)<")


@dataclass(frozen=True, slots=True, order=True)
class Place:
    """Where a text stands: from one character of a file up to another."""

    file: str
    line: int
    start: int
    end: int
    original: str
    breaks: int = 0
    anchor: str = ""

    def __str__(self) -> str:
        return f"{self.file}:{self.line} `{self.original[:40]}`"


def places_of(files: Mapping[str, str]) -> tuple[Place, ...]:
    """Return every place of all files, in order."""
    found: list[Place] = []
    for name, text in files.items():
        if name.endswith(".yaml"):
            found += _in_yaml(name, text)
        elif name.endswith(".urdf"):
            found += _in_xml(name, text)
    return tuple(sorted(found))


def _in_yaml(name: str, text: str) -> Iterator[Place]:
    for event in yaml.parse(text, Loader=yaml.CSafeLoader):
        start, end = event.start_mark, event.end_mark
        if isinstance(event, yaml.ScalarEvent) and start and end and end.index > start.index:
            anchor = f"&{event.anchor} " if event.anchor else ""
            breaks = end.line - start.line
            yield Place(name, start.line + 1, start.index, end.index, event.value, breaks, anchor)


def _in_xml(name: str, text: str) -> Iterator[Place]:
    for tag in _TAG.finditer(text):
        if not tag[0].startswith(("<!", "<?")):
            for one in _ATTRIBUTE.finditer(tag[0]):
                yield _place(name, text, tag.start() + one.start(1) + 1, tag.start() + one.end(1) - 1)
    for one in _TEXT.finditer(_TAG.sub(lambda tag: "<" + " " * (len(tag[0]) - 2) + ">", text)):
        yield _place(name, text, one.start(1), one.end(1))


def _place(name: str, text: str, start: int, end: int) -> Place:
    return Place(name, text.count("\n", 0, start) + 1, start, end, text[start:end])


def with_texts(files: Mapping[str, str], texts: Mapping[Place, str]) -> dict[str, str]:
    """Return the files with other texts at places; no line moves."""
    changed = dict(files)
    for name in files:
        here = sorted((place for place in texts if place.file == name), reverse=True)
        for place in here:
            old = changed[name]
            changed[name] = old[: place.start] + _written(place, texts[place]) + old[place.end :]
    return changed


def _written(place: Place, text: str) -> str:
    if place.file.endswith(".yaml"):
        return place.anchor + json.dumps(text) + "\n" * place.breaks  # YAML reads it as the same text, escapes too
    return escape(text, {'"': "&quot;", "'": "&apos;", "\n": "&#10;"})


def columns_of(files: Mapping[str, str], texts: Mapping[Place, str]) -> dict[Place, range]:
    """Return the columns, from 1 on, where the other texts stand once they are written."""
    found: dict[Place, range] = {}
    moved: dict[tuple[str, int], int] = {}
    for place in sorted(texts):
        line = (place.file, place.line)
        before = files[place.file].rfind("\n", 0, place.start) + 1
        length = len(_written(place, texts[place]))
        column = place.start - before + 1 + moved.get(line, 0)
        found[place] = range(column, column + length)
        moved[line] = moved.get(line, 0) + length - (place.end - place.start)
    return found


def single(places: Iterable[Place]) -> tuple[Place, ...]:
    """Return the places that are tried alone: in XML those whose text stands nowhere else and is no number."""
    numbers = Counter(place.original for place in places)
    return tuple(
        place
        for place in places
        if place.file.endswith(".yaml") or (numbers[place.original] == 1 and not _NUMBERS.fullmatch(place.original))
    )


def families(places: Iterable[Place]) -> dict[str, tuple[Place, ...]]:
    """Return the places that hold one and the same text, where there are several: a name and what refers to it."""
    found: dict[str, list[Place]] = {}
    for place in places:
        found.setdefault(place.original, []).append(place)
    return {text: tuple(here) for text, here in found.items() if len(here) > 1 and not _NUMBERS.fullmatch(text)}
