"""The names of a cell by what they name, where each is written, and which of them a key takes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from cellc.compiler.cell.cell import Cell
from cellc.compiler.source.document import Plain, SourceDocument
from cellc.compiler.spec.wording import value_at
from cellc.contract.diagnostics import YamlPath
from cellc.contract.fault_declaration import Reference
from cellc.contract.faults import FaultKind
from cellc.contract.steps import StepKind, StepTarget

_SECTIONS: Mapping[str, YamlPath] = {
    "device": ("devices",),
    "frame": ("frames",),
    "thing": ("scene",),
    "host": ("hosts",),
    "node": ("nodes",),
    "calibration": ("calibrations",),
    "interface": ("interfaces",),
    "manager": ("managers",),
    "controller": ("control", "controllers"),
    "group": ("motion", "groups"),
    "pose": ("motion", "poses"),
    "goal": ("motion", "goals"),
    "rehearsal": ("rehearsals",),
}
_ENDS = ("node", "controller", "device")
_KINDS: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(("client", "server", "from", "to", "published_by"), _ENDS),
    **dict.fromkeys(("device", "through", "grip"), ("device",)),
    **dict.fromkeys(("joint", "joints"), ("joint",)),
    **dict.fromkeys(("activate", "deactivate", "controller"), ("controller",)),
    **dict.fromkeys(("parent", "frame", "tip", "base", "tcp"), ("frame",)),
    "calibration": ("calibration",),
    "group": ("group",),
    "host": ("host",),
    "independent_of": ("host", "device"),
    "nic": ("nic",),
    "node": ("node",),
    "octomap": ("interface",),
    "poses": ("group",),
    "use": ("rehearsal",),
}
_REFERENCES = {Reference.NODE: ("node", "controller"), Reference.CLOCK: ("host", "device")}
_TARGETS = {
    StepTarget.POSTURE: ("pose", "goal"),
    StepTarget.FRAME: ("frame",),
    StepTarget.SWITCHED: ("device",),
    StepTarget.SENSED: ("device",),
    StepTarget.SERVICE: ("interface",),
}
_STEPS = {kind.value: _TARGETS.get(kind.target, ()) for kind in StepKind}
_FAULTS = {kind.value: kind.hits.target.reference for kind in FaultKind}


@dataclass(frozen=True, slots=True)
class Names:
    """Every name of a cell.

    Args:
        written: kind → name → where the spec writes it.
        derived: kind → what follows from the devices: links as ``device/link``, joints as ``device/joint``.
    """

    written: Mapping[str, Mapping[str, YamlPath]] = field(default_factory=dict)
    derived: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def of(self, kinds: tuple[str, ...]) -> Iterator[tuple[str, str]]:
        """Yield each name of some kinds with its kind."""
        for kind in kinds:
            yield from ((name, kind) for name in self.written.get(kind, ()))
            yield from ((name, kind) for name in self.derived.get(kind, ()))

    def place_of(self, name: str, kinds: tuple[str, ...]) -> YamlPath | None:
        """Return where a name is written, as one of some kinds or else of any."""
        sections = (self.written.get(kind, {}) for kind in (*kinds, *self.written))
        return next((section[name] for section in sections if name in section), None)


def names_of(document: SourceDocument, cell: Cell | None) -> Names:
    """Return the names of a spec, and what follows from its devices where they could be linked."""
    by_kind = {kind: _below(document.data, section) for kind, section in _SECTIONS.items()}
    for manager in by_kind["manager"].values():
        by_kind["controller"] |= _below(document.data, (*manager, "controllers"))
    by_kind["nic"] = {}
    for host in by_kind["host"].values():
        by_kind["nic"] |= _below(document.data, (*host, "nics"))
    derived = {"frame": ("world", *by_kind["thing"])}
    if cell is not None:
        links = (f"{device.name}/{link}" for device in cell.devices for link in device.body.frames)
        derived["frame"] = (*derived["frame"], *links)
        derived["joint"] = tuple(
            f"{device.name}/{joint.local_name}" for device in cell.devices for joint in device.joints
        )
    return Names(by_kind, derived)


def kinds_at(path: YamlPath) -> tuple[str, ...]:
    """Return what the value at a path names, by its key; nothing where it names nothing of the cell."""
    key = next((part for part in reversed(path) if isinstance(part, str)), "")
    if "inject" in path and key in _FAULTS:
        return _REFERENCES.get(_FAULTS[key], (_FAULTS[key].value,))
    if "steps" in path and key in _STEPS:
        return _STEPS[key]
    return _KINDS.get(key, ())


def _below(data: Plain, section: YamlPath) -> dict[str, YamlPath]:
    section_value = value_at(data, section)
    return {name: (*section, name) for name in section_value} if isinstance(section_value, dict) else {}
