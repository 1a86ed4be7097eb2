"""What the page draws of a bag: joints with command, state and error, ages, speed scaling, in bounded memory.

Each signal is kept as its least and greatest value in a slot of time; slots widen as a bag lasts.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from itertools import zip_longest

import numpy as np

from cellc.contract.contract import Contract
from cellc.mock.clocks import Clock, Segment
from cellc.mock.evidence.envelope import AgeBuilder, AgeTrace, Envelope, EnvelopeBuilder
from cellc.mock.evidence.run_trace import JointTrace, StateTrace
from cellc.mock.task.bounds import joint_state_age_s
from cellc.tools.attempt.heard import ControllerSample, Edges, Heard, JointSample, ObservedPose
from cellc.tools.attempt.topics import Sources

_PIECE = 256
_MOST_SIGNALS = 200
"""Joints, or streams, that are drawn; a cell has tens."""
_LONGEST_NS = 48 * 3600 * 1_000_000_000
"""What arrived later is not drawn: a bag of days is, but not a clock that jumps by years."""
_RECORDER = "the recording computer"
_NAN = float("nan")


@dataclass(frozen=True, slots=True)
class Signals:
    """Signals of a bag; times are counted from its begin, by the arrival on the recording computer.

    Attributes:
        scaling: speed scaling of each controller that states it, 0 to 1.
    """

    joints: tuple[JointTrace, ...]
    states: tuple[StateTrace, ...]
    scaling: tuple[StateTrace, ...]
    ages: tuple[AgeTrace, ...]


@dataclass(slots=True)
class _Signal:
    """Samples of some columns, put into the envelope by the piece."""

    builder: EnvelopeBuilder
    times: list[int] = field(default_factory=list)
    rows: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, at_ns: int, row: tuple[float, ...]) -> None:
        """Add a sample."""
        self.times.append(at_ns)
        self.rows.append(row)
        if len(self.times) >= _PIECE:
            self.flush()

    def flush(self) -> None:
        """Put what waits into the envelope."""
        if self.times:
            self.builder.add(np.array(self.times, dtype=np.int64), np.array(self.rows))
            self.times.clear()
            self.rows.clear()

    def columns(self) -> list[Envelope]:
        """Return the envelope of each column."""
        self.flush()
        whole = self.builder.envelope()
        return [
            Envelope(whole.width_ns, whole.starts_ns, whole.lowest[:, [at]], whole.highest[:, [at]])
            for at in range(whole.lowest.shape[1])
        ]


class SignalBuilder:
    """Takes the messages of a bag in the order of their arrival."""

    def __init__(self, contract: Contract, sources: Sources, sliding: Collection[str]) -> None:
        """Begin with nothing.

        Args:
            sliding: joints whose positions are lengths.
        """
        self._contract = contract
        self._sources = sources
        self._sliding = frozenset(sliding)
        self._joints: dict[tuple[str, str], _Signal] = {}
        self._states: dict[tuple[str, str], _Signal] = {}
        self._scaling: dict[tuple[str, str], _Signal] = {}
        self._ages: dict[str, AgeBuilder] = {}
        self._clock = Clock("recorder", "ros", (Segment(0, 0, 1.0),))

    def take(self, at_ns: int, topic: str, heard: Heard, begin_ns: int) -> None:
        """Take a message that arrived so long after the begin."""
        if not 0 <= at_ns <= _LONGEST_NS:
            return
        if isinstance(heard, ControllerSample):
            self._controller(at_ns, self._sources.states.get(topic, topic), heard)
        elif isinstance(heard, JointSample):
            for name, position in zip(heard.names, heard.positions.tolist(), strict=False):
                _add(self._states, (topic, name), at_ns, (position,))
            self._age(f"joint states on {topic}", at_ns, heard.stamp_ns - begin_ns, joint_state_age_s(self._contract))
        elif isinstance(heard, ObservedPose) and topic in self._sources.observations:
            frame, most_s = self._sources.observations[topic]
            self._age(f"observations of {frame}", at_ns, heard.stamp_ns - begin_ns, most_s)
        elif isinstance(heard, Edges) and topic == "/tf" and heard.edges:
            self._age("transforms of moving links", at_ns, min(ns for ns, _ in heard.edges) - begin_ns, None)

    def signals(self, end_ns: int) -> Signals:
        """Return everything, up to the end of the bag, counted from its begin."""
        for each in self._ages.values():
            each.advance(min(max(0, end_ns), _LONGEST_NS))
        followed = {joint for _, joint in self._joints}
        return Signals(
            tuple(self._joint(*key, signal) for key, signal in self._joints.items()),
            tuple(
                StateTrace(joint, topic, self._unit(joint), signal.columns()[0])
                for (topic, joint), signal in self._states.items()
                if joint not in followed
            ),
            tuple(
                StateTrace(name, controller, "of 1", signal.columns()[0])
                for (controller, name), signal in self._scaling.items()
            ),
            tuple(each.trace() for each in self._ages.values()),
        )

    def _joint(self, controller: str, joint: str, signal: _Signal) -> JointTrace:
        desired, actual, error = signal.columns()
        worst = max(abs(value) for value in error.extremes)
        return JointTrace(joint, controller, self._unit(joint), desired, actual, None, error, worst)

    def _unit(self, joint: str) -> str:
        return "m" if joint in self._sliding else "rad"

    def _controller(self, at_ns: int, controller: str, sample: ControllerSample) -> None:
        columns = (sample.reference.tolist(), sample.feedback.tolist(), sample.error.tolist())
        for joint, *values in zip_longest(sample.joints, *(each[: len(sample.joints)] for each in columns)):
            row = tuple(_NAN if value is None else value for value in values)
            _add(self._joints, (controller, str(joint)), at_ns, row)
        if sample.scaling is not None:
            _add(self._scaling, (controller, f"speed scaling of {controller}"), at_ns, (sample.scaling,))

    def _age(self, source: str, at_ns: int, stamp_ns: int, most_s: float | None) -> None:
        if source not in self._ages:
            if len(self._ages) >= _MOST_SIGNALS:
                return
            self._ages[source] = AgeBuilder(source, _RECORDER, self._clock, most_s)
        self._ages[source].sent(at_ns, stamp_ns)
        self._ages[source].advance(at_ns)


def _add(signals: dict[tuple[str, str], _Signal], key: tuple[str, str], at_ns: int, row: tuple[float, ...]) -> None:
    """Add a sample; where there are too many signals, as in a bag that is no cell's, of those before alone."""
    if key not in signals:
        if len(signals) >= _MOST_SIGNALS:
            return
        signals[key] = _Signal(EnvelopeBuilder(len(row)))
    signals[key].add(at_ns, row)
