"""``cellc mock --live``: each rehearsal is shown in Foxglove at the pace of a clock, with the messages of its bag.

The server is that of the Foxglove SDK (github.com/foxglove/foxglove-sdk, 0.30). It offers no capability, so a viewer
can neither publish nor call nor set anything. A rehearsal executes in a fraction of its time: it is executed first and
shown afterwards, so a viewer cannot slow it down or change it.
"""

from __future__ import annotations

import signal
import threading
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from ipaddress import ip_address
from time import monotonic, perf_counter, sleep
from typing import TYPE_CHECKING, Any, BinaryIO

import foxglove
import foxglove.channels
import foxglove.messages
from mcap.reader import make_reader

from cellc.contract.printing import Stream, show
from cellc.contract.rehearsals import RehearsalEntry
from cellc.contract.signals import Stopped
from cellc.contract.store.swap import temporary_file
from cellc.mock.cell import MockCell
from cellc.mock.command.evidence import recorded
from cellc.mock.errors import MockError
from cellc.mock.evidence.fault_times import fault_times
from cellc.mock.evidence.images.photographer import Album, Photographer, Shot
from cellc.mock.evidence.topics import LOG
from cellc.mock.result import RehearsalResult
from cellc.robot.description.yaml_values import load_values

if TYPE_CHECKING:
    from mcap.records import Channel as BagChannel
    from mcap.records import Schema as BagSchema

_TRANSIENT_LOCAL = 1
_KEPT_FOR_A_SLOW_VIEWER = 100_000
"""Messages; a second of a cell with 500 Hz has some 2,000."""
_QUIET_S = 0.2
"""A viewer has subscribed to what it wants where it asks for nothing more for so long."""
_LAST_S = 0.5
"""Left to the network for what was sent last, before the server ends."""
_LAST_PORT = 65535
_LATE_S = 0.2


@contextmanager
def live_view(address: str, speed: float) -> Iterator[LiveView]:
    """Give a view that shows rehearsals, at an address such as ``127.0.0.1:8765``.

    Raises:
        MockError: the text is not an address.
    """
    host, _, port = address.rpartition(":")
    if not host or not port.isdigit() or int(port) > _LAST_PORT:
        raise MockError("", f"`--listen` must be HOST:PORT, got `{address}`")
    view = LiveView(host.strip("[]"), int(port), speed)
    try:
        yield view
        sleep(_LAST_S)
    finally:
        view.end()


