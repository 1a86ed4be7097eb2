"""The language server on pygls: documents and messages of the protocol, and nothing that decides anything.

Language Server Protocol 3.17: https://microsoft.github.io/language-server-protocol/specifications/lsp/3.17/specification
"""

from __future__ import annotations

import asyncio
import io
import os
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from io import FileIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol
from pygls.uris import from_fs_path, to_fs_path
from pygls.workspace import PositionCodec, TextDocument

from cellc.compiler.source import SourceDocument
from cellc.compiler.source.text import read_text
from cellc.contract.diagnostics import Diagnostic, Severity, Span
from cellc.contract.limits import limits
from cellc.contract.printing import refuse
from cellc.contract.signals import Stopped, raise_again
from cellc.tools.edit.rewrite import normalized
from cellc.tools.lsp.answers import by_file
from cellc.tools.lsp.cells import Cells
from cellc.version import __version__

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

_QUIET_S = 0.15
"""Seconds without a keystroke before a cell is checked."""

_LONGEST_HEADER = 1024
_NOTHING = b'{"jsonrpc": "2.0", "method": "$/dropped"}'
"""A notification without a meaning, which LSP 3.17 has every receiver ignore: `$ Notifications and Requests`."""

_SEVERITIES = {
    Severity.ERROR: lsp.DiagnosticSeverity.Error,
    Severity.BLOCKER: lsp.DiagnosticSeverity.Warning,
    Severity.WARNING: lsp.DiagnosticSeverity.Warning,
    Severity.AUDIT: lsp.DiagnosticSeverity.Information,
}


class _Protocol(LanguageServerProtocol):
    """The protocol of pygls, with an answer also to requests whose parameters are malformed."""

    def structure_message(self, data: dict[str, Any]) -> Any:
        """Return a received message as its type; a malformed request gets an error response."""
        try:
            return super().structure_message(data)
        except JsonRpcException as problem:
            if "method" in data and "id" in data:
                self._send_response(data["id"], None, problem.to_response_error())
            raise


class CellServer(LanguageServer):
    """A server with what it knows of the cells of its client."""

    def __init__(self) -> None:
        super().__init__("cellc", __version__, protocol_cls=_Protocol)
        self.cells = Cells()
        self._waiting: dict[str, asyncio.Task[None]] = {}
        self._checking = asyncio.Lock()
        self._writing: FileIO | None = None

    def serve(self, source: int, sink: int) -> None:
        """Answer what comes from one descriptor on another, until goodbye, the end of what comes, or a signal."""
        # A thread of pygls reads, and cannot be woken while nothing comes: a pipe between can be closed.
        reading, writing = os.pipe()
        self._writing = os.fdopen(writing, "wb", buffering=0)
        threading.Thread(target=_pump, args=(source, self._writing), daemon=True).start()
        with _Messages(reading) as coming, _Answers(os.dup(sink)) as going:
            self.start_io(coming, going)

    def shutdown(self) -> None:
        """End the threads."""
        if self._writing is not None:
            self._writing.close()
        end: Callable[[], None] = super().shutdown
        end()

    def text_of(self, uri: str) -> str:
        """Return a document with line breaks as ``\\n``; empty for one that is neither open nor to be read."""
        return self.known_text(uri) or ""

    def known_text(self, uri: str) -> str | None:
        """Return a document with line breaks as ``\\n``; None for one that is neither open nor to be read."""
        if uri not in self.workspace.text_documents:
            file = file_of(uri)
            return read_text(Path(file), file, Span(file, 1, 1, 1, 1)).value
        source = self.workspace.get_text_document(uri).source
        return None if len(source) > limits().spec_bytes else normalized(source)

    def soon(self, uri: str) -> None:
        """Check the cell of a document after a pause in typing; a later change restarts the wait."""
        spec = self.cells.spec_of(file_of(uri), self.opened())
        before = self._waiting.pop(spec, None)
        if before is not None:
            before.cancel()
        self._waiting[spec] = asyncio.get_running_loop().create_task(self._check(spec))

    async def _check(self, spec: str) -> None:
        await asyncio.sleep(_QUIET_S)
        self._waiting.pop(spec, None)  # from here on a change begins another check, which comes after this one
        async with self._checking:
            opened = self.opened()
            diagnostics, gone = await asyncio.to_thread(self.cells.check, spec, opened)
        by_path = by_file(diagnostics)
        for file in dict.fromkeys((*by_path, *gone)):
            self._publish(file, by_path.get(file, ()), opened)

    def _publish(self, file: str, found: Sequence[Diagnostic], opened: dict[str, str]) -> None:
        path = Path(file)
        if not path.is_absolute():
            return  # data of the package, which is not edited here
        text = opened.get(file) or self.cells.shown(file)
        ranges = Ranges(self.workspace.position_codec, text)
        converted = [self._converted(diagnostic, ranges) for diagnostic in found]
        uri = from_fs_path(file) or ""
        self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(uri, converted))

    def _converted(self, found: Diagnostic, ranges: Ranges) -> lsp.Diagnostic:
        related = [
            lsp.DiagnosticRelatedInformation(self.location(related.span), related.message)
            for related in found.related
            if Path(related.span.file).is_absolute()
        ]
        message = f"{found.message}\nhelp: {found.help}" if found.help else found.message
        return lsp.Diagnostic(
            range=ranges.of(found.span),
            message=message,
            severity=_SEVERITIES[found.severity],
            code=found.code,
            source="cellc",
            related_information=related or None,
        )

    def location(self, span: Span) -> lsp.Location:
        """Return a place in any file."""
        opened = self.opened()
        text = opened.get(span.file) or self.cells.shown(span.file) or read_text(Path(span.file), "", span).value or ""
        return self._location(text, span)

    def location_in(self, document: SourceDocument, span: Span) -> lsp.Location:
        """Return a place in a file of a document."""
        return self._location(document.texts[span.file], span)

    def _location(self, text: str, span: Span) -> lsp.Location:
        return lsp.Location(from_fs_path(span.file) or "", Ranges(self.workspace.position_codec, text).of(span))

    def opened(self) -> dict[str, str]:
        """Return the text of every open document by its file."""
        documents: dict[str, TextDocument] = dict(self.workspace.text_documents)
        most = limits().spec_bytes + 1  # of a larger one so much that it is refused as a file is
        return {file_of(uri): normalized(document.source[:most]) for uri, document in documents.items()}


