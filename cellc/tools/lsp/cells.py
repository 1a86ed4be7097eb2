"""The cells whose files are open: which spec a file belongs to, and what the last check of each left."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

from cellc.compiler.catalog.compiled import DEVICE_FILE
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.read_model import validated
from cellc.compiler.pipeline import check_buildable
from cellc.compiler.source import SourceDocument, read
from cellc.compiler.source.compose import compose
from cellc.compiler.source.text import as_yaml
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.file_names import SPEC_FILE
from cellc.tools.lsp.answers import Known

_OF_A_CELL = re.compile(r"^(cell|devices)\s*:", re.MULTILINE)
"""Whether a file of another name is a cell: an editor opens all kinds of YAML."""

_MOST_FOLDERS = 6
"""So far above a file its spec is looked for."""


class Cells:
    """What is known of every spec, by its file; files are absolute paths with forward slashes."""

    def __init__(self) -> None:
        self._known: dict[str, Known] = {}
        self._documents: dict[str, SourceDocument] = {}
        self._found: dict[str, tuple[Diagnostic, ...]] = {}
        self._spec_of: dict[str, str] = {}

    def spec_of(self, file: str, opened: Mapping[str, str]) -> str:
        """Return the spec that a file belongs to: itself, that which includes it, or itself where none does."""
        known = self._spec_of.get(file)
        if known is not None:
            return known
        spec = file
        if os.path.basename(file) != SPEC_FILE:
            above = Path(file).parents[:_MOST_FOLDERS]
            candidates = ((folder / SPEC_FILE).as_posix() for folder in above if (folder / SPEC_FILE).is_file())
            includes = (candidate for candidate in candidates if file in _texts(read(candidate, opened).value))
            spec = next(includes, file)
        if spec != file:  # a file that is not included yet may be included soon
            self._spec_of[file] = spec
        return spec

    def check(self, spec: str, opened: Mapping[str, str]) -> tuple[tuple[Diagnostic, ...], set[str]]:
        """Check a spec with the texts that are open; return what is found, and the files of which that is all gone."""
        text = opened.get(spec)
        diagnostics: tuple[Diagnostic, ...] = ()
        if os.path.basename(spec) == DEVICE_FILE:
            diagnostics = self._check_device(spec, text) if text is not None else ()
        elif os.path.basename(spec) == SPEC_FILE or (text is not None and _OF_A_CELL.search(text)):
            checked = check_buildable(spec, opened)
            diagnostics = checked.diagnostics
            document = read(spec, opened)
            if document.value is not None:
                self._documents[spec] = document.value
                self._spec_of |= dict.fromkeys(document.value.texts, spec)
            whole = document.value if document.ok else None
            cell = None if checked.graph is None else checked.graph.cell
            self._known[spec] = self._known.get(spec, Known()).with_more(whole, cell)
        before = {diagnostic.span.file for diagnostic in self._found.get(spec, ())}
        self._found[spec] = diagnostics
        return diagnostics, before - {diagnostic.span.file for diagnostic in diagnostics} | {spec}

    def _check_device(self, file: str, text: str) -> tuple[Diagnostic, ...]:
        """Return what is wrong with the file of a device by itself."""
        device_yaml = as_yaml(text, file)
        if device_yaml.diagnostics:
            return device_yaml.diagnostics
        composed = compose(file, text)
        root = composed.value
        if root is None or composed.diagnostics:
            return composed.diagnostics
        document = SourceDocument(file, {file: text}, root)
        self._documents[file] = document
        if isinstance(root.data, dict) and "family" in root.data:
            return ()  # half of an entry, which the other half completes
        return validated(document, DeviceModel).diagnostics

    def read(self, file: str, opened: Mapping[str, str]) -> SourceDocument | None:
        """Return the cell of a file as its texts are now; None where they cannot be read, or are no cell's."""
        spec = self.spec_of(file, opened)
        document = read(spec, opened)
        name = os.path.basename(spec)
        is_cell = name == SPEC_FILE or (name != DEVICE_FILE and spec in self._documents)
        return document.value if document.ok and is_cell else None

    def others(self, spec: str) -> Mapping[str, SourceDocument]:
        """Return what the last checks of other specs read."""
        return {other: document for other, document in self._documents.items() if other != spec}

    def known(self, file: str) -> Known:
        """Return what is known of the cell of a file."""
        return self._known.get(self._spec_of.get(file, file), Known())

    def found(self, file: str) -> tuple[Diagnostic, ...]:
        """Return what the last check of the cell of a file found."""
        return self._found.get(self._spec_of.get(file, file), ())

    def document(self, file: str) -> SourceDocument | None:
        """Return what the last check of the cell of a file read."""
        return self._documents.get(self._spec_of.get(file, file))

    def shown(self, file: str) -> str:
        """Return the text of a file that the last checks read; empty where none did."""
        texts = (document.texts[file] for document in self._documents.values() if file in document.texts)
        return next(texts, "")


def _texts(document: SourceDocument | None) -> Mapping[str, str]:
    return {} if document is None else document.texts
