"""Reads rosbag2 bags, MCAP and sqlite3, split or cut off, message by message in the order of their arrival.

Bags are data of others: whatever is wrong with one ends in a line that says so, never in more memory than a chunk.
Formats: rosbag2 metadata.yaml up to version 9, MCAP 0.9.4 (mcap.dev/spec); the reader is rosbags 0.11.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from operator import attrgetter
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from cellc.contract.errors import CellcError, reason_of
from cellc.contract.extras import BAGS, gate
from cellc.contract.store.regular_file import open_regular

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.rosbag2 import Reader

_SUFFIXES = (".mcap", ".db3")
_LARGEST_RECORD = 1 << 28
"""Bytes of an MCAP record, such as a chunk, that are read into memory in one piece."""
_DAMAGE = Exception
"""What readers raise on damaged bytes: errors of their own, of SQLite, of compressors and of Python alike."""


class BagError(CellcError):
    """A bag cannot be read, or is no bag of this cell."""


@dataclass(frozen=True, slots=True)
class Definition:
    """A message type as a bag defines it: the text in the format ``msg`` or ``idl``; empty where the bag has none."""

    form: str
    text: str


@dataclass(frozen=True, slots=True)
class Raw:
    """A message as recorded: CDR bytes with their type and the time of arrival on the recording computer."""

    log_ns: int
    topic: str
    kind: str
    data: bytes


@dataclass(slots=True)
class _Part:
    """One file of a bag, or a whole bag whose files are compressed."""

    path: Path
    topics: dict[str, str]
    definitions: dict[str, Definition]
    reader: Reader | None
    size: int


@dataclass(slots=True)
class Bags:
    """Bags that are read as one.

    Attributes:
        topics: type of each topic.
        definitions: of the types, by name.
        identity: what the mock states of a bag of its own, by path: cell, configuration_id and more; empty elsewhere.
        notes: what could not be read, one line each.
    """

    parts: list[_Part]
    topics: dict[str, str] = field(default_factory=dict)
    definitions: dict[str, Definition] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    stack: ExitStack = field(default_factory=ExitStack)
    identity: dict[str, dict[str, str]] = field(default_factory=dict)

    def __enter__(self) -> Bags:
        return self

    def __exit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _at: TracebackType | None
    ) -> None:
        self.stack.close()

    def messages(self, topics: Mapping[str, str]) -> Iterator[Raw]:
        """Yield the messages of some topics, all parts merged by the time of arrival."""
        streams = [_guarded(part, topics, self.notes) for part in self.parts]
        yield from heapq.merge(*streams, key=attrgetter("log_ns"))


def open_bags(paths: tuple[Path, ...]) -> Bags:
    """Open bags: folders of rosbag2, or their files.

    Raises:
        BagError: there is no bag, or nothing of it can be read.
        MissingExtraError: the reader is not installed.
    """
    bags = Bags([])
    for path in paths:
        bags.parts += _parts(path, bags.notes, bags.stack)
    for part in bags.parts:
        for topic, kind in part.topics.items():
            if bags.topics.setdefault(topic, kind) != kind:
                bags.notes.append(f"{part.path.as_posix()}: topic `{topic}` is `{kind}`, before `{bags.topics[topic]}`")
        bags.definitions.update(part.definitions)
        bags.identity[part.path.as_posix()] = _identity(part.path)
    if not bags.topics:
        raise BagError("; ".join(bags.notes) or f"{paths[0].as_posix()}: holds no topic")
    return bags


def _parts(path: Path, notes: list[str], stack: ExitStack) -> list[_Part]:
    if not path.exists():
        raise BagError(f"{path.as_posix()}: no such file or folder; name a bag that `ros2 bag record` wrote")
    if not path.is_dir():
        if path.suffix not in _SUFFIXES:
            raise BagError(f"{path.as_posix()}: must be a folder of rosbag2, or a file .mcap or .db3")
        return _opened(path, notes, stack)
    files = sorted((each for each in path.iterdir() if each.suffix in _SUFFIXES and each.is_file()), key=_natural)
    if files:
        return [part for each in files for part in _opened(each, notes, stack)]
    if (path / "metadata.yaml").is_file():  # files compressed as a whole have another suffix
        return _opened(path, notes, stack)
    raise BagError(f"{path.as_posix()}: holds no file .mcap or .db3; name the folder that `ros2 bag record` wrote")


def _natural(path: Path) -> tuple[int, str]:
    """Order the files of a split bag by their number: bag_2 before bag_10."""
    number = path.stem.rpartition("_")[2]
    return (int(number) if number.isdecimal() and len(number) < 10 else -1, path.name)


def _opened(path: Path, notes: list[str], stack: ExitStack) -> list[_Part]:
    with gate(BAGS):
        from rosbags.rosbag2 import Reader
    try:
        if path.is_file():
            open_regular(path).close()
        reader = stack.enter_context(Reader(path))
        topics = {each.topic: each.msgtype for each in reader.connections}
        found = {each.msgtype: _definition(each) for each in reader.connections}
        size = path.stat().st_size
        return [_Part(path, topics, {kind: each for kind, each in found.items() if each.text}, reader, size)]
    except _DAMAGE as problem:
        why = reason_of(problem) if isinstance(problem, OSError) else str(problem) or type(problem).__name__
        if path.suffix == ".mcap":
            return _cut_off(path, why, notes)
        notes.append(f"{path.as_posix()}: cannot be read: {why}")
        return []


def _definition(connection: Connection) -> Definition:
    with gate(BAGS):
        from rosbags.interfaces import MessageDefinitionFormat
    form = "idl" if connection.msgdef.format == MessageDefinitionFormat.IDL else "msg"
    return Definition(form, connection.msgdef.data or "")


def _identity(path: Path) -> dict[str, str]:
    """Return the metadata record ``cellc`` at the begin of an MCAP file; empty where it has none."""
    with gate(BAGS):
        from mcap.records import ChunkIndex, Message, Metadata
        from mcap.stream_reader import StreamReader
    if path.suffix != ".mcap":
        return {}
    try:
        with open_regular(path) as file:
            for record in StreamReader(file, record_size_limit=_LARGEST_RECORD).records:
                if isinstance(record, Metadata) and record.name == "cellc":
                    return {str(name): str(value) for name, value in record.metadata.items()}
                if isinstance(record, (Message, ChunkIndex)):
                    break
    except _DAMAGE:
        pass
    return {}


def _cut_off(path: Path, why: str, notes: list[str]) -> list[_Part]:
    """Return what is readable of an MCAP file without a footer: its topics are found as they come."""
    topics: dict[str, str] = {}
    definitions: dict[str, Definition] = {}
    for raw, definition in _salvaged(path):
        topics[raw.topic] = raw.kind
        definitions[raw.kind] = definition
    if topics:
        notes.append(f"{path.as_posix()}: was cut off ({why}); the messages before that are read")
        return [_Part(path, topics, definitions, None, path.stat().st_size)]
    notes.append(f"{path.as_posix()}: cannot be read: {why}")
    return []


def _salvaged(path: Path) -> Iterator[tuple[Raw, Definition]]:
    """Yield messages from the begin of a file up to its first damage."""
    with gate(BAGS):
        from mcap.records import Channel, Message, Schema
        from mcap.stream_reader import StreamReader
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    try:
        with open_regular(path) as file:
            for record in StreamReader(file, record_size_limit=_LARGEST_RECORD).records:
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, Message):
                    channel = channels[record.channel_id]
                    schema = schemas[channel.schema_id]
                    form = "msg" if schema.encoding == "ros2msg" else "idl"
                    definition = Definition(form, schema.data.decode())
                    yield Raw(record.log_time, channel.topic, schema.name, record.data), definition
    except _DAMAGE:
        return


def _guarded(part: _Part, topics: Mapping[str, str], notes: list[str]) -> Iterator[Raw]:
    """Yield the messages of one part; damage ends it with a note."""
    if part.reader is None:
        yield from (raw for raw, _ in _salvaged(part.path) if topics.get(raw.topic) == raw.kind)
        return
    wanted = [each for each in part.reader.connections if topics.get(each.topic) == each.msgtype]
    if not wanted:
        return
    count = 0
    try:
        for connection, log_ns, data in part.reader.messages(wanted):
            count += 1
            yield Raw(log_ns, connection.topic, connection.msgtype, bytes(data))
    except _DAMAGE as problem:
        notes.append(f"{part.path.as_posix()}: is damaged after message {count}: {problem}")
