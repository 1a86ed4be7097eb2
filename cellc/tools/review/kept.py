"""What a spec states for one model of a device, and that stays as it was when the model is another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import YamlPath
from cellc.contract.vocabulary import UNKNOWN
from cellc.tools.review.acts import Cause, flow_of, is_model

_OF_DEVICE = ("payload", "grip", "limits", "serial", "collision", "impedance", "tool_connector")
"""What is stated of the device itself, what counts most first."""
_OF_CARRIER = ("payload", "collision")
"""What is set in the arm that carries it."""
_PLACES = ("xyz", "rpy")
_MOST = 6


def kept_beside(cause: Cause, before: SourceDocument, after: SourceDocument) -> tuple[str, ...]:
    """Return what was stated for the model that a cause replaces, and is the same after; empty of another cause."""
    devices = [edit.path[1] for edit in cause if is_model(edit.path)]
    paths = dict.fromkeys(path for device in devices for path in _belonging(str(device), after))
    told = [
        f"{'.'.join(map(str, path))} {flow_of(now)}"
        for path in paths
        if (now := after.child(path)) is not None
        and (was := before.child(path)) is not None
        and was.node.data == now.node.data != UNKNOWN
    ]
    more = (f"{len(told) - _MOST} more",) if len(told) > _MOST else ()
    return (*told[:_MOST], *more)


def _belonging(device: str, document: SourceDocument) -> Iterator[YamlPath]:
    """Yield the paths of what is chosen for one model, those of loads and tips first."""
    for carrier in _carriers(device, document):
        yield from (("devices", carrier, key) for key in _OF_CARRIER)
    yield from (("devices", device, key) for key in _OF_DEVICE)
    for frame in _names(document, ("frames",)):
        parent = document.text_at(("frames", frame, "parent"))
        if parent.partition("/")[0] == device:
            yield from (("frames", frame, key) for key in _PLACES)
    if _carries_tip(device, document):
        for frame in _names(document, ("frames",)):
            yield "frames", frame, "grasp", "width"
    for other in _names(document, ("devices",)):
        if document.text_at(("devices", other, "mount", "parent")).partition("/")[0] == device:
            yield from (("devices", other, "mount", key) for key in _PLACES)
    for pose in _names(document, ("motion", "poses")):
        yield from (
            ("motion", "poses", pose, group)
            for group in _names(document, ("motion", "poses", pose))
            if document.text_at(("motion", "groups", str(group), "base")).partition("/")[0] == device
        )
    yield from (("devices", device, "mount", key) for key in _PLACES)


def _carries_tip(device: str, document: SourceDocument) -> bool:
    """Tell whether the tip of a planning group is on a device: it meets the parts."""
    tips = {
        document.text_at(("motion", "groups", str(group), "tip")) for group in _names(document, ("motion", "groups"))
    }
    return any(document.text_at(("frames", tip, "parent")).partition("/")[0] == device for tip in tips)


def _carriers(device: str, document: SourceDocument) -> Iterator[str]:
    """Yield what carries a device, the nearest first."""
    seen = {device}
    while True:
        device = document.text_at(("devices", device, "mount", "parent")).partition("/")[0]
        if device in seen or document.child(("devices", device)) is None:
            return
        seen.add(device)
        yield device


def _names(document: SourceDocument, path: YamlPath) -> Sequence[str | int]:
    child = document.child(path)
    return () if child is None else tuple(child.node.children)
