"""Gates for people and for programs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.mock.gates.gate import GateResult, Verdict

_LABELS = {Verdict.PASSED: "passed ", Verdict.FAILED: "FAILED ", Verdict.UNKNOWN: "UNKNOWN"}


def gate_lines(gates: Sequence[GateResult]) -> Iterator[str]:
    """Yield each gate with its lines, their evidence below."""
    for gate in gates:
        counts = ", ".join(
            f"{sum(check.verdict is verdict for check in gate.checks)} {verdict.value}" for verdict in Verdict
        )
        yield f"{gate.gate} {gate.title} ({gate.state}): {gate.verdict.value}; {counts}"
        for check in gate.checks:
            yield f"  {_LABELS[check.verdict]}  {check.text}"
            prefix = "needs " if check.verdict is Verdict.UNKNOWN else ""
            yield from (f"             {prefix}{line}" for line in check.evidence)
        yield f"  signed by result: {gate.configuration_id}, seed {gate.seed}, {gate.signature}"
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
