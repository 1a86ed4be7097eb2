"""Parts that only have another name in another generated folder: its contract says what they are, as a spec would."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from cellc.contract.contract import Contract
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.facts import Facts, FactsError, facts_of
from cellc.tools.review.renames import TF_FRAME, Names, Rename, names_of, texts_of
from cellc.tools.review.sides import Package

_A = ReviewArea
_SECTIONS: Sequence[tuple[str, ReviewArea, str]] = (
    ("devices", _A.DEVICES, "device"),
    ("managers", _A.CONTROL, "controller manager"),
    ("controllers", _A.CONTROL, "controller"),
    ("clocks", _A.TIME, "clock"),
    ("interfaces", _A.INTERFACES, "interface"),
    ("nodes", _A.CONTROL, "node"),
    ("calibrations", _A.CALIBRATION, "calibration"),
    ("frames", _A.FRAMES, TF_FRAME),
    ("groups", _A.MOTION, "planning group"),
    ("poses", _A.MOTION, "named pose"),
    ("goals", _A.MOTION, "goal"),
)
"""What has names in a contract; first those that give others theirs, such as a device its links."""
_ALIKE = 0.8
"""Share of equal values, of those that are not the default: a contract repeats of a part much that all such have."""
_MOST_PAIRS = 2_500
_LETTERS = "[A-Za-z0-9]"
"""What goes on with a name where it is a part of another: `arm` is one of `arm_base_link`."""
_WORD = re.compile(r"\w+")

_Parts = Mapping[str, Mapping[str, Any]]
"""What a contract says of the parts of one kind, by their names."""


def renames_between_folders(before: Contract, after: Contract) -> tuple[Rename, ...]:
    """Return the parts of a contract that have another name and say the same otherwise, or nearly."""
    was, now = _sections(before), _sections(after)
    found = list[Rename]()
    for section, area, noun in _SECTIONS:
        for old, new in _in_section(was[section], now[section], found):
            found.append(Rename((section,), old, new, area, noun))
    return tuple(found)


def facts_with_names(before: Package, after: Package, renames: Sequence[Rename]) -> Facts | None:
    """Return what a package would say with the names of another; None where that is no package.

    A line that the other has too keeps a word that only looks alike.
    """
    names = names_of(renames, inside=_LETTERS)
    renamed = dict[str, str]()
    words = frozenset(word for text in after.files.values() for word in _WORD.findall(text))
    for path, text in before.files.items():
        now = path if path in after.files else names.in_text(path)
        known = frozenset(after.files.get(now, "").split("\n"))
        renamed[now] = "\n".join(_line(line, names, known, words) for line in text.split("\n"))
    try:
        facts = facts_of(renamed)
    except FactsError:
        return None
    # Another name is another cell, whatever else is the same.
    digest = after.facts.manifest.configuration_inputs.cell_sha256
    inputs = facts.manifest.configuration_inputs.model_copy(update={"cell_sha256": digest})
    manifest = facts.manifest.model_copy(update={"configuration_inputs": inputs})
    return replace(facts, edited=before.facts.edited, manifest=manifest)


def _line(line: str, names: Names, known: Container[str], words: Container[str]) -> str:
    """Return a line with the names of another file: as that has it, else word by word as any file does."""
    if line in known or names.pattern.search(line) is None:
        return line
    whole = next((read for read in names.readings(line) if read in known), None)
    return _WORD.sub(lambda found: _read(found[0], names, words), line) if whole is None else whole


def _read(name: str, names: Names, known: Container[str]) -> str:
    return next((read for read in names.readings(name) if read in known), names.in_text(name))


def _in_section(before: _Parts, after: _Parts, found: Sequence[Rename]) -> Iterator[tuple[str, str]]:
    """Yield pairs of names, the likeliest first; one that another name implies is no pair of its own."""
    so_far = names_of(found, inside=_LETTERS)
    implied = {name: _read(name, so_far, after) for name in before}
    gone = [name for name in before if name not in after and implied[name] not in after]
    come = [name for name in after if name not in before and name not in implied.values()]
    if len(gone) * len(come) > _MOST_PAIRS:
        return
    scored = [
        (_likeness(before[old], after[new], [*found, Rename((), old, new, _A.DOCUMENTS, "")]), old, new)
        for old in gone
        for new in come
    ]
    taken = set[str]()
    for likeness, old, new in sorted(scored, key=lambda pair: -pair[0]):
        if likeness >= _ALIKE and taken.isdisjoint((old, new)):
            taken |= {old, new}
            yield old, new


def _likeness(before: Mapping[str, Any], after: Mapping[str, Any], renames: Sequence[Rename]) -> float:
    names = names_of(renames, inside=_LETTERS)
    was = {tuple(map(names.in_text, path)): text for path, text in texts_of(dict(before))}
    now = dict(texts_of(dict(after)))
    alike = sum(path in now and now[path] in names.readings(text) for path, text in was.items())
    return alike / max(len(was), len(now), 1)


def _sections(contract: Contract) -> dict[str, _Parts]:
    data: dict[str, Any] = contract.model_dump(mode="json", exclude_defaults=True)
    managers: dict[str, Any] = data.get("managers", {})
    controllers = {name: one for held in managers.values() for name, one in held.get("controllers", {}).items()}
    return {
        **{name: data.get(name, {}) for name, _, _ in _SECTIONS},
        "poses": {name: {"of": pose} for name, pose in data.get("poses", {}).items()},
        "controllers": controllers,
        "nodes": _nodes(data, controllers),
    }


def _nodes(data: Mapping[str, Any], controllers: _Parts) -> _Parts:
    """Return what a contract says of each node of the cell: its clock, and at which end of which interface it is."""
    clocks: dict[str, Any] = data.get("clock_of", {})
    of_others = {*data.get("devices", {}), *controllers}
    nodes: dict[str, dict[str, Any]] = {name: {"clock": clock} for name, clock in clocks.items()}
    for interface, held in data.get("interfaces", {}).items():
        for end in ("sources", "sinks"):
            for entry in held.get(end, ()):
                nodes.setdefault(entry["node"], {})[f"{end} {interface}"] = entry
    # A node of which only the clock is known has nothing that tells it from others.
    return {name: known for name, known in nodes.items() if name not in of_others and len(known) > 1}
