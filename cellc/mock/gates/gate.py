"""A gate with the verdict of each of its lines, for people and for programs."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from enum import Enum

from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN, GateCode

_SHOWN = 3
"""Pieces of evidence that a line names; the rest is counted."""


class Verdict(str, Enum):
    """What the evidence says of a line, or of a gate."""

    PASSED = "passed"
    FAILED = "failed"
    UNKNOWN = "UNKNOWN"


@dataclass(frozen=True, slots=True)
class Tally:
    """How many of several are good."""

    good: int
    total: int

    @classmethod
    def of(cls, each: Iterable[bool]) -> Tally:
        """Count what is good, and all."""
        listed = tuple(each)
        return cls(sum(listed), len(listed))

    @property
    def all_good(self) -> bool:
        """Whether there is any, and none is bad."""
        return 0 < self.good == self.total

    @property
    def bad(self) -> int:
        """How many are not good."""
        return self.total - self.good


@dataclass(frozen=True, slots=True)
class GateCheck:
    """One line of a checklist.

    Attributes:
        text: what has to be so.
        evidence: runs and facts that it is judged by; where it is UNKNOWN, what would show it.
    """

    text: str
    verdict: Verdict
    evidence: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class GateResult:
    """A gate as far as the mock can judge it.

    Attributes:
        gate: L6, G1, G2, or S2 for the interface checklist.
        state: state of the robot that the gate is for.
        configuration_id: configuration that was judged.
        seed: of the runs that are the evidence.
        signed: False for a folder that is not the one that was generated: it is no configuration.
    """

    gate: GateCode
    title: str
    state: str
    configuration_id: str
    seed: int
    checks: tuple[GateCheck, ...]
    signed: bool = True

    @property
    def verdict(self) -> Verdict:
        """Failed where a line failed, UNKNOWN where one is, else passed."""
        verdicts = {check.verdict for check in self.checks}
        for verdict in (Verdict.FAILED, Verdict.UNKNOWN):
            if verdict in verdicts or not verdicts:
                return verdict
        return Verdict.PASSED

    def tally(self, verdict: Verdict) -> Tally:
        """Return how many lines have a verdict."""
        return Tally.of(check.verdict is verdict for check in self.checks)

    @property
    def signature(self) -> str | None:
        """A digest over everything the result says: another line, run or configuration gives another one."""
        if not self.signed:
            return None
        text = repr((self.gate.value, self.title, self.state, self.configuration_id, self.seed, self.checks))
        return f"sha256:{hashlib.sha256(text.encode()).hexdigest()}"

    @property
    def signed_by(self) -> str:
        """By what it is signed, in words."""
        if not self.signed:
            return f"not signed: {self.configuration_id}, the folder differs from its manifest"
        return f"digest of the result: {self.configuration_id}, seed {self.seed}, {self.signature}"


def passed(text: str, evidence: Iterable[str]) -> GateCheck:
    """Return a line that the evidence confirms."""
    return GateCheck(text, Verdict.PASSED, _shortened(tuple(evidence)))


def failed(text: str, evidence: Iterable[str]) -> GateCheck:
    """Return a line that the evidence contradicts."""
    return GateCheck(text, Verdict.FAILED, _shortened(tuple(evidence)))


def unknown(text: str, needed: str) -> GateCheck:
    """Return a line that nothing here can judge, with what would."""
    return GateCheck(text, Verdict.UNKNOWN, (needed,))


def judged(text: str, good: Sequence[str], bad: Sequence[str], needed: str) -> GateCheck:
    """Return a line that one piece of evidence against it fails, and that needs at least one for it."""
    if bad:
        return failed(text, bad)
    return passed(text, good) if good else unknown(text, needed)


def _shortened(evidence: tuple[str, ...]) -> tuple[str, ...]:
    rest = len(evidence) - _SHOWN
    return evidence if rest <= 1 else (*evidence[:_SHOWN], f"and {rest} more")


_LABELS = {Verdict.PASSED: "passed ", Verdict.FAILED: "FAILED ", Verdict.UNKNOWN: UNKNOWN}


def gate_lines(gates: Sequence[GateResult]) -> Iterator[str]:
    """Yield each gate with its lines, their evidence below."""
    for gate in gates:
        counts = ", ".join(f"{gate.tally(verdict).good} {verdict.value}" for verdict in Verdict)
        yield f"{gate.gate} {gate.title} ({gate.state}): {gate.verdict.value}; {counts}"
        for check in gate.checks:
            yield f"  {_LABELS[check.verdict]}  {check.text}"
            prefix = "needs " if check.verdict is Verdict.UNKNOWN else ""
            yield from (f"             {prefix}{line}" for line in check.evidence)
        yield f"  {gate.signed_by}"
        yield ""


def gates_as_data(gates: Sequence[GateResult]) -> list[dict[str, object]]:
    """Return the gates as data for JSON."""
    return [
        {
            "gate": gate.gate,
            "title": gate.title,
            "state": gate.state,
            "verdict": gate.verdict.value,
            "configuration_id": gate.configuration_id,
            "seed": gate.seed,
            "signature": gate.signature,
            "checks": [
                {"text": check.text, "verdict": check.verdict.value, "evidence": list(check.evidence)}
                for check in gate.checks
            ],
        }
        for gate in gates
    ]
