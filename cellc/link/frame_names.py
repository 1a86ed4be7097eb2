"""References to frames, ``world``, ``tcp`` or ``arm/tool0``, and the TF frames that they mean."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from cellc.cell.device import Device
from cellc.cell.frame import WORLD
from cellc.diagnostics import Outcome, YamlPath
from cellc.link.unknown import unknown_name
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec


@dataclass(frozen=True, slots=True)
class FrameNames:
    """Every reference that the spec may write, with its TF frame."""

    by_reference: Mapping[str, str]
    document: SourceDocument

    def bind(self, reference: str, path: YamlPath) -> Outcome[str]:
        """Return the TF frame of a reference, or the diagnostic that it does not exist."""
        if reference in self.by_reference:
            return Outcome(self.by_reference[reference])
        known = self.by_reference
        return Outcome(None, (unknown_name("unknown-frame", reference, "frame", known, self.document, path),))


def name_frames(spec: CellSpec, document: SourceDocument, devices: Iterable[Device]) -> FrameNames:
    """Collect the frames of the world, of devices, of the spec's frames and of its scene."""
    names = {WORLD: WORLD}
    for device in devices:
        names |= {f"{device.name}/{short}": link for short, link in device.frames.items()}
    names |= {name: name for name in (*spec.frames, *spec.scene)}
    return FrameNames(names, document)
