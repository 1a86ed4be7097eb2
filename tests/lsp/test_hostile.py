"""The language server against hostile files and messages: it answers what comes next, and shows text as text."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import IO, Any

import pytest

from tests.cells import ROOT
from tests.cli.hostile_cell import SPEC, new_cell


class _Server:
    """A server that was initialized."""

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        self.into: IO[bytes] = process.stdin
        self._messages: SimpleQueue[dict[str, Any] | None] = SimpleQueue()
        # All that the server says is read, as an editor does: it stops where nobody does.
        Thread(target=self._read, args=(process.stdout,), daemon=True).start()
        self._number = 0
        self.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})

    def frame(self, message: dict[str, Any]) -> None:
        content = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.into.write(b"Content-Length: %d\r\n\r\n%s" % (len(content), content))
        self.into.flush()

    def ask(self, method: str, params: dict[str, Any]) -> Any:
        """Return the result of a request."""
        self._number += 1
        self.frame({"id": self._number, "method": method, "params": params})
        while (told := self._next()).get("id") != self._number:
            pass
        return told["result"]

    def open(self, file: Path, text: str) -> None:
        item = {"uri": file.as_uri(), "languageId": "yaml", "version": 1, "text": text}
        self.frame({"method": "textDocument/didOpen", "params": {"textDocument": item}})

    def findings(self, uri: str) -> list[str]:
        """Return the codes that are published next of a document."""
        while True:
            told = self._next()
            if told.get("method") == "textDocument/publishDiagnostics" and told["params"]["uri"] == uri:
                return [diagnostic["code"] for diagnostic in told["params"]["diagnostics"]]

    def hover(self, file: Path, line: int, character: int) -> str:
        place = {"textDocument": {"uri": file.as_uri()}, "position": {"line": line, "character": character}}
        told = self.ask("textDocument/hover", place)
        return "" if told is None else str(told["contents"]["value"])

    def _next(self) -> dict[str, Any]:
        message = self._messages.get(timeout=120)
        assert message is not None, "the server ended"
        return message

    def _read(self, out: IO[bytes]) -> None:
        while header := out.readline():
            length = 0
            while header.strip():
                name, _, value = header.partition(b":")
                length = int(value) if name == b"Content-Length" else length
                header = out.readline()
            self._messages.put(json.loads(out.read(length)))
        self._messages.put(None)


@contextmanager
def _running(*options: str) -> Iterator[_Server]:
    """Start a server, and hold that it ends when its input does."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = (sys.executable, *options, "lsp")
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment
    ) as process:
        yield _Server(process)
        assert process.stdin is not None
        process.stdin.close()
        assert process.wait(20) == 0


@pytest.fixture(name="server", scope="module")
def server_fixture() -> Iterator[_Server]:
    """One server that is sent everything: what one test says must leave it able to answer the next."""
    with _running("-m", "cellc") as server:
        yield server


_IMAGE = "`![x](https://example.com/a.png)`"


def test_hover_shows_a_key_as_code_and_loads_nothing(server: _Server, tmp_path: Path) -> None:
    file = new_cell(tmp_path / "cell") / "cell.yaml"
    text = SPEC.replace("  table:", f"  '{_IMAGE}':")
    server.open(file, text)
    line = next(number for number, line in enumerate(text.split("\n")) if _IMAGE in line)
    # CommonMark 0.31, 6.1: a code span ends at as many backticks as it began with.
    assert f"**`` {_IMAGE} ``**" in server.hover(file, line, 5)


@pytest.mark.parametrize(
    "header",
    [
        b"Content-Length: " + b"9" * 5000 + b"\r\n\r\n",
        b"Content-Length: 20000000\r\n\r\n" + b" " * 20_000_000,
        b"X" * 1_000_000 + b"\r\n",
    ],
    ids=["no number", "too long", "long header"],
)
def test_message_beyond_a_bound_is_dropped_and_the_next_one_answered(
    header: bytes, server: _Server, tmp_path: Path
) -> None:
    server.into.write(header)
    server.open(tmp_path / "cell.yaml", "format: 1\n")
    assert "Version of this spec language" in server.hover(tmp_path / "cell.yaml", 0, 0)


def test_a_length_that_no_memory_holds_ends_nothing_with_a_bug() -> None:
    with _running("-m", "cellc") as server:
        server.into.write(b"Content-Length: 1000000000000\r\n\r\n")
        # The end of the input follows, after which the server must end well.


def test_a_zero_character_in_a_name_stops_no_check(server: _Server, tmp_path: Path) -> None:
    uri = (tmp_path / "a" / "cell.yaml").as_uri().replace("/a/", "/%00/")
    item = {"uri": uri, "languageId": "yaml", "version": 1, "text": SPEC}
    server.frame({"method": "textDocument/didOpen", "params": {"textDocument": item}})
    assert "unknown-model" in server.findings(uri.replace("%00", "%EF%BF%BD"))


_OF_THREE = """
from dataclasses import replace
from cellc.contract import limits
limits.raised = lambda given: replace(limits.DEFAULTS, open_documents=3)
from cellc.__main__ import main
main()
"""


def test_no_more_documents_are_kept_than_the_limit(tmp_path: Path) -> None:
    with _running("-c", _OF_THREE) as server:
        for number in range(3):
            server.open(tmp_path / f"{number}.yaml", "format: 1\n")
        assert server.hover(tmp_path / "2.yaml", 0, 0)
        server.open(tmp_path / "3.yaml", "format: 1\n")
        assert not server.hover(tmp_path / "3.yaml", 0, 0)
        assert server.hover(tmp_path / "0.yaml", 0, 0)
