"""One rehearsal: its attempts with the steps of their packets, plots of its joints, ages and claims."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.contract.contract import Contract
from cellc.mock.evidence.trace.run_trace import TraceResult
from cellc.mock.report_page.age_plot import age_plot
from cellc.mock.report_page.attempts import attempts
from cellc.mock.report_page.claim_lanes import claims
from cellc.mock.report_page.content import RunEvidence
from cellc.mock.report_page.element import Child, tag
from cellc.mock.report_page.fault_times import fault_times
from cellc.mock.report_page.joint_plot import joint_plot
from cellc.mock.report_page.panel import TimeAxis
from cellc.mock.report_page.state_plot import state_plot


def run_section(number: int, run: RunEvidence, contract: Contract) -> Element:
    """Return the section of a rehearsal."""
    result = run.result
    verdict = "passed" if result.passed else "FAILED"
    title = tag(
        "h2",
        f"Rehearsal {result.name}",
        tag("span", f" {result.outcome}, {verdict}", class_="good" if result.passed else "bad"),
    )
    problems = [
        tag("p", f"{stage.stage}: {text}", class_="note") for stage in result.bringup for text in stage.problems
    ]
    findings = [tag("p", f"finding: {text}", class_="note") for text in result.findings]
    files = tag("p", "files: ", *_links(run.files), class_="hint")
    parts = [] if run.trace is None else list(_parts(run, run.trace, contract))
    return tag("section", title, files, *problems, *findings, *parts, id=f"run-{number}")


def _links(files: tuple[str, ...]) -> Iterator[Child]:
    for index, name in enumerate(files):
        yield ", " if index else ""
        # A name that looks like a scheme would lead elsewhere.
        yield tag("a", name, href=f"./{name.replace('%', '%25')}")


def _parts(run: RunEvidence, trace: TraceResult, contract: Contract) -> Iterator[Element]:
    time = _time_axis(run, trace)
    yield attempts(run.result.attempts, time)
    if trace.joints:
        yield tag("h3", "Command, state and error of each joint")
        yield tag("p", *_legend(), class_="hint legend")
        panels = [
            joint_plot(each, contract.joint_limits.get(each.joint), run.tolerances.get(each.joint), time)
            for each in trace.joints
        ]
        yield tag("div", *panels, class_="grid")
    if trace.states:
        yield tag("h3", "State of joints that no trajectory controller drives")
        panels = [state_plot(each, contract.joint_limits.get(each.joint), time) for each in trace.states]
        yield tag("div", *panels, class_="grid")
    if trace.ages:
        yield tag("h3", "Ages of messages and transforms")
        yield tag("div", *(age_plot(each, time) for each in trace.ages), class_="grid")
    yield from claims(trace, time)


def _time_axis(run: RunEvidence, trace: TraceResult) -> TimeAxis:
    spans = tuple((record.started_ns / 1e9, record.ended_ns / 1e9) for record in run.result.attempts[:-1])
    end_s = max(trace.ended_ns / 1e9, 1e-3)
    return TimeAxis(0.0, end_s, fault_times(run.entry.faults, run.result.attempts), spans)


def _legend() -> Iterator[Child]:
    for class_, words in (("command", "command"), ("state", "state"), ("error", "error = reference − state")):
        yield tag("span", class_=f"key {class_}")
        yield f"{words} "
    yield tag("span", class_="key limit")
    yield "limit or tolerance "
    yield tag("span", class_="key fault")
    yield "fault. Shaded: every other attempt. The bar at the right spans the limits; the thick part was used."
