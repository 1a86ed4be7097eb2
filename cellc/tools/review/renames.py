"""Parts of a spec that only have another name: they are found by what they say, before anything else is compared."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from cellc.compiler.source.document import Node, Plain, SourceDocument, rebuilt
from cellc.contract.diagnostics import YamlPath
from cellc.contract.vocabulary import ReviewArea

_A = ReviewArea
TF_FRAME = "TF frame"
"""What consumers outside the cell look up by its name, without an interface of the cell."""
SECTIONS: Mapping[tuple[str, ...], tuple[ReviewArea, str]] = {
    ("devices",): (_A.DEVICES, "device"),
    ("managers",): (_A.CONTROL, "controller manager"),
    ("managers", "*", "controllers"): (_A.CONTROL, "controller"),
    ("control", "controllers"): (_A.CONTROL, "controller"),
    ("nodes",): (_A.CONTROL, "node"),
    ("interfaces",): (_A.INTERFACES, "interface"),
    ("frames",): (_A.FRAMES, TF_FRAME),
    ("calibrations",): (_A.CALIBRATION, "calibration"),
    ("scene",): (_A.MODEL, "obstacle"),
    ("areas",): (_A.SAFETY, "shared area"),
    ("motion", "groups"): (_A.MOTION, "planning group"),
    ("motion", "poses"): (_A.MOTION, "named pose"),
    ("motion", "goals"): (_A.MOTION, "goal"),
    ("hosts",): (_A.NETWORK, "host"),
    ("hosts", "*", "nics"): (_A.NETWORK, "network card"),
    ("rehearsals",): (_A.REHEARSALS, "rehearsal"),
}
"""Mappings of the spec whose keys are names that people chose: area and noun of what they name."""
_ALIKE = 0.6
"""Share of equal values from which a part that was removed and a part that was added are one part of another name."""
_MOST_PAIRS = 2_500
_MOST_PLACES = 6
"""Words of one text of which each may be the name, or look alike."""
_NAMESPACE = "namespace"


@dataclass(frozen=True, slots=True)
class Rename:
    """A part of the spec that has another name.

    Attributes:
        section: path of the mapping that holds it.
    """

    section: YamlPath
    before: str
    after: str
    area: ReviewArea
    noun: str


@dataclass(frozen=True, slots=True)
class Names:
    """Names that changed, as whole words of a text."""

    by_name: Mapping[str, str]
    pattern: re.Pattern[str]

    def in_text(self, text: str) -> str:
        """Return a text with the names that the parts have now."""
        return self.pattern.sub(lambda found: self.by_name[found[0]], text)

    def readings(self, text: str) -> Iterator[str]:
        """Yield a text with the names that the parts have now, then with fewer of them: others only look alike."""
        places = [found for found in self.pattern.finditer(text) if self.by_name[found[0]] != found[0]]
        few = len(places) <= _MOST_PLACES
        for taken in product((True, False), repeat=len(places)) if few else ((True,) * len(places),):
            read, end = "", 0
            for place, is_name in zip(places, taken, strict=True):
                read += text[end : place.start()] + (self.by_name[place[0]] if is_name else place[0])
                end = place.end()
            yield read + text[end:]


def names_of(renames: Sequence[Rename], inside: str = r"[\w-]") -> Names:
    """Return the words that changed.

    Args:
        inside: characters that a name goes on with: ``arm`` is no word of ``arm_2`` unless an underscore ends it.
    """
    # The new name stays as it is: it may go on where the old one ends, as `pick_up` does.
    by_name = {rename.after: rename.after for rename in renames} | {rename.before: rename.after for rename in renames}
    words = "|".join(re.escape(name) for name in sorted(by_name, key=len, reverse=True))
    return Names(by_name, re.compile(rf"(?<!{inside})(?:{words or '(?!)'})(?!{inside})"))


def renames_between(before: SourceDocument, after: SourceDocument) -> tuple[Rename, ...]:
    """Return the parts that have another name and say the same otherwise, or nearly, by the new names of others."""
    found: tuple[Rename, ...] = ()
    for _ in SECTIONS:
        more = tuple(_in_mapping(before.root, after.root, (), found))
        if len(more) <= len(found):
            break
        found = more
    return found


def renamed(before: SourceDocument, after: SourceDocument, renames: Sequence[Rename]) -> SourceDocument:
    """Return the state before with the names after; a text that did not change keeps a word that only looks alike."""
    keys = {(*rename.section, rename.before): rename.after for rename in renames}
    return before.with_root(_renamed(before.root, after.root, (), keys, names_of(renames)))


def _in_mapping(before: Node, after: Node, path: YamlPath, known: Sequence[Rename]) -> Iterator[Rename]:
    both = [key for key in before.children if key in after.children]
    for key in both:
        was, now = before.children[key].node, after.children[key].node
        yield from _in_mapping(was, now, (*path, key), known)
        if key == _NAMESPACE and was.text != now.text and was.text.strip("/") and now.text.strip("/"):
            yield Rename((*path, key), was.text, now.text, _A.CONTROL, _NAMESPACE)
    held = named_in(path)
    if held is None:
        return
    gone = [key for key in before.children if key not in after.children]
    come = [key for key in after.children if key not in before.children]
    if len(gone) * len(come) > _MOST_PAIRS:
        return
    scored = [
        (_likeness(before.children[old].node.data, after.children[new].node.data, names), old, new)
        for old in gone
        for new in come
        for names in [names_of([*known, Rename((), str(old), str(new), _A.DOCUMENTS, "")])]
    ]
    taken = set[str | int]()
    for likeness, old, new in sorted(scored, key=lambda pair: -pair[0]):
        if likeness >= _ALIKE and old not in taken and new not in taken:
            taken |= {old, new}
            yield Rename(path, str(old), str(new), *held)
            yield from _in_mapping(before.children[old].node, after.children[new].node, (*path, old), known)


def named_in(path: YamlPath) -> tuple[ReviewArea, str] | None:
    """Return area and noun of what the keys of a mapping name; None where they are not names that people chose."""
    return next((named for section, named in SECTIONS.items() if _is_at(section, path)), None)


def _is_at(section: tuple[str, ...], path: YamlPath) -> bool:
    return len(section) == len(path) and all(part in ("*", key) for part, key in zip(section, path, strict=True))


def _likeness(before: Plain, after: Plain, names: Names) -> float:
    """Return the share of values that are the same, but for the names."""
    # A text with the name may speak of the part itself, or of another one that keeps its name.
    was = {tuple(map(names.in_text, path)): (text, names.in_text(text)) for path, text in texts_of(before)}
    now = dict(texts_of(after))
    return sum(now.get(path) in texts for path, texts in was.items()) / max(len(was), len(now), 1)


def texts_of(value: Plain, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield every scalar of a value with its path."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from texts_of(inner, (*path, key))
    elif isinstance(value, list):
        for number, inner in enumerate(value):
            yield from texts_of(inner, (*path, str(number)))
    else:
        yield path, str(value)


def _renamed(node: Node, other: Node | None, path: YamlPath, keys: Mapping[YamlPath, str], names: Names) -> Node:
    if not node.is_collection:
        if other is not None and other.data == node.data:
            return node
        text = names.in_text(node.text)
        return node if not isinstance(node.data, str) or text == node.text else rebuilt(node, {}, text)
    beside = {} if other is None else other.children
    children = {}
    for key, child in node.children.items():
        now = _key_now(key, beside, keys.get((*path, key)), names)
        below = None if now not in beside else beside[now].node
        children[now] = child.with_node(_renamed(child.node, below, (*path, key), keys, names))
    return rebuilt(node, children)


def _key_now(key: str | int, beside: Mapping[str | int, object], new: str | None, names: Names) -> str | int:
    if new is not None or isinstance(key, int):
        return key if new is None else new
    other = names.in_text(key)
    return other if key not in beside and other in beside else key
