"""The record of an attempt as a bag shows it: each field known, or UNKNOWN with why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from enum import Enum
from typing import TYPE_CHECKING

from cellc.contract.attempt import AttemptFields, CancelRecord, Layer, ResultRecord, TracePoint
from cellc.contract.contract import Contract
from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.vocabulary import AttemptOutcome

if TYPE_CHECKING:
    from cellc.tools.attempt.compare import Comparison
    from cellc.tools.attempt.measures import Measure
    from cellc.tools.attempt.signals import Signals

UNKNOWN = "UNKNOWN"
JOINT = "rad or m"
"""Unit of a joint whose kind does not matter."""


@dataclass(frozen=True, slots=True)
class Finding:
    """The layer in which an attempt failed, with the message that shows it.

    Attributes:
        outcome: as the mock names it; None where the bag does not tell.
        at_ns: time of arrival of that message.
        source: topic, or topics, that showed it.
        message: what was said, or seen.
    """

    layer: Layer
    outcome: AttemptOutcome | None
    at_ns: int
    source: str
    message: str


@dataclass(slots=True, kw_only=True)
class Attempt(AttemptFields[None]):
    """One attempt as bags show it.

    A field that is None is nothing where ``unknown`` does not name it; else ``unknown`` says what would have to be
    recorded.
    """

    finding: Finding | None = None
    unknown: dict[str, str] = field(default_factory=dict)

    def lack(self, name: str, needed: str) -> None:
        """Note that a field is UNKNOWN, and what would have to be recorded."""
        self.unknown[name] = needed


@dataclass(frozen=True, slots=True)
class Figure:
    """A key figure with its unit; None where nothing of the bag shows it."""

    name: str
    unit: str
    value: float | None
    target: float | None


@dataclass(frozen=True, slots=True)
class Report:
    """All that some bags show.

    Attributes:
        task: name of the rehearsal whose steps were taken for those of the task; None where none was.
        notes: what could not be read.
        missing: topics of the cell that were not recorded.
        signals: None where they were not asked for.
        measures: figures for the spec; empty where they were not asked for.
        errors: largest following error of each goal whose controller tells its state, rad or m, by its id.
        comparison: with a rehearsal, where one was named.
    """

    contract: Contract
    bags: tuple[str, ...]
    task: str | None
    attempts: tuple[Attempt, ...]
    figures: tuple[Figure, ...]
    notes: tuple[str, ...]
    missing: tuple[str, ...]
    messages: int
    begin_ns: int
    end_ns: int
    signals: Signals | None = None
    measures: tuple[Measure, ...] = ()
    errors: Mapping[str, float] = field(default_factory=dict)
    comparison: Comparison | None = None

    @property
    def end(self) -> Attempt:
        """The attempt that sums up."""
        return self.attempts[-1]

    def since_begin_s(self, at_ns: int) -> float:
        """Return an instant in s from the begin of the bag on."""
        return (at_ns - self.begin_ns) / 1e9

    def span_s(self, attempt: Attempt) -> tuple[float, float] | None:
        """Return begin and end of an attempt, as far as the bag shows them, in s from its begin on."""
        known = [at for at in (attempt.started_ns, attempt.ended_ns, *attempt.stamps.values()) if at is not None]
        begin = attempt.started_ns if attempt.started_ns is not None else min(known, default=None)
        end = attempt.ended_ns if attempt.ended_ns is not None else max(known, default=None)
        return None if begin is None or end is None else (max(0.0, self.since_begin_s(begin)), self.since_begin_s(end))


def to_json(report: Report) -> str:
    """Return the report as JSON, with the word UNKNOWN in each place that the bag does not show."""
    return json_document(
        {
            "format": 1,
            "cell": report.contract.cell,
            "configuration_id": report.contract.configuration_id,
            "bags": list(report.bags),
            "task": report.task,
            "begin_ns": report.begin_ns,
            "end_ns": report.end_ns,
            "messages": report.messages,
            "outcome": report.end.outcome or UNKNOWN,
            "attempts": [_plain_attempt(each) for each in report.attempts],
            "figures": [_plain(each) for each in report.figures],
            "notes": list(report.notes),
            "missing_topics": list(report.missing),
            **({} if report.comparison is None else {"comparison": asdict(report.comparison)}),
        }
    )


def _plain_attempt(attempt: Attempt) -> dict[str, object]:
    named = {each.name: _plain(getattr(attempt, each.name)) for each in fields(attempt)}
    return {name: UNKNOWN if value is None and name in attempt.unknown else value for name, value in named.items()}


def _plain(value: object) -> object:
    """Return a value of dataclasses as what JSON has."""
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (Figure, Finding, CancelRecord, ResultRecord, TracePoint)):
        return {each.name: _plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return dict(value) if isinstance(value, Mapping) else value
