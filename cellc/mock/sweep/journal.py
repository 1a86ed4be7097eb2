"""The runs of a sweep in a file, one line each as they end, so that an interrupted sweep goes on where it stopped."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

from cellc.mock.errors import MockError
from cellc.mock.sweep.sweep import GoalRoom, SweepRun
from cellc.store.regular_file import open_regular

_FORMAT = "cellc sweep 2"


class Journal:
    """A file of runs; used as a context. The first line says which sweep they are of.

    Attributes:
        runs: that stood there already, by number. A last line that was cut off is none.
    """

    def __init__(self, path: Path, configuration_id: str, rehearsal: str, seed: int) -> None:
        """Read what is there.

        Raises:
            MockError: the file cannot be read, or is of another sweep or of something else.
        """
        self.runs: dict[int, SweepRun] = {}
        self._path = path
        self._head = {"journal": _FORMAT, "configuration_id": configuration_id, "rehearsal": rehearsal, "seed": seed}
        self._kept = 0
        self._file: BinaryIO | None = None
        if path.is_symlink():
            raise MockError(path.as_posix(), "is a symbolic link; name the file itself")
        if path.exists():
            self._read()

    def _read(self) -> None:
        try:
            with open_regular(self._path) as file:
                lines = file.readlines()
        except OSError as error:
            raise self._unusable("read", error) from None
        whole = [line for line in lines if line.endswith(b"\n")]
        self._kept = sum(map(len, whole))
        try:
            head, *runs = map(json.loads, whole or [b"{}"])
            found = [_run(each) for each in runs]
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            head, found = None, []
        if whole and head != self._head:
            of = "of another sweep" if isinstance(head, dict) and head.get("journal") == _FORMAT else "no journal"
            raise MockError(self._path.as_posix(), f"is {of}; name another file, or move it away")
        self.runs = {run.number: run for run in found}

    def __enter__(self) -> Journal:
        try:
            self._file = self._path.open("r+b" if self._path.exists() else "w+b")
            self._file.truncate(self._kept)
            self._file.seek(self._kept)
            if not self._kept:
                self._write(self._head)
        except OSError as error:
            raise self._unusable("written", error) from None
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._file is not None:
            self._file.close()

    def keep(self, run: SweepRun) -> None:
        """Write a run that has ended.

        Raises:
            MockError: the file cannot be written.
        """
        try:
            self._write(asdict(run))
        except OSError as error:
            raise self._unusable("written", error) from None

    def _write(self, value: Mapping[str, object]) -> None:
        assert self._file is not None  # used as a context
        self._file.write(json.dumps(value, allow_nan=False, separators=(",", ":")).encode() + b"\n")
        self._file.flush()

    def _unusable(self, what: str, error: OSError) -> MockError:
        return MockError(self._path.as_posix(), f"cannot be {what}: {(error.strerror or 'unknown reason').lower()}")


def _run(line: Mapping[str, Any]) -> SweepRun:
    run = SweepRun(**{**line, "goals": {goal: GoalRoom(**room) for goal, room in line["goals"].items()}})
    if not isinstance(run.number, int):
        raise TypeError(line)
    return run
