"""The top of the page: what was run, how it ended, and the key figures against their targets."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from cellc.mock.evidence.kpis import Kpi
from cellc.mock.report_page.content import ReportContent, RunEvidence
from cellc.mock.report_page.element import tag
from cellc.mock.report_page.figures import count, plain, seconds

_NAMES = {
    "plan_to_execute_s": "plan to execute",
    "cancel_s": "cancel to hold",
    "missed_cycles": "missed cycles",
    "stale_state_rejection": "stale data rejected",
    "protective_stops": "protective stops",
    "recovery_time_s": "recovery time",
    "wrong_owner_events": "wrong-owner events",
}


def header(content: ReportContent) -> Element:
    """Return the title, the verdict and the identity of what was judged."""
    contract = content.contract
    passed = sum(run.result.passed for run in content.runs)
    good = 0 < passed == len(content.runs)
    verdict = tag(
        "p", _mark(good), f" {passed} of {count(len(content.runs), 'rehearsal')} ended as expected, within the bounds"
    )
    facts = [
        ("configuration", contract.configuration_id),
        ("ROS 2", contract.distro),
        ("seed", str(content.seed)),
        ("simulated", seconds(sum(run.result.sim_time_s for run in content.runs))),
    ]
    pairs = [tag("div", tag("dt", name), tag("dd", value)) for name, value in facts]
    return tag(
        "header",
        tag("p", "Rehearsed on the mock", class_="kicker"),
        tag("h1", contract.cell),
        tag("p", contract.summary, class_="summary"),
        verdict,
        tag("dl", *pairs, class_="facts"),
        *(tag("p", tag("b", "Note: "), note, class_="note") for note in content.notes),
    )


def outcomes(content: ReportContent) -> Element:
    """Return the matrix of rehearsals and their ends."""
    names = ("rehearsal", "verdict", "outcome", "expected", "injected", "response", "bound", "simulated")
    head = tag("tr", *(tag("th", name) for name in names))
    rows = [_outcome_row(number, run) for number, run in enumerate(content.runs, start=1)]
    table = tag("table", tag("thead", head), tag("tbody", *rows))
    return tag("section", tag("h2", "Outcomes"), tag("div", table, class_="wide"))


def _outcome_row(number: int, run: RunEvidence) -> Element:
    result = run.result
    faults = ", ".join(f"{fault.kind} {fault.target}" for fault in run.entry.faults) or "nothing"
    cells = [result.outcome, result.expected, faults]
    numbers = [seconds(result.response_s), seconds(result.within_s), seconds(result.sim_time_s)]
    return tag(
        "tr",
        tag("td", tag("a", result.name, href=f"#run-{number}")),
        tag("td", _mark(result.passed)),
        *(tag("td", cell) for cell in cells),
        *(tag("td", cell, class_="number") for cell in numbers),
    )


def key_figures(content: ReportContent) -> Element:
    """Return the seven figures of the checkpoint, one column each under its target, with one row a rehearsal."""
    title = tag("h2", "Key figures")
    runs = [run for run in content.runs if run.kpis]
    if not runs:
        return tag("section", title, tag("p", "No cell came up, so that nothing was measured.", class_="hint"))
    figures = runs[0].kpis
    names = tag("tr", tag("th", "rehearsal"), *(tag("th", _NAMES[figure.name]) for figure in figures))
    targets = tag("tr", tag("th", "target"), *(tag("th", _target(figure)) for figure in figures))
    table = tag("table", tag("thead", names, targets), tag("tbody", *(_figure_row(run) for run in runs)))
    hint = (
        "A target is for the cell in service. Where a rehearsal injects a fault, a missed target tells what the fault "
        "did, and is set in brackets; the rehearsal itself is judged above. – is what a run never came to."
    )
    bases = [tag("div", tag("dt", _NAMES[figure.name]), tag("dd", figure.basis)) for figure in figures]
    measured = tag("details", tag("summary", "What was measured"), tag("dl", *bases, class_="pairs"))
    return tag("section", title, tag("p", hint, class_="hint"), tag("div", table, class_="wide"), measured)


def _target(figure: Kpi) -> str:
    comparison = "≥" if figure.name == "stale_state_rejection" else "≤"
    return "none set" if figure.target is None else f"{comparison} {plain(figure.target, figure.unit)}"


def _figure_row(run: RunEvidence) -> Element:
    cells = [_figure(figure, injected=bool(run.entry.faults)) for figure in run.kpis]
    return tag("tr", tag("td", run.result.name), *cells)


def _figure(figure: Kpi, *, injected: bool) -> Element:
    text = "not held" if figure.value is None and figure.met is False else plain(figure.value, figure.unit)
    if figure.met is not False:
        return tag("td", text, class_="number")
    return tag("td", f"({text})", class_="number") if injected else tag("td", f"{text} ✗", class_="number bad")


def _mark(good: bool) -> Element:
    return tag("span", "✓ passed" if good else "✗ FAILED", class_="good" if good else "bad")
