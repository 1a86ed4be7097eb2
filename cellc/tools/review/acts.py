"""Which edits of a spec are one act, and are listed as one cause: a new measurement with what it moved, a new model."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TypeAlias

from cellc.compiler.source.document import Child, SourceDocument
from cellc.contract.diagnostics import YamlPath
from cellc.tools.review.spec_edits import SpecEdit, spec_edits

_MOST = 20
"""Causes that are tried one by one; of more edits, those of one part of the spec are one cause."""
_TOGETHER = 3
"""Values of one mapping that are listed as one: of a calibration, its revision, its day and its residual."""
_AS_ONE = ("payload", "limits", "commissioning")
"""Mappings whose values are listed as one however few they are: a mass and where it is, velocity and acceleration."""
_BOUNDS = ("within", "cancel_within", "cancel")
"""Keys of one bound: of the action, of the rehearsal that checks it, and of the figure that reports it."""
_NAMED = (("motion", "poses"), ("motion", "goals"))
_RATES, _OF_RATE = ("rate", "update_rate"), ("deadline", "lifespan", "lease_duration")
"""Keys of a rate, and of times of an interface that rest on it."""
_POSE = ("xyz", "rpy")
"""Keys of a place: where something is and how it is turned count together."""
_PLACED_IN = (*_POSE, "parent")
MEASURED, _REVISION, _CALIBRATION = ("calibrations",), "revision", "calibration"
_ROOMS, _PLACED = ("scene", "areas"), 3
"""Sections whose entries take up room: where it is and how large count together."""
_OF_MODEL = ("model", "mount", "mounted_on", "serial", "revision", "firmware", "driver", "sdk", "description")
"""What another model of a device brings with it."""
_END_OF_TOPIC, _IN_POSE = 5, 3
"""Parts of the path of what one end of an interface asks or offers, and of that of a named pose or goal."""
_LONGEST, _BESIDE = 60, 12
"""Characters of a value that a heading has, and of what is the same before those that differ."""

Cause: TypeAlias = tuple[SpecEdit, ...]
"""Edits of a spec that are listed as one."""


def causes_between(before: SourceDocument, after: SourceDocument) -> tuple[Cause, ...]:
    """Return the edits between two states of a spec, those of one part as one where there are many.

    What a new measurement found is one with it: the calibration, and the poses that it measured. So is what another
    model of a device brings with it, and a list that repeats what other lines say.
    """
    edits = spec_edits(before, after)
    beside = Counter(edit.path[:-1] for edit in edits)
    keys = [_keys(edit, edits, beside, after) for edit in edits]
    shared = Counter(key for each in keys for key in each)
    causes = _joined(edits, [[key for key in each if shared[key] > 1] for each in keys])
    causes = tuple(tuple(sorted(cause, key=_place_in_act)) for cause in causes)
    for depth in (3, 2, 1):
        if len(causes) > _MOST:
            causes = _joined(edits, [[edit.path[:depth]] for edit in edits])
    return causes


def is_model(path: YamlPath) -> bool:
    """Tell whether a value of a spec is the model of a device, which more follows from than from any other."""
    return path[:1] == ("devices",) and path[2:] == ("model",)


def _keys(
    edit: SpecEdit, edits: Sequence[SpecEdit], beside: Mapping[YamlPath, int], after: SourceDocument
) -> Sequence[YamlPath]:
    """Return what makes edits one: those that have one of these in common."""
    path, keys = edit.path, list[YamlPath]()
    renewed = {other.path[1] for other in edits if other.path[:1] == MEASURED and len(other.path) > len(MEASURED) + 1}
    if path[-1] in _PLACED_IN and (name := after.text_at((*path[:-1], _CALIBRATION))) in renewed:
        keys.append((*MEASURED, name))
    if path[:1] == MEASURED and path[1] in renewed:
        keys.append(path[:2])
    if len(path) > 2 and path[2] in _OF_MODEL and any(other.path == (*path[:2], "model") for other in edits):
        keys.append(("model", *path[:2]))
    if _is_together(path, beside):
        keys.append(path[:-1])
    if path[:1] == ("interfaces",) and len(path) == _END_OF_TOPIC:
        keys.append(("ends", path[1], path[-1], *map(str, texts_of(edit))))
    if path[-1] in _BOUNDS:
        keys.append(("bound", *map(str, texts_of(edit))))
    if path[:2] in _NAMED and len(path) > _IN_POSE:
        keys.append((*path[:2], "=", *path[_IN_POSE:], *map(str, texts_of(edit))))
    keys += _of_rate(edit, edits)
    keys += _repeating(edit, edits)
    if len(path) > 2 and (not keys or is_model(path)):
        # Lines that are alike, of several devices or interfaces, are one.
        keys.append(alike(edit))
    return keys


def _of_rate(edit: SpecEdit, edits: Sequence[SpecEdit]) -> Iterator[YamlPath]:
    """Yield what makes both ends of a rate one: its values, and its interface whose times rest on it."""
    path = edit.path
    if path[-1] in _RATES and None not in texts_of(edit):
        yield "rate", *map(str, texts_of(edit))
    rate = (*path[:2], _RATES[0])
    if path[:1] == ("interfaces",) and (path == rate or path[-1] in _OF_RATE):
        yield from [("rate", *path[:2])] * any(other.path == rate for other in edits)


def _repeating(edit: SpecEdit, edits: Sequence[SpecEdit]) -> Iterator[YamlPath]:
    """Yield the list in which other lines are repeated that changed, such as the addresses of computers."""
    for listing in edits:
        lost, new = _entries(listing.before), _entries(listing.after)
        if not lost or not new:
            continue
        gone, come = lost - new, new - lost
        of = [(other, *map(_bare, texts_of(other))) for other in edits if other is not listing]
        repeated = [(other, was, now) for other, was, now in of if was in gone and now in come]
        is_whole = {was for _, was, _ in repeated} == gone and {now for _, _, now in repeated} == come
        if is_whole and (edit is listing or any(edit is other for other, _, _ in repeated)):
            yield "list", *listing.path


def _entries(child: Child | None) -> frozenset[str]:
    data = None if child is None else child.node.data
    return frozenset(item for item in data if isinstance(item, str)) if isinstance(data, list) else frozenset()


def _bare(text: str | None) -> str:
    """Return an address without the length of its network."""
    return (text or "").partition("/")[0]


def alike(edit: SpecEdit) -> YamlPath:
    """Return what edits of several devices or interfaces have in common that say the same."""
    return "=", edit.path[0], *edit.path[2:], *map(str, texts_of(edit))


def _place_in_act(edit: SpecEdit) -> tuple[bool, int]:
    """Return which edit is first: a model, what moved, the revision of a measurement, the rest of it, what repeats."""
    if edit.path[:1] != MEASURED:
        return not is_model(edit.path), 0 if edit.path[-1] in _PLACED_IN else 4 if _entries(edit.after) else 3
    return True, 1 if edit.path[-1] == _REVISION else 2


def _is_together(path: YamlPath, beside: Mapping[YamlPath, int]) -> bool:
    is_one = path[-1] in _POSE or (path[-2:-1] and path[-2] in _AS_ONE) or (len(path) == _PLACED and path[0] in _ROOMS)
    return beside[path[:-1]] >= (2 if is_one else _TOGETHER)


def _joined(edits: Sequence[SpecEdit], keys: Sequence[Collection[YamlPath]]) -> tuple[Cause, ...]:
    """Return edits that have a key in common as one, also by way of others, in the order of the file."""
    group = [*range(len(edits))]
    first = dict[YamlPath, int]()
    for number, each in enumerate(keys):
        for key in each:
            old, new = group[number], group[first.setdefault(key, number)]
            group = [min(old, new) if place in (old, new) else place for place in group]
    return tuple(
        tuple(edit for edit, place in zip(edits, group, strict=True) if place == number)
        for number in dict.fromkeys(group)
    )


def texts_of(edit: SpecEdit) -> tuple[str | None, str | None]:
    """Return both values of an edit in one line; of long ones the part that differs."""
    was, now = (None if child is None else _flow(child) for child in (edit.before, edit.after))
    if was is None or now is None:
        return None if was is None else shortened(was), None if now is None else shortened(now)
    if max(len(was), len(now)) > _LONGEST:
        same = next((at for at, (one, other) in enumerate(zip(was, now, strict=False)) if one != other), len(was))
        is_list = was[:1] == now[:1] == "["
        left_out, between = ("[..., ", ", ") if is_list else ("...", " ")
        place = was.rfind(between, 0, max(same - _BESIDE, 0))
        was, now = (text if place < 0 else f"{left_out}{text[place + len(between) :]}" for text in (was, now))
    return shortened(was), shortened(now)


def described(edit: SpecEdit) -> tuple[str | None, str | None]:
    """Return what is new or gone in a line: of a part of the spec its main figures, as its author wrote them."""
    if len(edit.path) != len(("devices", "arm")) or edit.path[0] not in _FACTS:
        return texts_of(edit)
    told = _of_device if edit.path[0] == "devices" else _of_part
    was, now = (
        None if child is None else told(child, _FACTS[str(edit.path[0])]) for child in (edit.before, edit.after)
    )
    return was, now


_FACTS: Mapping[str, Sequence[str]] = {
    "devices": ("xyz", "rpy", "calibration"),
    "calibrations": ("revision", "measured", "residual", "method", "samples", "owner"),
    "frames": ("parent", "xyz", "rpy", "calibration", "published_by", "rate"),
    "scene": ("parent", "xyz", "rpy", "box", "cylinder", "sphere", "mesh", "plane"),
    "areas": ("parent", "xyz", "rpy", "box", "granted_by", "released"),
    "nodes": ("run", "host", "owner", "lifecycle"),
    "interfaces": (
        *("topic", "action", "service", "from", "server", "to", "client", "rate", "max_age", "on_stale", "frame"),
        *("timeout", "cancel_within"),
    ),
    "rehearsals": ("use", "steps", "inject", "expect", "within", "success", "bring_up"),
}
"""Keys of the main figures of each part of a spec, in the order in which they are read."""
_MOST_TOLD = 160


def _of_part(child: Child, keys: Sequence[str]) -> str:
    """Return the main figures of a part of the spec: as many as there is room for, none of them cut."""
    inner = child.node.children
    told = [f"{key} {_flow(inner[key])}" for key in keys if key in inner]
    while len(told) > 1 and len(", ".join(told)) > _MOST_TOLD:
        told.pop()
    return ", ".join(told) or _flow(child)


def _of_device(child: Child, keys: Sequence[str]) -> str:
    def text(*path: str) -> str:
        node = child.node
        for key in path:
            if key not in node.children:
                return ""
            node = node.children[key].node
        return node.text

    parent, (host, nic, port) = text("mount", "parent"), (text("connection", key) for key in ("host", "nic", "port"))
    address = text("connection", "address") or port
    card = f"card `{nic}` of `{host}`" if nic else f"`{host}`" if host else ""
    return ", ".join(
        part
        for part in (
            f"{text('model')} on `{parent}`" if parent else text("model"),
            *(f"{key} {text('mount', key)}" for key in keys if text("mount", key)),
            f"{address} at {card}" if address and card else address or card,
        )
        if part
    )


def flow_of(child: Child) -> str:
    """Return a value in one line, cut where it is long."""
    return shortened(_flow(child))


def shortened(text: str) -> str:
    """Return a text that a heading has room for: it is cut between entries of a list, else between words."""
    if len(text) <= _LONGEST:
        return text
    start = text[: _LONGEST - len(", ...")]
    items = start.rpartition(", ")[0]
    return f"{items}, ..." if len(items) > _BESIDE else f"{start.rpartition(' ')[0] or start}..."


def _flow(child: Child) -> str:
    """Return a value in one line, as YAML has it in flow style."""
    node = child.node
    if not node.is_collection:
        return node.text or '""'
    inner = [_flow(each) for each in node.children.values()]
    if isinstance(node.data, list):
        return f"[{', '.join(inner)}]"
    return "{" + ", ".join(f"{key}: {text}" for key, text in zip(node.children, inner, strict=True)) + "}"
