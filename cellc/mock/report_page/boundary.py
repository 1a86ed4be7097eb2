"""The end of the page: gates, the versions that were judged, and what no mock can show."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from cellc.contract.contract import Contract
from cellc.mock.gates.gate import GateCheck, GateResult, Verdict
from cellc.mock.report_page.element import tag
from cellc.mock.report_page.figures import count

UNPROVEN = (
    (
        "Motion of the real arm",
        "friction, backlash, stiffness and tracking of the drives; the state follows the command",
    ),
    ("Payload", "mass, centre of mass and their effect on limits and stops"),
    ("Stopping", "distance and time of a protective or an emergency stop, and the stop path itself"),
    ("Vendor controller", "its modes, its safety functions, its own limits and the semantics of speed scaling"),
    ("Timing of the host", "latency and jitter of network, kernel, executor and middleware under load"),
    ("Perception", "calibration against the physical cell, exposure, lighting and recognition"),
    ("Contact", "grasp force, slip, collisions with what the model does not hold, cables and hoses"),
    ("People", "guards, the area, the observer and the procedure"),
)
"""After the limits that chapter 4 states of mock hardware (sections 8 and 13)."""
_MARKS = {Verdict.PASSED: "✓", Verdict.FAILED: "✗", Verdict.UNKNOWN: "?"}
_CLASSES = {Verdict.PASSED: "good", Verdict.FAILED: "bad", Verdict.UNKNOWN: "unknown"}


def gate_section(gates: Sequence[GateResult]) -> Element:
    """Return the checklists of the gates, each with its evidence; the last one stands open."""
    hint = (
        "Each line is judged by the runs of this call and by the generated folder. What they cannot show is UNKNOWN, "
        "with what would show it; no line says anything about hardware."
    )
    lists = [_gate(gate, open_=gate is gates[-1]) for gate in reversed(gates)]
    return tag("section", tag("h2", "Gates before hardware"), tag("p", hint, class_="hint"), *lists)


def _gate(gate: GateResult, *, open_: bool) -> Element:
    lines = count(len(gate.checks), "line")
    held = sum(check.verdict is Verdict.PASSED for check in gate.checks)
    verdict = tag("span", gate.verdict.value, class_=_CLASSES[gate.verdict])
    title = tag("summary", tag("b", f"{gate.gate} {gate.title} "), verdict, f", {held} of {lines} passed")
    rows = tag("ul", *(_check(check) for check in gate.checks), class_="checks")
    signed = tag(
        "p", f"State of the robot: {gate.state}. Signed by result: ", tag("code", gate.signature), class_="hint"
    )
    section = tag("details", title, rows, signed, class_="gate")
    if open_:
        section.set("open", "open")
    return section


def _check(check: GateCheck) -> Element:
    mark = tag("span", _MARKS[check.verdict], class_=f"mark {_CLASSES[check.verdict]}", title=check.verdict.value)
    evidence = [tag("small", text) for text in check.evidence]
    return tag("li", mark, tag("div", check.text, *evidence))


def unproven() -> Element:
    """Return what stays unproven however well the rehearsals ended."""
    rows = [tag("div", tag("dt", name), tag("dd", words)) for name, words in UNPROVEN]
    hint = (
        "It validates contracts between components. Each of these needs its own gate on the real cell, drives disabled "
        "first."
    )
    return tag(
        "section",
        tag("h2", "What the mock cannot prove"),
        tag("p", hint, class_="hint"),
        tag("dl", *rows, class_="pairs"),
    )


def identity(contract: Contract) -> Element:
    """Return the tuple of versions, what is not known of it first."""
    parts = sorted(contract.version_tuple.items(), key=lambda part: (part[1] != "UNKNOWN", part[0]))
    rows = [
        tag("div", tag("dt", name), tag("dd", version, class_="unknown" if version == "UNKNOWN" else "plain"))
        for name, version in parts
    ]
    missing = sum(version == "UNKNOWN" for _, version in parts)
    hint = (
        f"{count(missing, 'part')} of {len(parts)} UNKNOWN; gate G0 stops there."
        if missing
        else "All parts are pinned."
    )
    calibrations = [
        tag("div", tag("dt", f"calibration {name}"), tag("dd", f"revision {each.revision}, {each.owner}"))
        for name, each in sorted(contract.calibrations.items())
    ]
    return tag(
        "section",
        tag("h2", "Versions and calibrations"),
        tag("p", hint, class_="hint"),
        tag("dl", *calibrations, *rows, class_="pairs columns"),
    )