class LiveView:
    """What is shown, and to whom; one rehearsal after the other."""

    def __init__(self, host: str, port: int, speed: float) -> None:
        """Make ready to show time ``speed`` times as fast as it is."""
        self._address = (host, port)
        self._speed = speed
        self._context = foxglove.Context()
        self._log = foxglove.channels.LogChannel(LOG, context=self._context)
        self._channels: dict[str, Any] = {}
        self._latched: dict[str, tuple[bytes, int]] = {}
        self._asked = threading.Event()
        self._wanted: dict[str, int] = {}
        """Viewers of each topic."""
        self._server: Any = None
        self.executed_s = 0.0
        """What the last rehearsal needed to be executed; waiting for a viewer and showing it are no part of that."""

    def stay(self) -> None:
        """Keep what was shown last for those who watch, until Ctrl-C; another signal ends the program as ever."""
        if self._server is None:
            return
        show("all was shown; Ctrl-C ends", to=Stream.ERR)
        try:
            while True:
                sleep(_LAST_S)
        except KeyboardInterrupt:
            return
        except Stopped as stop:
            if stop.number != signal.SIGINT:
                raise

    def end(self) -> None:
        """Close every connection."""
        if self._server is not None:
            self._server.stop()

    def on_subscribe(self, client: object, channel: Any) -> None:
        """Give who comes late what a latched topic holds; called by the server."""
        self._wanted[channel.topic] = self._wanted.get(channel.topic, 0) + 1
        held = self._latched.get(channel.topic)
        if held is not None:
            self._channels[channel.topic].log(held[0], log_time=held[1])
        self._asked.set()

    def on_unsubscribe(self, client: object, channel: Any) -> None:
        """Draw no more images of a topic without viewers; called by the server."""
        self._wanted[channel.topic] = self._wanted.get(channel.topic, 1) - 1

    def run(self, cell: MockCell, name: str, seed: int) -> RehearsalResult:
        """Execute a rehearsal, and show it to its end.

        Raises:
            MockError: it names what the contract does not have.
        """
        entry = cell.entry(name)
        with temporary_file() as file:
            start_s = perf_counter()
            albums: list[Album] = []
            result, _ = recorded(cell, entry, file, seed, albums=albums)
            self.executed_s = perf_counter() - start_s
            file.seek(0)
            self._show(file, entry, result, albums[0] if albums else None)
        return result

    def _show(self, file: BinaryIO, entry: RehearsalEntry, result: RehearsalResult, album: Album | None) -> None:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert summary is not None  # we wrote it
        for channel in summary.channels.values():
            self._declare(channel, summary.schemas[channel.schema_id])
        if self._server is None:
            self._serve()
            self._await_viewer()
        else:
            self._server.clear_session()  # time starts again
        latched = {channel.topic for channel in summary.channels.values() if _is_latched(channel.metadata)}
        lines = _log_lines(entry, result)
        start, first_ns = monotonic(), None
        shots = deque(() if album is None else album.shots)
        for _, channel, message in reader.iter_messages():
            first_ns = message.log_time if first_ns is None else first_ns
            while lines and lines[0][0] <= message.log_time:
                self._say(*lines.pop(0))
            early_s = start + (message.log_time - first_ns) / 1e9 / self._speed - monotonic()
            while album is not None and shots and shots[0][0] <= message.log_time:
                at_ns, shot = shots.popleft()
                if early_s > -_LATE_S:  # one that is late is not drawn, so that the rest is not late too
                    self._draw(album.photographer, shot, at_ns)
            sleep(max(0.0, start + (message.log_time - first_ns) / 1e9 / self._speed - monotonic()))
            if channel.topic in latched:
                self._latched[channel.topic] = (message.data, message.log_time)
            self._channels[channel.topic].log(message.data, log_time=message.log_time)
        for each in lines:
            self._say(*each)

    def _draw(self, photographer: Photographer, shot: Shot, at_ns: int) -> None:
        """Draw an image for those who look at it; of each camera only the topics that somebody has asked for."""
        for stream in photographer.streams[shot.device]:
            for topic in (stream.topic, stream.info_topic):
                if self._wanted.get(topic, 0) > 0:
                    self._channels[topic].log(photographer.message(topic, shot), log_time=at_ns)

    def _serve(self) -> None:
        """Begin to listen, once the topics are known: who connects learns of them all together."""
        host, port = self._address
        try:
            self._server = foxglove.start_server(
                name="cellc mock",
                host=host,
                port=port,
                capabilities=[],
                server_listener=self,
                context=self._context,
                message_backlog_size=_KEPT_FOR_A_SLOW_VIEWER,
            )
        except (OSError, RuntimeError) as error:
            reason = str(error).removeprefix("FoxgloveError: ").lower()
            raise MockError("", f"nothing can listen at {host}:{port}: {reason}") from None
        shown = f"[{host}]" if ":" in host else host
        show(f"live at ws://{shown}:{self._server.port}: it begins when Foxglove opens that", to=Stream.ERR)
        if not _is_loopback(host):
            show("note: every host that reaches this address can watch", to=Stream.ERR)

    def _await_viewer(self) -> None:
        """Wait until somebody has subscribed to all that they want, each topic by itself."""
        self._asked.wait()
        while self._asked.is_set():
            self._asked.clear()
            sleep(_QUIET_S)

    def _declare(self, channel: BagChannel, schema: BagSchema) -> None:
        if channel.topic not in self._channels:
            definition = foxglove.Schema(name=schema.name, encoding=schema.encoding, data=schema.data)
            self._channels[channel.topic] = foxglove.Channel(
                channel.topic, schema=definition, message_encoding=channel.message_encoding, context=self._context
            )

    def _say(self, at_ns: int, level: str, name: str, words: str) -> None:
        messages = foxglove.messages
        stamp = messages.Timestamp(sec=at_ns // 1_000_000_000, nsec=at_ns % 1_000_000_000)
        level = getattr(messages.LogLevel, level)
        self._log.log(messages.Log(timestamp=stamp, level=level, name=name, message=words), log_time=at_ns)


def _log_lines(entry: RehearsalEntry, result: RehearsalResult) -> list[tuple[int, str, str, str]]:
    """Return what is said when: in ns, with its level and who it is about."""
    said = [(0, "Info", entry.name, f"it must end with {entry.expect}")]
    for start_s, fault in fault_times(entry.faults, result.attempts):
        said.append((round(start_s * 1e9), "Warning", entry.name, f"fault: {fault.kind} of {fault.target}"))
    for record in result.attempts:
        level = "Info" if record.outcome == "succeeded" else "Error"
        words = f"{record.step}: {record.outcome}"
        said.append(
            (record.ended_ns, level, entry.name, f"{words}: {record.fault_code}" if record.fault_code else words)
        )
    return sorted(said, key=lambda one: one[0])


def _is_latched(metadata: Mapping[str, str]) -> bool:
    profiles = load_values(metadata["offered_qos_profiles"])
    return any(profile["durability"] == _TRANSIENT_LOCAL for profile in profiles)


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
