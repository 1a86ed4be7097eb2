"""A device's file over that of its family: what all models of a vendor's series share is written once.

``VENDOR/FAMILY.family.yaml`` has what is the same, with ``{model}`` where a text names the model; ``VENDOR/MODEL.yaml``
says ``family: FAMILY`` and its own figures. Mappings merge by key; everything else of the model replaces the family's.
"""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

from cellc.compiler.catalog.compiled import FAMILY_FILE, MODEL
from cellc.compiler.catalog.read_model import read_document
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.source.include import overlay
from cellc.compiler.source.text import lies_under
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def read_entry(file: Path, shown: str, root: Path) -> Outcome[SourceDocument]:
    """Read what a device's file says, over what its family says where it names one.

    Args:
        file: ``device.yaml`` of a folder, or the file of a model among others of its vendor.
        shown: its name in spans.
        root: the folder that its family must lie under: beside the file, or one folder above.
    """
    entry = read_document(file, shown)
    document = entry.value
    if document is None or not document.has(("family",)):
        return entry
    name, model = document.text_at(("family",)), document.text_at(("model",))
    sought = _family(file, shown, name, root)
    if sought is None:
        return Outcome(None, (_no_family(name, document),))
    family = read_document(*sought, {MODEL: model} if _NAME.fullmatch(model) else {})
    if family.value is None:
        return Outcome(None, family.diagnostics)
    texts = {**family.value.texts, **document.texts}
    return Outcome(SourceDocument(shown, texts, overlay(family.value.root, document.root)))


def _family(file: Path, shown: str, name: str, root: Path) -> tuple[Path, str] | None:
    if not _NAME.fullmatch(name):
        return None
    folders = ((file.parent, PurePosixPath(shown).parent), (file.parent.parent, PurePosixPath(shown).parent.parent))
    for folder, seen in folders:
        family_file = folder / f"{name}{FAMILY_FILE}"
        if family_file.is_file() and lies_under(family_file, root):
            return family_file, (seen / family_file.name).as_posix()
    return None


def _no_family(name: str, document: SourceDocument) -> Diagnostic:
    path = ("family",)
    message = f"`family` must name a `FAMILY{FAMILY_FILE}` beside this file or in the folder above, got `{name}`"
    advice = "write what the models share into that file, or delete `family:`"
    return Diagnostic("catalog-entry-invalid", Severity.ERROR, message, document.locate(path), path, advice)