class _Messages(io.BufferedReader):
    """What an editor sends; a message that is longer than the limit is passed over."""

    def __init__(self, descriptor: int) -> None:
        super().__init__(os.fdopen(descriptor, "rb", buffering=0))

    def readline(self, size: int | None = -1) -> bytes:
        """Return a line of a header, or a part of one that is longer than any."""
        return super().readline(_LONGEST_HEADER)

    def read(self, size: int | None = -1) -> bytes:
        """Return a message."""
        most, left = limits().message_bytes, size or 0
        if left <= most:
            return super().read(left)
        refuse(f"a message of {left} bytes is dropped: at most {most} are read")
        while left and (dropped := super().read(min(left, most))):
            left -= len(dropped)
        return b"" if left else _NOTHING


class _Answers(FileIO):
    """What an editor gets. A signal that comes while the editor takes nothing ends it: no rest of it is waited for."""

    def __init__(self, descriptor: int) -> None:
        super().__init__(descriptor, "wb")
        self._ended = False

    def write(self, data: ReadableBuffer, /) -> int:
        """Write a message, or drop it behind one that was cut short."""
        left = memoryview(data)
        try:
            while left and not self._ended:
                left = left[super().write(left) or 0 :]
        except Stopped:
            self._ended = True
            raise_again()
            raise
        return memoryview(data).nbytes


def _pump(source: int, sink: FileIO) -> None:
    with suppress(OSError, ValueError), sink:  # until either is closed
        while data := os.read(source, 1 << 16):
            while data:
                data = data[sink.write(data) :]


class Ranges:
    """From the places of a text, counted in characters from 1, to those of a client."""

    def __init__(self, codec: PositionCodec, text: str) -> None:
        self._codec, self._lines = codec, text.split("\n")

    def of(self, span: Span) -> lsp.Range:
        """Return the range of a span."""
        return lsp.Range(self._at(span.line, span.column), self._at(span.end_line, span.end_column))

    def _at(self, line: int, column: int) -> lsp.Position:
        line = min(line, len(self._lines))
        before = self._lines[line - 1][: column - 1]
        return lsp.Position(line - 1, self._codec.client_num_units(before))

    def place(self, position: lsp.Position) -> tuple[int, int]:
        """Return the line and column, from 1, of a client's position."""
        at = self._codec.position_from_client_units(self._lines, position)
        return at.line + 1, at.character + 1

    def whole(self) -> lsp.Range:
        """Return the range of the whole text."""
        return lsp.Range(lsp.Position(0, 0), self._at(len(self._lines), len(self._lines[-1]) + 1))


def file_of(uri: str) -> str:
    """Return the absolute path of a document with forward slashes, as spans name it."""
    # No file has a zero character in its name, and Python refuses to look for one.
    return Path((to_fs_path(uri) or uri).replace("\0", "\ufffd")).as_posix()
