"""A viewer as Foxglove is one: subprotocol ``foxglove.sdk.v1`` over a web socket (RFC 6455), of the standard library.

https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md: text frames are JSON with `op`; a binary frame is 1, the
subscription as uint32, the log time as uint64 and the message, little endian.
"""

from __future__ import annotations

import base64
import json
import os
import socket
import struct
import threading
from collections.abc import Sequence
from typing import Any

_TEXT, _BINARY, _CLOSE = 1, 2, 8


class Viewer:
    """Subscribes to topics as they are advertised, and keeps what comes until the server ends."""

    def __init__(self, port: int, topics: Sequence[str] = ()) -> None:
        """Connect.

        Args:
            topics: to subscribe to; all where there are none.
        """
        self.server: dict[str, Any] = {}
        self.sessions = 0
        self.channels: dict[str, dict[str, Any]] = {}
        self.received: dict[str, list[tuple[int, bytes]]] = {}
        self._wanted = topics
        self._names: dict[int, str] = {}
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        self._stream = self._socket.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        lines = ("GET / HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade")
        more = (f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13", "Sec-WebSocket-Protocol: foxglove.sdk.v1")
        self._socket.sendall("\r\n".join((*lines, *more, "", "")).encode())
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def end(self) -> None:
        """Wait until the server has said that it ends."""
        self._thread.join(60)
        self._stream.close()
        self._socket.close()

    def _read(self) -> None:
        while self._stream.readline().strip():
            pass
        while len(head := self._stream.read(2)) == 2 and head[0] & 15 != _CLOSE:
            length = head[1] & 127
            if length >= 126:
                length = int.from_bytes(self._stream.read(2 if length == 126 else 8), "big")
            self._take(head[0] & 15, self._stream.read(length))

    def _take(self, kind: int, data: bytes) -> None:
        if kind == _BINARY:
            subscription, stamp_ns = struct.unpack_from("<xIQ", data)
            self.received.setdefault(self._names[subscription], []).append((stamp_ns, data[13:]))
        elif kind == _TEXT:
            told = json.loads(data)
            if told["op"] == "serverInfo":
                self.server, self.sessions = told, self.sessions + 1
            elif told["op"] == "advertise":
                self._subscribe(told["channels"])

    def _subscribe(self, channels: Sequence[dict[str, Any]]) -> None:
        self.channels.update({channel["topic"]: channel for channel in channels})
        chosen = [each for each in channels if not self._wanted or each["topic"] in self._wanted]
        self._names.update({each["id"]: each["topic"] for each in chosen})
        asked = [{"id": each["id"], "channelId": each["id"]} for each in chosen]
        text = json.dumps({"op": "subscribe", "subscriptions": asked}).encode()
        # A client masks what it sends; a mask of zeros is one.
        self._socket.sendall(struct.pack(">BBHI", 0x80 | _TEXT, 0x80 | 126, len(text), 0) + text)
