"""The runs of a sweep in a file, one line each as they end, so that an interrupted sweep goes on where it stopped."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from cellc.contract.compute.versions import difference, versions
from cellc.contract.contract import Contract
from cellc.contract.errors import reason_of
from cellc.contract.limits import limits
from cellc.contract.store.regular_file import open_regular
from cellc.contract.store.swap import open_to_continue
from cellc.mock.errors import MockError
from cellc.mock.sweep.runs import GoalRoom, RunStore, SweepRun
from cellc.mock.sweep.sweep import MOST_DIGITS

_FORMAT = "cellc sweep 3"
_OF_ANY_VERSION = "cellc sweep "
_LONGEST_LINE = 1 << 20
"""A run takes about 1 kB."""
_AWAY = "name another file, or move it away"


class _Line(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True)


class _Room(_Line):
    distance_m: float = Field(ge=0.0)
    singular_value: float = Field(ge=0.0)
    joint_room: float | None
    clearance_m: float | None
    transform_age_s: float | None


class _Run(_Line):
    number: int = Field(ge=0, lt=10**MOST_DIGITS)
    outcome: str = Field(min_length=1)
    passed: bool
    goals: dict[str, _Room]
    joint_state_age_s: float | None
    digest: str = Field(min_length=1)

    def run(self) -> SweepRun:
        goals = {name: GoalRoom(**room.model_dump()) for name, room in self.goals.items()}
        return SweepRun(self.number, self.outcome, self.passed, goals, self.joint_state_age_s, self.digest)


class Journal:
    """A file of runs; used as a context. The first line says which sweep they are of, and what computed them.

    Attributes:
        runs: that are there already, by number. A last line that was cut off does not count.
    """

    def __init__(self, path: Path, contract: Contract, rehearsal: str, seed: int, masses: str = "") -> None:
        """Read what is there.

        Args:
            masses: what computes with them; empty where runs are without.

        Raises:
            MockError: the file cannot be read, is of another sweep or of something else, or a line of it is no run.
        """
        self.runs = RunStore()
        self._path = path
        self._head = {
            "journal": _FORMAT,
            "configuration_id": contract.configuration_id,
            "rehearsal": rehearsal,
            "seed": seed,
            "versions": dict(versions()),
            **({"masses": masses} if masses else {}),
        }
        self._goals = contract.goals
        self._kept = 0
        self._file: BinaryIO | None = None
        if path.is_symlink():
            raise MockError(path.as_posix(), "is a symbolic link; name the file itself")
        if path.exists():
            self._read()

    def _read(self) -> None:
        try:
            with open_regular(self._path) as file:
                self._take(self._lines(file))
        except OSError as error:
            raise self._unusable("read", error) from None

    def _lines(self, file: BinaryIO) -> Iterator[bytes]:
        """Yield the lines behind the head that are whole; one at a time, as the file may be of any size."""
        number = 0
        while line := file.readline(_LONGEST_LINE + 1):
            number += 1
            if len(line) > _LONGEST_LINE:
                raise self._refused(f"line {number} has more than {_LONGEST_LINE} bytes; {_AWAY}")
            if number > limits().sweep_runs + 1:
                raise self._refused(f"must have at most {limits().sweep_runs} runs")
            if not line.endswith(b"\n"):  # it was cut off as it was written
                if number == 1 and not _line(self._head).startswith(line):
                    raise self._refused(f"is not a journal; {_AWAY}")
                return
            self._kept += len(line)
            if number > 1:
                yield line
            elif problem := self._other_head(line):
                raise self._refused(f"{problem}; {_AWAY}")

    def _other_head(self, line: bytes) -> str:
        """Say what else a file is of than of this sweep; empty where it is of this one."""
        try:
            head = json.loads(line)
        except (ValueError, RecursionError):
            head = None
        name = head.get("journal") if isinstance(head, dict) else None
        if not isinstance(name, str) or not name.startswith(_OF_ANY_VERSION):
            return "is not a journal"
        if name != _FORMAT:
            return "was written by another version of cellc"
        there = head.get("versions")
        if head != self._head | {"versions": there}:
            return "belongs to another sweep"
        other = difference(there if isinstance(there, dict) else {})
        return f"has runs that were made with {other}" if other else ""

    def _take(self, lines: Iterable[bytes]) -> None:
        for number, line in enumerate(lines, start=2):
            try:
                run = _Run.model_validate_json(line).run()
            except ValidationError as invalid:
                raise self._refused(f"line {number} is not a run: {_first(invalid)}") from None
            unknown = next((name for name in run.goals if name not in self._goals), None)
            if unknown is not None:
                raise self._refused(f"line {number} is not a run of this cell: there is no goal `{unknown}`")
            if run.number not in self.runs:
                self.runs.add(run)
            elif self.runs[run.number] != run:
                raise self._refused(f"line {number} contradicts another line of run {run.number}")

    def __enter__(self) -> Journal:
        try:
            self._file = open_to_continue(self._path, self._kept)
            if not self._kept:
                self._write(self._head)
        except OSError as error:
            self._close()
            raise self._unusable("written", error) from None
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        problem = self._close()
        if problem is not None and error is None:
            raise self._unusable("written", problem)

    def _close(self) -> OSError | None:
        """Close the file, and return why what it still held could not be written; it is closed all the same."""
        try:
            if self._file is not None:
                self._file.close()
        except OSError as error:
            return error
        return None

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
        self._file.write(_line(value))
        self._file.flush()

    def _refused(self, reason: str) -> MockError:
        return MockError(self._path.as_posix(), reason)

    def _unusable(self, what: str, error: OSError) -> MockError:
        return self._refused(f"cannot be {what}: {reason_of(error)}")


def _line(value: Mapping[str, object]) -> bytes:
    return json.dumps(value, allow_nan=False, separators=(",", ":")).encode() + b"\n"


def _first(invalid: ValidationError) -> str:
    """Say what is wrong first: where, and what must be there."""
    error = invalid.errors(include_url=False, include_input=False)[0]
    where = ".".join(map(str, error["loc"]))
    said = error["msg"][:1].lower() + error["msg"][1:]
    return f"`{where}`: {said}" if where else said
