"""Lines of the folders of devices that a cell brings along: they cause changes as lines of its spec do."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import islice
from pathlib import Path

from cellc.compiler.source import read
from cellc.compiler.source.document import SourceDocument
from cellc.contract.limits import limits
from cellc.contract.review import ReviewCause, ReviewValue
from cellc.contract.store.regular_file import read_regular
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.acts import flow_of
from cellc.tools.review.change import Change
from cellc.tools.review.facts import Facts
from cellc.tools.review.spec_edits import spec_edits

_FILE = "device.yaml"
_DESCRIPTIONS = (".xacro", ".urdf")
_PROSE = ("summary", "source")
"""Keys of texts for people alone."""
_OF_DESCRIPTION = (ReviewArea.MODEL, ReviewArea.FRAMES, ReviewArea.MOTION)
_NOT_OF_FOLDERS = (ReviewArea.GATES,)
"""Areas of what else has no line of the spec: a finding that a comment excuses."""
_MOST_LINES = 10_000
_LONGEST = 60
_INCLUDE = re.compile(
    r"""(?:<xacro:include\s[^>]*?filename=["']|load_yaml\(['"])"""
    r"""(?:\$\(find\s+(?P<package>[\w-]+\)/[^"'$]+)|(?P<path>[^"'$]+))["']"""
)
_OPENED = re.compile(r'<(link|joint)\s[^>]*?name="([^"]*)"')
_DEGREE = math.degrees(1.0)
_ATTRIBUTE = re.compile(r'([\w:]+)="([^"]*)"')


@dataclass(frozen=True, slots=True)
class FolderCause:
    """Lines of one file in the folder of a device that changed."""

    device: str
    is_description: bool
    cause: ReviewCause


def folder_causes(before: SourceDocument, after: SourceDocument) -> tuple[FolderCause, ...]:
    """Return the files that changed in the folders of devices that both states of a spec name."""
    was, now = _folders(before), _folders(after)
    return tuple(
        found for device, folder in now.items() if device in was for found in _in_folder(device, was[device], folder)
    )


def by_folders(
    found: Sequence[tuple[int | None, Change]], causes: Sequence[FolderCause], start: int, before: Facts, after: Facts
) -> tuple[tuple[ReviewCause, ...], list[tuple[int | None, Change]]]:
    """Return the causes that change something, and each change that no line of the spec causes with its number.

    Args:
        start: number of the first.
    """
    chosen = {
        at: _of_change(change, causes, before, after)
        for at, (number, change) in enumerate(found)
        if number is None and change.area not in _NOT_OF_FOLDERS
    }
    kept = sorted({number for number in chosen.values() if number is not None})
    numbered = [
        (number if (at_folder := chosen.get(at)) is None else start + kept.index(at_folder), change)
        for at, (number, change) in enumerate(found)
    ]
    return tuple(causes[number].cause for number in kept), numbered


def _of_change(change: Change, causes: Sequence[FolderCause], before: Facts, after: Facts) -> int | None:
    """Return the number of the likeliest cause: that of the device whose name the subject has, in the file of it."""
    described = change.area in _OF_DESCRIPTION or _limit(before, change.subject) != _limit(after, change.subject)
    ranked = sorted(
        range(len(causes)),
        key=lambda number: (
            causes[number].is_description is not described,
            not change.subject.startswith(causes[number].device),
        ),
    )
    return next(iter(ranked), None)


def _limit(facts: Facts, name: str) -> object:
    return next((joint.limit for joint in facts.description.joints if joint.name == name), None)


def _folders(document: SourceDocument) -> dict[str, tuple[str, Path]]:
    """Return the folder of each device that has one: as the spec writes it, and where it is."""
    devices = document.child(("devices",))
    folders = {}
    for device in () if devices is None else devices.node.children:
        place = document.child(("devices", device, "model"))
        if place is not None and ("/" in place.node.text or place.node.text.startswith(".")):
            folder = Path(place.span.file).parent / place.node.text
            folders[str(device)] = (place.node.text.removeprefix("./").rstrip("/"), folder)
    return folders


def _in_folder(device: str, before: tuple[str, Path], after: tuple[str, Path]) -> Iterator[FolderCause]:
    was, now = _texts(before[1]), _texts(after[1])
    for file in now:
        if was.get(file, now[file]) == now[file]:
            continue
        shown = os.path.normpath(f"{after[0]}/{file}").replace(os.sep, "/")
        if file == _FILE:
            values = tuple(_of_yaml(before[1] / file, after[1] / file, shown))
        else:
            # Where a joint is says more than the shapes of a link.
            lines = _of_lines(was[file], now[file], shown)
            values = tuple(sorted(lines, key=lambda value: not value.line.startswith("joint ")))
        if values:
            yield FolderCause(device, file != _FILE, _cause(shown, values))


def _texts(folder: Path) -> Mapping[str, str]:
    """Return what says facts of a device: its own file and its descriptions with what they include, that is no link."""
    files = sorted(islice(folder.rglob("*"), limits().folder_entries))
    open_ = [file for file in files if file == folder / _FILE or file.suffix in _DESCRIPTIONS]
    texts = dict[str, str]()
    while open_ and len(texts) < limits().folder_entries:
        file = open_.pop(0)
        name = Path(os.path.relpath(file, folder)).as_posix()
        text = None if name in texts or file.is_symlink() else _text(file)
        if text is not None:
            texts[name] = text
            open_ += _included(file, text)
    return texts


def _included(file: Path, text: str) -> Iterator[Path]:
    """Yield the files that a description includes or loads: by their path from it, or in a package above it."""
    for found in _INCLUDE.finditer(text):
        package, _, rest = (found["package"] or "").replace(")", "", 1).partition("/")
        wanted = [file.parent / found["path"]] if not package else [each / package / rest for each in file.parents]
        yield from islice((Path(os.path.normpath(path)) for path in wanted if path.is_file()), 1)


def _text(file: Path) -> str | None:
    try:
        return read_regular(file, limits().spec_bytes).decode()
    except (OSError, ValueError):
        return None


def _of_yaml(before: Path, after: Path, shown: str) -> Iterator[ReviewValue]:
    was, now = read(before).value, read(after).value
    for edit in () if was is None or now is None else spec_edits(was, now):
        if edit.path[-1] in _PROSE:
            continue
        path = edit.path[:-1] if edit.path[-1] == "value" else edit.path
        yield ReviewValue(
            line=".".join(map(str, path)),
            before=None if edit.before is None else flow_of(edit.before),
            after=None if edit.after is None else flow_of(edit.after),
            place=f"{shown}:{edit.place.line}:{edit.place.column}",
        )


def _of_lines(before: str, after: str, shown: str) -> Iterator[ReviewValue]:
    was, now = ([line.strip() for line in text.split("\n")[:_MOST_LINES]] for text in (before, after))
    for kind, start, end, at, to in SequenceMatcher(None, was, now, autojunk=False).get_opcodes():
        for number in range(max(end - start, to - at) if kind != "equal" else 0):
            old = was[start + number] if start + number < end else ""
            new = now[at + number] if at + number < to else ""
            name, old, new = _named(old, new)
            holder = _holder(now, min(at + number, len(now) - 1)) if name != "line" else ""
            name, old, new = f"{holder} {name}".strip(), _with_unit(name, old), _with_unit(name, new)
            place = f"{shown}:{min(at + number, max(to - 1, at)) + 1}:1"
            yield ReviewValue(line=name, before=_short(old), after=_short(new), place=place)


_UNITS = {
    "xyz": (1e3, "mm"),
    "length": (1e3, "mm"),
    "radius": (1e3, "mm"),
    "size": (1e3, "mm"),
    "rpy": (_DEGREE, "deg"),
}
"""How people read what a URDF has in m and rad, by its attribute."""


def _with_unit(name: str, text: str) -> str:
    """Return figures of a description in the unit in which people read them."""
    factor, unit = _UNITS.get(name.rpartition(" ")[2], (1.0, ""))
    try:
        figures = [float(word) * factor for word in text.split()]
    except ValueError:
        return text
    return f"{' '.join(f'{round(figure, 6) + 0.0:.7g}' for figure in figures)} {unit}" if unit and figures else text


def _holder(lines: Sequence[str], at: int) -> str:
    """Return the link or joint that a line of a URDF is in; empty of any other file."""
    for line in reversed(lines[: at + 1]):
        found = _OPENED.match(line)
        if found is not None:
            return f"{found[1]} {found[2]}"
    return ""


def _named(before: str, after: str) -> tuple[str, str, str]:
    """Return what differs in a line: of a tag with another value of one attribute, that; else the lines."""
    was, now = dict(_ATTRIBUTE.findall(before)), dict(_ATTRIBUTE.findall(after))
    differing = [key for key in now if was.get(key) != now[key]]
    if was.keys() != now.keys() or len(differing) != 1 or _ATTRIBUTE.sub("", before) != _ATTRIBUTE.sub("", after):
        return "line", before, after
    (key,) = differing
    tag = before.lstrip("<").split(maxsplit=1)[0].rpartition(":")[2]
    holder = now.get("name", tag) if key != "name" else tag
    return holder if key == "value" else f"{holder} {key}", was[key], now[key]


def _short(text: str) -> str | None:
    return (text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}...") or None


def _cause(file: str, values: Sequence[ReviewValue]) -> ReviewCause:
    first = values[0]
    if len(values) == 1:
        return ReviewCause(line=f"{file} {first.line}", before=first.before, after=first.after, place=first.place)
    listed = _short(", ".join(value.line for value in values))
    return ReviewCause(line=file, after=listed, place=first.place, lines=len(values), values=tuple(values))
