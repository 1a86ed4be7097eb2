"""The language server, driven over standard input and output by the client of pygls, as an editor drives it."""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import pytest
from lsprotocol import types as lsp
from pygls.lsp.client import LanguageClient

from tests.cells import CORPUS, ROOT

_SPEC = """\
format: 1
cell: line
summary: 🤖 on a stage
include: parts/hosts.yaml
versions: {ros: jazzy}
devices:
  stage: {model: ./stage, mount: {parent: world, xyz: 0 0 250 mm}}
frames:
  tray: {parent: stage/carriage, xyz: 0 0 10 mm, designed: true}
control:
  update_rate: 100 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
    stage_trajectory: {type: joint_trajectory, device: stage, goal_time: 1 s, path_tolerance: 0.1 rad 10 mm,
                       goal_tolerance: 0.01 rad 1 mm}
motion:
  poses:
    home: {}
rehearsals:
  waits: {steps: [{wait: 1 s}]}
"""
_WRONG = _SPEC.replace("designed: true", "desigend: true").replace("update_rate: 100 Hz", "update_rate:   100 hertz")


class Editor:
    """A client with one document, whose places are told by the text around them."""

    def __init__(self, client: LanguageClient, file: Path) -> None:
        self.client, self.uri, self.text, self._version = client, file.as_uri(), "", 0
        self.told: asyncio.Queue[lsp.PublishDiagnosticsParams] = asyncio.Queue()
        self.document = lsp.TextDocumentIdentifier(self.uri)

        def tell(params: lsp.PublishDiagnosticsParams) -> None:
            self.told.put_nowait(params)

        client.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(tell)

    def open(self, text: str) -> None:
        self.text = text
        item = lsp.TextDocumentItem(self.uri, "yaml", 0, text)
        self.client.text_document_did_open(lsp.DidOpenTextDocumentParams(item))

    def change(self, text: str) -> None:
        self.text, self._version = text, self._version + 1
        versioned = lsp.VersionedTextDocumentIdentifier(self._version, self.uri)
        whole = lsp.TextDocumentContentChangeWholeDocument(text)
        self.client.text_document_did_change(lsp.DidChangeTextDocumentParams(versioned, [whole]))

    async def findings(self) -> list[lsp.Diagnostic]:
        """Return what is told of the document next."""
        while True:
            params = await asyncio.wait_for(self.told.get(), 60)
            if params.uri == self.uri:
                return list(params.diagnostics)

    def at(self, before: str, after: str = "") -> lsp.Position:
        """Return the place between two texts; columns count UTF-16 units, as the protocol does without another word."""
        index = self.text.index(before + after) + len(before)
        line = self.text[:index].split("\n")[-1]
        return lsp.Position(self.text.count("\n", 0, index), len(line.encode("utf-16-le")) // 2)

    async def hover(self, before: str, after: str = "") -> str:
        told = await self.client.text_document_hover_async(lsp.HoverParams(self.document, self.at(before, after)))
        assert told is not None
        assert isinstance(told.contents, lsp.MarkupContent)
        return str(told.contents.value)

    async def hover_range(self, before: str, after: str = "") -> lsp.Range | None:
        told = await self.client.text_document_hover_async(lsp.HoverParams(self.document, self.at(before, after)))
        return None if told is None else told.range

    async def definition(self, before: str, after: str = "") -> tuple[str, int]:
        place = lsp.DefinitionParams(self.document, self.at(before, after))
        told = await self.client.text_document_definition_async(place)
        assert isinstance(told, lsp.Location)
        return told.uri, told.range.start.line

    async def actions(self, found: list[lsp.Diagnostic]) -> list[lsp.CodeAction]:
        everywhere = lsp.Range(lsp.Position(0, 0), lsp.Position(self.text.count("\n"), 0))
        asked = lsp.CodeActionParams(self.document, everywhere, lsp.CodeActionContext(found))
        told = await self.client.text_document_code_action_async(asked)
        return [finding for finding in told or () if isinstance(finding, lsp.CodeAction)]

    async def completion(self, before: str, after: str = "") -> list[str]:
        place = lsp.CompletionParams(self.document, self.at(before, after))
        told = await self.client.text_document_completion_async(place)
        assert isinstance(told, list)
        return [finding.label for finding in told]


@dataclass
class Session:
    """What a session of an editor was told."""

    folder: Path
    found: list[lsp.Diagnostic] = field(default_factory=list)
    found_wrong: list[lsp.Diagnostic] = field(default_factory=list)
    found_mended: list[lsp.Diagnostic] = field(default_factory=list)
    actions: list[lsp.CodeAction] = field(default_factory=list)
    excuses: list[lsp.CodeAction] = field(default_factory=list)
    hovers: dict[str, str] = field(default_factory=dict)
    definitions: dict[str, tuple[str, int]] = field(default_factory=dict)
    completions: dict[str, list[str]] = field(default_factory=dict)
    symbols: list[str] = field(default_factory=list)
    formatted: str = ""
    range: lsp.Range | None = None
    code: int | None = None


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    folder = tmp_path_factory.mktemp("editor")
    (folder / "parts").mkdir()
    (folder / "parts" / "hosts.yaml").write_text("hosts:\n  control_pc: {scheduling: generic}\n")
    shutil.copytree(CORPUS / "invalid/base/stage", folder / "stage")
    (folder / "cell.yaml").write_text("what is saved is not what is open")
    done = Session(folder)
    asyncio.run(_play(done))
    return done


async def _play(done: Session) -> None:
    client = LanguageClient("test", "1")
    await client.start_io(sys.executable, "-m", "cellc", "lsp", env={**os.environ, "PYTHONPATH": str(ROOT)})
    editor = Editor(client, done.folder / "cell.yaml")
    await client.initialize_async(lsp.InitializeParams(lsp.ClientCapabilities(), root_uri=done.folder.as_uri()))
    client.initialized(lsp.InitializedParams())
    editor.open(_SPEC)
    done.found = await editor.findings()
    done.excuses = await editor.actions(done.found)
    await _ask(editor, done)
    await _mend(editor, done)
    await client.shutdown_async(None)
    client.exit(None)
    process = client._server
    assert process is not None
    done.code = await asyncio.wait_for(process.wait(), 20)


async def _ask(editor: Editor, done: Session) -> None:
    done.hovers = {
        "value": await editor.hover("xyz: 0 0 2", "50 mm}}"),
        "key": await editor.hover("goal_", "time"),
        "model": await editor.hover("stage: {mod", "el"),
    }
    done.range = await editor.hover_range("on a ", "stage")
    done.definitions = {
        "device": await editor.definition("device: st", "age"),
        "owner": await editor.definition("parent: sta", "ge/carriage"),
        "link": await editor.definition("parent: stage/carr", "iage"),
        "model": await editor.definition("model: ./", "stage"),
        "include": await editor.definition("include: parts", "/"),
    }
    done.completions["frame"] = await editor.completion("tray: {parent: st", "age")
    done.completions["rest"] = await editor.completion("joint_state_broadcaster", "}")
    begun = {
        "model": ("stage: {model: ./stage, mount", "stage: {model: ^, mount"),
        "key": ("control:\n", "control:\n  ^\n"),
        "controller": ("{type: joint_state_broadcaster}", "{type: sca^"),
        "host": ("  update_rate: 100 Hz\n", "  update_rate: 100 Hz\n  host: ^\n"),
        "pose": ("[{wait: 1 s}]", "[move: ^"),
        "word": ("{ros: jazzy}", "{ros: jazzy}\nnetwork: {discovery: ^}"),
    }
    for name, (old, new) in begun.items():
        editor.change(_SPEC.replace(old, new.replace("^", "")))
        before = new.partition("^")[0]
        done.completions[name] = await editor.completion(before)
    symbols = await editor.client.text_document_document_symbol_async(lsp.DocumentSymbolParams(editor.document))
    done.symbols = [symbol.name for symbol in symbols or () if isinstance(symbol, lsp.DocumentSymbol)]


async def _mend(editor: Editor, done: Session) -> None:
    editor.change(_WRONG)
    while not any(finding.code == "unknown-key" for finding in done.found_wrong):
        done.found_wrong = await editor.findings()
    done.actions = await editor.actions(done.found_wrong)
    made = await editor.client.text_document_formatting_async(
        lsp.DocumentFormattingParams(editor.document, lsp.FormattingOptions(2, True))
    )
    done.formatted = "".join(one.new_text for one in made or ())
    editor.change(_corrected(_WRONG, done.actions))
    done.found_mended = await editor.findings()


def _corrected(text: str, actions: list[lsp.CodeAction]) -> str:
    lines = text.split("\n")
    for edit in _edits(actions):
        line = lines[edit.range.start.line]
        lines[edit.range.start.line] = (
            line[: edit.range.start.character] + edit.new_text + line[edit.range.end.character :]
        )
    return "\n".join(lines)


def _edits(actions: list[lsp.CodeAction]) -> Iterator[lsp.TextEdit]:
    for action in actions:
        assert action.edit is not None
        for edits in (action.edit.changes or {}).values():
            yield from edits


def test_what_is_open_is_checked_not_what_is_saved(session: Session) -> None:
    assert "empty-file" not in {finding.code for finding in session.found}
    assert all(finding.severity is not lsp.DiagnosticSeverity.Error for finding in session.found)
    pinned = next(finding for finding in session.found if finding.code == "unknown-version")
    assert pinned.source == "cellc"


def test_change_is_checked_and_points_at_the_place(session: Session) -> None:
    wrong = next(finding for finding in session.found_wrong if finding.code == "unknown-key")
    line = _WRONG.split("\n")[wrong.range.start.line]
    assert line[wrong.range.start.character : wrong.range.end.character] == "desigend"
    assert "did you mean" in wrong.message


def test_hover_tells_meaning_si_value_what_is_used_and_its_origin(session: Session) -> None:
    assert "Translation in the parent frame" in session.hovers["value"]
    assert "`0 0 250 mm` is 0 0 0.25 m." in session.hovers["value"]
    place = (session.folder / "cell.yaml").as_posix()
    assert f"`xyz 0 0 0.25 m, rpy 0 0 0 deg` | {place}:7" in session.hovers["value"]
    assert "Time allowed past the end of a trajectory. Units: s, ms" in session.hovers["key"]
    assert "Catalog entry, or a folder beside this file" in session.hovers["model"]


def test_places_count_utf_16_units_as_the_protocol_does(session: Session) -> None:
    # A robot's face is one character and two units: UTF-16, LSP 3.17, "Position".
    assert session.range == lsp.Range(lsp.Position(2, 9), lsp.Position(2, 9 + 2 + len(" on a stage")))


def test_definition_leads_to_where_a_thing_is_written(session: Session) -> None:
    spec = (session.folder / "cell.yaml").as_uri()
    assert session.definitions["device"] == (spec, _SPEC[: _SPEC.index("  stage: {")].count("\n"))
    assert session.definitions["owner"] == session.definitions["device"]
    urdf = session.folder / "stage" / "stage.urdf"
    written = urdf.read_text(encoding="utf-8").split("\n").index('  <link name="carriage"/>')
    assert session.definitions["link"] == (urdf.as_uri(), written)
    assert session.definitions["model"] == ((session.folder / "stage" / "device.yaml").as_uri(), 0)
    assert session.definitions["include"] == ((session.folder / "parts" / "hosts.yaml").as_uri(), 0)


def test_completion_knows_the_catalog_the_cell_and_the_keys(session: Session) -> None:
    told = session.completions
    assert {"ur5e", "franka_fr3"} <= set(told["model"])
    assert {"world", "tray", "stage/carriage"} <= set(told["frame"])
    assert {"joint_trajectory", "joint_state_broadcaster"} <= set(told["controller"])
    assert told["host"] == ["control_pc"]
    assert told["pose"] == ["home"]
    assert (
        told["word"] == ["multicast", "localhost", "off", "unicast", "discovery_server"] or "localhost" in told["word"]
    )
    assert told["key"][:2] == ["namespace", "host"]
    assert "update_rate" not in told["key"], "it is written already"


def test_quick_fixes_are_those_of_the_findings_and_mend_the_text(session: Session) -> None:
    fixes = [action.title for action in session.actions if not action.title.startswith("Ignore ")]
    assert fixes == ["desigend becomes designed", "hertz becomes Hz"]
    assert not {"unknown-key", "wrong-unit"} & {finding.code for finding in session.found_mended}


def test_what_may_be_excused_is_offered_a_comment_that_waits_for_its_reason(session: Session) -> None:
    offered = {edit.new_text for edit in _edits(session.excuses)}
    assert "  # cellc: ignore missing-rollback " in offered
    assert "unknown-stop-authority" in {finding.code for finding in session.found}
    assert not any("unknown-stop-authority" in text for text in offered), "nobody may excuse a stop without an owner"


def test_form_and_outline_are_told(session: Session) -> None:
    assert "\n  update_rate: 100 hertz\n" in session.formatted
    assert session.symbols[:3] == ["format", "cell", "summary"]


def test_server_ends_in_good_order(session: Session) -> None:
    assert session.code == 0


def _asked(stdin: IO[bytes], stdout: IO[bytes], number: int, method: str, params: object) -> dict[str, Any]:
    """Send a request as it goes over the wire, and return its answer."""
    body = json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}).encode()
    stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
    stdin.flush()
    while True:
        length = 0
        while (line := stdout.readline().strip()) or not length:
            length = int(line.partition(b":")[2]) if line.lower().startswith(b"content-length") else length
        told: dict[str, Any] = json.loads(stdout.read(length))
        if told.get("id") == number:
            return told


