"""The whole report, from what was run to what no mock can show."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element

from cellc.contract.contract import Contract
from cellc.contract.diagnostics.wording import count
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN
from cellc.mock.campaign.campaign import Campaign
from cellc.mock.campaign.plan import RunEnd
from cellc.mock.campaign.summary import Matrix, cell_text, legend, limit_lines, matrix_of, outcome_lines
from cellc.mock.evidence.kpis import TITLES, Kpi
from cellc.mock.gates.gate import GateCheck, GateResult, Tally, Verdict
from cellc.mock.report_page.html import (
    Child,
    breakable,
    cards,
    hint,
    pairs,
    plain,
    seconds,
    section,
    style,
    tag,
    to_page,
)
from cellc.mock.report_page.run_section import RunEvidence, run_section
from cellc.mock.report_page.sweep_section import sweep_section, sweep_verdict
from cellc.mock.result import simulated_s
from cellc.mock.sweep.sweep import Sweep

UNPROVEN = (
    (
        "Motion of the real arm",
        "friction, backlash, stiffness and tracking of the drives; the state follows the command",
    ),
    ("Payload", "mass, center of mass and their effect on limits and stops"),
    ("Stopping", "distance and time of a protective or an emergency stop, and the stop path itself"),
    ("Vendor controller", "its modes, its safety functions, its own limits and the semantics of speed scaling"),
    ("Timing of the host", "latency and jitter of network, kernel, executor and middleware under load"),
    ("Perception", "calibration against the physical cell, exposure, lighting and recognition"),
    ("Contact", "grasp force, slip, collisions with what the model does not hold, cables and hoses"),
    ("People", "guards, the area, the observer and the procedure"),
)
"""What mock hardware leaves out, each with its own gate on the real cell."""
_MARKS = {Verdict.PASSED: "✓", Verdict.FAILED: "✗", Verdict.UNKNOWN: "?"}
_CLASSES = {Verdict.PASSED: "good", Verdict.FAILED: "bad", Verdict.UNKNOWN: "unknown"}


@dataclass(frozen=True, slots=True)
class ReportContent:
    """All of one call.

    Attributes:
        notes: what is odd about the generated folder.
        seed: of everything that was drawn.
        campaign: every fault at every step; None where it was not run.
        sweeps: how often rehearsals succeeded where not everything is known exactly.
    """

    contract: Contract
    notes: tuple[str, ...]
    seed: int
    runs: tuple[RunEvidence, ...]
    gates: tuple[GateResult, ...]
    campaign: Campaign | None = None
    sweeps: tuple[Sweep, ...] = ()


def header(content: ReportContent) -> Element:
    """Return the title, the verdict and the identity of what was judged."""
    contract = content.contract
    ended = Tally.of(run.passed for run in content.runs)
    words = f" {ended.good} of {count(ended.total, 'rehearsal')} ended as expected, within the bounds"
    verdict = tag("p", _mark(ended.all_good), words)
    facts = [
        ("configuration", contract.configuration_id),
        ("ROS 2", contract.distro),
        ("seed", str(content.seed)),
    ]
    if content.runs or not content.sweeps:
        facts.append(("simulated", seconds(simulated_s(run.result for run in content.runs))))
    return tag(
        "header",
        tag("p", "Rehearsed on the mock", class_="kicker"),
        tag("h1", contract.cell),
        tag("p", contract.summary, class_="summary"),
        *(sweep_verdict(sweep) for sweep in content.sweeps),
        *(() if content.sweeps else (verdict,)),
        pairs(facts, "facts"),
        *(tag("p", tag("b", "Note: "), note, class_="note") for note in content.notes),
    )


def outcomes(content: ReportContent) -> Element:
    """Return the matrix of rehearsals and their ends."""
    names = ("rehearsal", "verdict", "outcome", "expected", "injected", "response", "bound", "simulated")
    rows = [_outcome_row(number, run) for number, run in enumerate(content.runs, start=1)]
    return section("Outcomes", cards(names, rows))


def _outcome_row(number: int, run: RunEvidence) -> tuple[Child, ...]:
    result = run.result
    faults = ", ".join(f"{fault.kind} {fault.target}" for fault in run.entry.faults) or "nothing"
    cells = [run.outcome, result.expected, faults]
    numbers = [seconds(result.response_s), seconds(result.within_s), seconds(result.sim_time_s)]
    return (
        tag("a", result.name, href=f"#run-{number}"),
        _mark(run.passed),
        *cells,
        *(tag("td", cell, class_="number") for cell in numbers),
    )


def key_figures(content: ReportContent) -> Element:
    """Return the seven figures of the checkpoint, one column each under its target, with one row a rehearsal."""
    title = "Key figures"
    runs = [run for run in content.runs if run.kpis]
    if not runs:
        return section(title, hint("No cell was brought up, so that nothing was measured."))
    figures = runs[0].kpis
    names = ("rehearsal", *(TITLES[figure.name] for figure in figures))
    targets = (tag("td", "target", class_="aim"), *(tag("td", _target(figure), class_="aim") for figure in figures))
    table = cards(names, (targets, *(_figure_row(run) for run in runs)))
    reading = (
        "A target is for the cell in service. Where a rehearsal injects a fault, a missed target tells what the fault "
        "did, and is set in brackets; the rehearsal itself is judged above. – is what a run never reached."
    )
    bases = pairs(((TITLES[figure.name], figure.basis) for figure in figures), "pairs")
    measured = tag("details", tag("summary", "What was measured"), bases)
    return section(title, hint(reading), table, measured)


def _target(figure: Kpi) -> str:
    comparison = "≥" if figure.name == "stale_state_rejection" else "≤"
    return "none set" if figure.target is None else f"{comparison} {plain(figure.target, figure.unit)}"


def _figure_row(run: RunEvidence) -> tuple[Child, ...]:
    return run.result.name, *(_figure(figure, injected=bool(run.entry.faults)) for figure in run.kpis)


def _figure(figure: Kpi, *, injected: bool) -> Element:
    text = "not held" if figure.value is None and figure.met is False else plain(figure.value, figure.unit)
    if figure.met is not False:
        return tag("td", text, class_="number")
    return tag("td", f"({text})", class_="number") if injected else tag("td", f"{text} ✗", class_="number bad")


def _mark(good: bool) -> Element:
    return tag("span", "✓ passed" if good else "✗ FAILED", class_="good" if good else "bad")


def campaign_section(campaign: Campaign | None) -> Iterator[Element]:
    """Yield the section, where a campaign was run."""
    if campaign is None:
        return
    ended = Tally.of(end.passed for end in campaign.all_ends)
    words = f" {ended.good} of {count(ended.total, 'run')} ended in a named outcome, within bounds and limits"
    verdict = tag("p", _mark(campaign.passed), words)
    matrices = [_table(matrix_of(baseline.run.entry, campaign.ends)) for baseline in campaign.baselines]
    lines = [tag("li", line.strip()) for line in (*outcome_lines(campaign.ends), *limit_lines(campaign.limits))]
    yield section(
        "Campaign",
        verdict,
        *_failures(campaign.failed),
        *matrices,
        tag("p", legend(campaign.ends), class_="hint legend"),
        tag("details", tag("summary", "Outcomes, bounds and limits"), tag("ul", *lines, class_="plain-list")),
    )


def _failures(failed: Sequence[RunEnd]) -> Iterator[Element]:
    if failed:
        rows = [tag("li", tag("code", end.run.identifier), f" {end.result.outcome}") for end in failed]
        yield tag("ul", *rows, class_="plain-list bad")


def _table(matrix: Matrix) -> Element:
    steps = [tag("th", tag("b", str(number)), f" {title}") for number, title in enumerate(matrix.steps, start=1)]
    head = tag("tr", tag("th", matrix.rehearsal), *steps)
    rows = [tag("tr", tag("td", breakable(fault)), *(_cell(cell) for cell in row)) for fault, row in matrix.rows]
    return tag("div", tag("table", tag("thead", head), tag("tbody", *rows), class_="matrix"), class_="wide")


def _cell(ends: Sequence[RunEnd]) -> Element:
    if not ends:
        return tag("td", "–")
    said = "; ".join(f"{end.run.identifier}: {end.result.outcome}" for end in ends)
    style = "bad" if not all(end.passed for end in ends) else "borne" if cell_text(ends) == "ok" else "ended"
    return tag("td", cell_text(ends), class_=style, title=said)


def gate_section(gates: Sequence[GateResult]) -> Element:
    """Return the checklists of the gates, each with its evidence; the last one is open."""
    reading = (
        "Each line is judged by the runs of this call and by the generated folder. What they cannot show is UNKNOWN, "
        "with what would show it; no line says anything about hardware."
    )
    lists = [_gate(gate, open_=gate is gates[-1]) for gate in reversed(gates)]
    return section("Gates before hardware", hint(reading), *lists)


def _gate(gate: GateResult, *, open_: bool) -> Element:
    held = gate.tally(Verdict.PASSED)
    text = f"{held.good} of {count(held.total, 'line')} passed"
    verdict = tag("span", gate.verdict.value, class_=_CLASSES[gate.verdict])
    title = tag("summary", tag("b", f"{gate.gate} {gate.title} "), verdict, f", {text}")
    rows = tag("ul", *(_check(check) for check in gate.checks), class_="checks")
    by = tag("code", gate.signature) if gate.signature else "not signed, because the folder was edited"
    signed = hint(f"State of the robot: {gate.state}. Digest of the result: ", by)
    details = tag("details", title, rows, signed, class_="gate")
    if open_:
        details.set("open", "open")
    return details


def _check(check: GateCheck) -> Element:
    mark = tag("span", _MARKS[check.verdict], class_=f"mark {_CLASSES[check.verdict]}", title=check.verdict.value)
    evidence = [tag("small", text) for text in check.evidence]
    return tag("li", mark, tag("div", check.text, *evidence))


def unproven() -> Element:
    """Return what stays unproven however well the rehearsals ended."""
    reading = (
        "It validates contracts between components. Each of these needs its own gate on the real cell, drives disabled "
        "first."
    )
    return section("What the mock cannot prove", hint(reading), pairs(UNPROVEN, "pairs"))


def identity(contract: Contract) -> Element:
    """Return the tuple of versions, what is not known of it first."""
    parts = sorted(contract.version_tuple.items(), key=lambda part: (part[1] != UNKNOWN, part[0]))
    rows = ((name, tag("dd", version, class_="unknown" if version == UNKNOWN else "plain")) for name, version in parts)
    known = Tally.of(version != UNKNOWN for _, version in parts)
    pinned = (
        f"{count(known.bad, 'part')} of {known.total} UNKNOWN; gate G0 stops there."
        if known.bad
        else "All parts are pinned."
    )
    calibrations = (
        (f"calibration {name}", f"revision {each.revision}, {each.owner}")
        for name, each in sorted(contract.calibrations.items())
    )
    return section("Versions and calibrations", hint(pinned), pairs((*calibrations, *rows), "pairs columns"))


def to_report(content: ReportContent) -> str:
    """Return the report of a call as one page; the same runs give the same bytes."""
    runs = [run_section(number, run, content.contract) for number, run in enumerate(content.runs, start=1)]
    main = tag(
        "main",
        header(content),
        *(sweep_section(sweep, content.contract) for sweep in content.sweeps),
        *((outcomes(content), key_figures(content)) if content.runs or not content.sweeps else ()),
        *campaign_section(content.campaign),
        gate_section(content.gates),
        *runs,
        identity(content.contract),
        unproven(),
        _colophon(),
    )
    return to_page(f"{content.contract.cell}: rehearsals on the mock", style(), tag("body", main))


def _colophon() -> Element:
    words = (
        "Times are simulated, counted from the start of the cell; no clock of the host enters this page, so the "
        "same folder and seed give the same bytes. Curves are drawn from the least and the greatest value in each "
        "column of the drawing, of all samples at the full rate: no extreme value is left out."
    )
    return tag("footer", tag("p", words))
