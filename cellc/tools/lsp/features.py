"""What the server answers to each request of the protocol."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Sequence
from pathlib import Path

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException

from cellc.compiler.source import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Span
from cellc.contract.limits import limits
from cellc.contract.printing import refuse
from cellc.tools.edit.rewrite import Edit
from cellc.tools.layout.layout import formatted
from cellc.tools.lsp.answers import Symbol, completions, definition, hover, symbols
from cellc.tools.lsp.cursor import word_before
from cellc.tools.lsp.remedies import fixes
from cellc.tools.lsp.rename import Name, RenameRefusedError, name_at, renamed
from cellc.tools.lsp.server import CellServer, Ranges, file_of

_KINDS = {
    "key": lsp.CompletionItemKind.Property,
    "required key": lsp.CompletionItemKind.Property,
    "word": lsp.CompletionItemKind.EnumMember,
}

server = CellServer()

_Touched = (
    lsp.DidOpenTextDocumentParams
    | lsp.DidChangeTextDocumentParams
    | lsp.DidSaveTextDocumentParams
    | lsp.DidCloseTextDocumentParams
)


async def _touched(of: CellServer, params: _Touched) -> None:
    uri = params.text_document.uri
    if len(of.workspace.text_documents) > limits().open_documents:
        of.workspace.remove_text_document(uri)  # from here on it is what its file holds
        refuse(f"`{file_of(uri)}` is one document too many: at most {limits().open_documents} may be open")
    of.soon(uri)


for _event in (
    lsp.TEXT_DOCUMENT_DID_OPEN,
    lsp.TEXT_DOCUMENT_DID_CHANGE,
    lsp.TEXT_DOCUMENT_DID_SAVE,
    lsp.TEXT_DOCUMENT_DID_CLOSE,
):
    server.feature(_event)(_touched)


@server.feature(lsp.TEXT_DOCUMENT_HOVER)
def _hover(of: CellServer, params: lsp.HoverParams) -> lsp.Hover | None:
    text, ranges = _text(of, params.text_document.uri)
    answer = hover(text, *ranges.place(params.position), of.cells.known(file_of(params.text_document.uri)))
    if answer is None:
        return None
    return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.Markdown, answer[0]), ranges.of(answer[1]))


@server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
def _definition(of: CellServer, params: lsp.DefinitionParams) -> lsp.Location | None:
    file = file_of(params.text_document.uri)
    text, ranges = _text(of, params.text_document.uri)
    span = definition(text, *ranges.place(params.position), of.cells.known(file), Path(file))
    return None if span is None else of.location(span)


@server.feature(lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=[":", " ", "{", "[", "/"]))
def _completion(of: CellServer, params: lsp.CompletionParams) -> list[lsp.CompletionItem]:
    if of.known_text(params.text_document.uri) is None:
        return []
    text, ranges = _text(of, params.text_document.uri)
    line, column = ranges.place(params.position)
    proposals = completions(text, line, column, of.cells.known(file_of(params.text_document.uri)))
    # A name such as `arm/tool0` is one word here, whatever an editor takes for a word.
    written = ranges.of(Span("", line, column - len(word_before(text, line, column)), line, column))
    return [
        lsp.CompletionItem(
            label=proposal.word,
            kind=_KINDS.get(proposal.kind, lsp.CompletionItemKind.Reference),
            detail=proposal.kind,
            documentation=lsp.MarkupContent(lsp.MarkupKind.Markdown, proposal.meaning) if proposal.meaning else None,
            sort_text=f"{number:04}",
            text_edit=lsp.TextEdit(written, f"{proposal.word}: " if proposal.kind.endswith("key") else proposal.word),
        )
        for number, proposal in enumerate(proposals)
    ]


@server.feature(lsp.TEXT_DOCUMENT_CODE_ACTION, lsp.CodeActionOptions([lsp.CodeActionKind.QuickFix]))
def _actions(of: CellServer, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
    uri, file = params.text_document.uri, file_of(params.text_document.uri)
    document = of.cells.document(file)
    if document is None or document.texts.get(file) != of.text_of(uri):
        return []  # the places are those of another text: the next check will tell
    lines = range(params.range.start.line + 1, params.range.end.line + 2)
    diagnostics = [
        diagnostic
        for diagnostic in of.cells.found(file)
        if diagnostic.span.file == file and diagnostic.span.line in lines
    ]
    ranges = _text(of, uri)[1]
    return [
        lsp.CodeAction(
            title=remedy.edit.message.replace("`", ""),
            kind=lsp.CodeActionKind.QuickFix,
            diagnostics=[shown for shown in params.context.diagnostics if _is_about(shown, remedy.about, ranges)],
            is_preferred=remedy.preferred or None,
            edit=lsp.WorkspaceEdit(changes={uri: [lsp.TextEdit(ranges.of(_span(remedy.edit)), remedy.edit.text)]}),
        )
        for remedy in fixes(diagnostics, document)
        if remedy.edit.file == file
    ]


def _is_about(shown: lsp.Diagnostic, found: Diagnostic, ranges: Ranges) -> bool:
    return shown.code == found.code and shown.range == ranges.of(found.span)


@server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
def _symbols(of: CellServer, params: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol]:
    text, ranges = _text(of, params.text_document.uri)
    return [_symbol(symbol, ranges) for symbol in symbols(text)]


@server.feature(lsp.TEXT_DOCUMENT_FORMATTING)
def _formatting(of: CellServer, params: lsp.DocumentFormattingParams) -> list[lsp.TextEdit]:
    text, ranges = _text(of, params.text_document.uri)
    result = formatted("", text).value
    return [] if result is None or result == text else [lsp.TextEdit(ranges.whole(), result)]


@server.feature(lsp.TEXT_DOCUMENT_REFERENCES)
async def _references(of: CellServer, params: lsp.ReferenceParams) -> list[lsp.Location]:
    found = await _named(of, params)
    if found is None:
        return []
    document, name, _ = found
    return [of.location_in(document, span) for span in name.spans[0 if params.context.include_declaration else 1 :]]


@server.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
async def _prepared(of: CellServer, params: lsp.PrepareRenameParams) -> lsp.PrepareRenamePlaceholder:
    document, name, span = _to_rename(await _named(of, params))
    return lsp.PrepareRenamePlaceholder(of.location_in(document, span).range, name.word)


@server.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
async def _rename(of: CellServer, params: lsp.RenameParams) -> lsp.WorkspaceEdit:
    document, name, _ = _to_rename(await _named(of, params))
    others = of.cells.others(document.file)
    try:
        edits = await asyncio.to_thread(renamed, document, name, params.new_name, others)
    except RenameRefusedError as refused:
        raise _refused(f"`{name.word}` cannot become `{params.new_name}`: {refused}") from None
    return _workspace_edit(of, document, edits, f"Rename {name.noun} {name.word} to {params.new_name}")


async def _named(
    of: CellServer, params: lsp.ReferenceParams | lsp.PrepareRenameParams | lsp.RenameParams
) -> tuple[SourceDocument, Name, Span] | None:
    file = file_of(params.text_document.uri)
    line, column = _text(of, params.text_document.uri)[1].place(params.position)
    document = of.cells.read(file, of.opened())
    found = None if document is None else await asyncio.to_thread(name_at, document, file, line, column)
    return None if document is None or found is None else (document, *found)


def _to_rename(found: tuple[SourceDocument, Name, Span] | None) -> tuple[SourceDocument, Name, Span]:
    if found is None:
        raise _refused("here is no name that this cell gives: keys, models and parts of a device keep theirs")
    return found


def _refused(reason: str) -> JsonRpcException:
    return JsonRpcException(reason, lsp.LSPErrorCodes.RequestFailed)


def _workspace_edit(of: CellServer, document: SourceDocument, edits: Sequence[Edit], label: str) -> lsp.WorkspaceEdit:
    """Return edits in the form that the client takes: with a preview, with versions, or plain."""
    by_uri: dict[str, list[lsp.TextEdit]] = {}
    for edit in edits:
        place = of.location_in(document, _span(edit))
        by_uri.setdefault(place.uri, []).append(lsp.TextEdit(place.range, edit.text))
    workspace = of.client_capabilities.workspace
    takes = None if workspace is None else workspace.workspace_edit
    if takes is None or not takes.document_changes:
        return lsp.WorkspaceEdit(changes=by_uri)
    note = lsp.ChangeAnnotation(label, needs_confirmation=True) if takes.change_annotation_support else None
    changes = []
    for uri, texts in by_uri.items():
        opened = of.workspace.text_documents.get(uri)
        versioned = lsp.OptionalVersionedTextDocumentIdentifier(uri, None if opened is None else opened.version)
        changes.append(lsp.TextDocumentEdit(versioned, list(_annotated(texts, annotated=note is not None))))
    return lsp.WorkspaceEdit(document_changes=changes, change_annotations=None if note is None else {_ANNOTATION: note})


_ANNOTATION = "rename"


def _annotated(texts: Sequence[lsp.TextEdit], *, annotated: bool) -> Iterator[lsp.TextEdit | lsp.AnnotatedTextEdit]:
    for text in texts:
        yield lsp.AnnotatedTextEdit(_ANNOTATION, text.range, text.new_text) if annotated else text


def _text(of: CellServer, uri: str) -> tuple[str, Ranges]:
    text = of.text_of(uri)
    return text, Ranges(of.workspace.position_codec, text)


def _span(edit: Edit) -> Span:
    return Span(edit.file, edit.line, edit.column, edit.line, edit.end_column)


def _symbol(one: Symbol, ranges: Ranges) -> lsp.DocumentSymbol:
    kind = lsp.SymbolKind.Namespace if one.inner else lsp.SymbolKind.Field
    inner = [_symbol(each, ranges) for each in one.inner]
    place = ranges.of(one.span)
    return lsp.DocumentSymbol(one.name, kind, place, place, detail=one.detail, children=inner)