def test_what_cannot_be_answered_is_answered_all_the_same(tmp_path: Path) -> None:
    place = {"textDocument": {"uri": (tmp_path / "gone.yaml").as_uri()}, "position": {"line": 3, "character": 5}}
    with subprocess.Popen(
        [sys.executable, "-m", "cellc", "lsp"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    ) as process:
        too_late = threading.Timer(60, process.kill)
        too_late.start()
        stdin, stdout = process.stdin, process.stdout
        assert stdin is not None
        assert stdout is not None
        _asked(stdin, stdout, 1, "initialize", {"processId": None, "rootUri": None, "capabilities": {}})
        methods = ("hover", "definition", "completion", "documentSymbol", "formatting", "codeAction")
        whole = {"start": place["position"], "end": place["position"]}
        more = {
            "range": whole,
            "context": {"diagnostics": [], "triggerKind": 1},
            "options": {"tabSize": 2, "insertSpaces": True},
        }
        for number, method in enumerate(methods, start=2):
            told = _asked(stdin, stdout, number, f"textDocument/{method}", {**place, **more})
            assert not told.get("error"), method
            assert not told.get("result"), method
        # JSON-RPC 2.0, 5.1: -32602 is "Invalid method parameter(s)".
        told = _asked(stdin, stdout, 20, "textDocument/hover", {"textDocument": 5})
        assert told["error"]["code"] == -32602
        assert _asked(stdin, stdout, 21, "shutdown", None).get("error") is None
        stdin.close()
        process.wait()
        too_late.cancel()
