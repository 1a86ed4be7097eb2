"""The other side of a comparison where it is a file of records: JSON lines of the mock, or NAME.attempt.json.

Records have outcomes and times of their steps; following errors and figures are in bags alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict

from cellc.contract.attempt import PacketStep, TracePoint
from cellc.contract.contract import Contract
from cellc.contract.errors import reason_of
from cellc.contract.limits import limits, option
from cellc.contract.reading import FormatError, read_json
from cellc.contract.store.regular_file import FileTooLargeError, read_regular
from cellc.contract.vocabulary import AttemptOutcome
from cellc.tools.attempt.bag import BagError
from cellc.tools.attempt.record import Attempt, Report

SUFFIXES = (".jsonl", ".json")
_Unknown = Literal["UNKNOWN"]


class _Model(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


class _Point(_Model):
    step: PacketStep
    stamp_ns: int


class _Record(_Model):
    """One step, as far as it is compared."""

    attempt_id: str
    rehearsal: str | None = None
    step: str
    outcome: AttemptOutcome | _Unknown
    configuration_id: str
    controller_name: str | None = None
    started_ns: int | _Unknown | None = None
    ended_ns: int | _Unknown | None = None
    trace: tuple[_Point, ...] = ()


class _Document(_Model):
    """What `cellc attempt -o` writes."""

    attempts: tuple[_Record, ...]


def recorded_report(place: Path, contract: Contract, task: str | None) -> Report:
    """Return what a file of records says of the steps of a task.

    Args:
        task: rehearsal whose records are taken where the file has those of several.

    Raises:
        BagError: it is no such file, is of another configuration, or does not tell which rehearsal is meant.
    """
    records = _of_one(place, _read(place), task)
    for each in records:
        if each.configuration_id != contract.configuration_id:
            got = f"its configuration_id must be {contract.configuration_id}, got {each.configuration_id}"
            raise BagError(f"{place.as_posix()}: has no records of this package: {got}")
    attempts = tuple(map(_attempt, records))
    known = [at for each in attempts for at in (each.started_ns, each.ended_ns) if at is not None]
    begin_ns, end_ns = min(known, default=0), max(known, default=0)
    rehearsal = records[0].rehearsal
    return Report(contract, (place.as_posix(),), rehearsal, attempts, (), (), (), 0, begin_ns, end_ns)


def _read(place: Path) -> tuple[_Record, ...]:
    name = place.as_posix()
    try:
        text = read_regular(place, limits().folder_bytes).decode("utf-8")
        if place.suffix == ".json":
            return read_json(text, _Document).attempts
        return tuple(read_json(line, _Record) for line in text.split("\n") if line.strip())
    except FileTooLargeError as problem:
        raise BagError(f"{name}: {problem.strerror}; {option('folder-bytes')}") from None
    except OSError as problem:
        raise BagError(f"{name}: cannot be read: {reason_of(problem)}") from None
    except UnicodeDecodeError:
        raise BagError(f"{name}: must be text in UTF-8") from None
    except FormatError as problem:
        raise BagError(f"{name}: is no file of records: {problem}") from None


def _of_one(place: Path, records: Sequence[_Record], task: str | None) -> Sequence[_Record]:
    """Return the records of one task: `cellc mock --records` writes those of all rehearsals into one file."""
    of = {each.rehearsal: [other for other in records if other.rehearsal == each.rehearsal] for each in records}
    if len(of) > 1 and task in of:
        return of[task]
    if len(of) > 1:
        raise BagError(f"{place.as_posix()}: has records of {len(of)} rehearsals; name one with --task")
    if not records:
        raise BagError(f"{place.as_posix()}: has no records")
    return records


def _attempt(record: _Record) -> Attempt:
    return Attempt(
        attempt_id=record.attempt_id,
        rehearsal=None,
        step=record.step,
        outcome=None if record.outcome == "UNKNOWN" else record.outcome,
        configuration_id=record.configuration_id,
        version_tuple={},
        controller_name=record.controller_name,
        started_ns=None if record.started_ns == "UNKNOWN" else record.started_ns,
        ended_ns=None if record.ended_ns == "UNKNOWN" else record.ended_ns,
        trace=tuple(TracePoint(each.step, each.stamp_ns) for each in record.trace),
    )
