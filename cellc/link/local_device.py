"""A device that the user wrote: a folder beside the spec."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from cellc.catalog.load import CatalogDevice, load_device_folder
from cellc.diagnostics import Diagnostic, Outcome, Related, Severity, Span, YamlPath


def local_device(model: str, place: Span, path: YamlPath) -> Outcome[CatalogDevice]:
    """Load the device of a folder; what is wrong in it is reported there, with the line of the spec that names it.

    Args:
        model: the folder, relative to the file that names it.
        place: where the spec names it.
        path: the same place in the document.
    """
    root = Path(place.file).parent
    folder = root / model
    if not os.path.exists(folder / "device.yaml"):
        problem = "holds no `device.yaml`" if os.path.isdir(folder) else "is no folder"
        shown = folder.as_posix()
        advice = "write the folder with its `device.yaml`, or name a model of the catalogue"
        missing = Diagnostic("unknown-model", Severity.ERROR, f"`{shown}` {problem}", place, path, advice)
        return Outcome(None, (missing,))
    loaded = load_device_folder(folder, root)
    named = Related("the spec names this folder here", place)
    return Outcome(loaded.value, tuple(replace(one, related=(*one.related, named)) for one in loaded.diagnostics))
