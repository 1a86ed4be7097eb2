"""Evidence of the real cell, written once, and ways to read it with libraries that did not write it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from cellc.mock import MockCell, load
from cellc.mock.command.rehearsals import begin_evidence
from cellc.mock.result import RehearsalResult
from tests import cells


@dataclass(frozen=True)
class Written:
    """An evidence folder with the results that the runs returned."""

    folder: Path
    results: dict[str, RehearsalResult]

    def bag(self, rehearsal: str) -> Path:
        return self.folder / f"{rehearsal}.mcap"


@dataclass(frozen=True)
class Received:
    """A message as an independent reader decoded it."""

    log_ns: int
    message: Any


@pytest.fixture(scope="session")
def generated() -> Path:
    """The folder of cells/ur5e_pick; never changed."""
    return cells.generated("ur5e_pick")


@pytest.fixture(scope="session")
def cell(generated: Path) -> MockCell:
    return load(generated)


def write_evidence(cell: MockCell, folder: Path, *names: str, seed: int = 0) -> Written:
    chosen = names or cell.rehearsals
    with begin_evidence(cell, folder, chosen, seed) as collector:
        results = {name: collector.run(name) for name in chosen}
        collector.settle()
    return Written(folder, results)


@pytest.fixture(scope="session")
def written(cell: MockCell, tmp_path_factory: pytest.TempPathFactory) -> Written:
    """Evidence of every rehearsal of the cell; never changed."""
    return write_evidence(cell, tmp_path_factory.mktemp("evidence") / "runs")


def received(bag: Path, topic: str) -> Iterator[Received]:
    """Read a topic with rosbags, which knows the types from the definitions in the bag alone."""
    from rosbags.highlevel import AnyReader

    with AnyReader([bag]) as reader:
        connections = [connection for connection in reader.connections if connection.topic == topic]
        assert connections, f"{topic} is not in the bag"
        for connection, log_ns, data in reader.messages(connections):
            yield Received(log_ns, reader.deserialize(data, connection.msgtype))


def stamp_ns(header: Any) -> int:
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)
