"""A server whose client takes nothing ends when the system asks it to."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest


@pytest.mark.skipif(sys.platform != "linux", reason="what a process waits for is shown on Linux alone")
def test_a_server_that_is_blocked_in_a_write_ends_on_sigterm(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "cellc", "lsp"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as server:
        assert server.stdin is not None
        text = "format: 1\n" + "".join(f"k{number}: {{}}\n" for number in range(500))
        for number in range(20):
            opened = {"uri": f"file://{tmp_path}/{number}/cell.yaml", "languageId": "yaml", "version": 1, "text": text}
            for method, params in (
                ("initialize", {"processId": None, "rootUri": None, "capabilities": {}}),
                ("textDocument/didOpen", {"textDocument": opened}),
            )[number > 0 :]:
                message: dict[str, object] = {"jsonrpc": "2.0", "method": method, "params": params}
                asked = json.dumps(message | ({"id": 1} if method == "initialize" else {})).encode()
                server.stdin.write(b"Content-Length: %d\r\n\r\n" % len(asked) + asked)
                server.stdin.flush()
        end_s = time.monotonic() + 20
        while "pipe_write" not in _waits_for(server.pid) and time.monotonic() < end_s:
            time.sleep(0.1)
        os.kill(server.pid, signal.SIGTERM)
        try:
            assert server.wait(10) == 128 + signal.SIGTERM
        finally:
            server.kill()


def _waits_for(process: int) -> str:
    return Path(f"/proc/{process}/wchan").read_text(encoding="utf-8")
