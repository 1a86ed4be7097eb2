"""One rehearsal on the page: its attempts with the steps of their packets, plots, ages and claims."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any
from xml.etree.ElementTree import Element

from cellc.contract.attempt import AttemptFields, AttemptRecord, MadeStep, PacketStep
from cellc.contract.contract import Contract
from cellc.contract.diagnostics.wording import count
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import RehearsalEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.evidence.fault_times import fault_times
from cellc.mock.evidence.kpis import Kpi
from cellc.mock.evidence.run_trace import Claim, StateChange, TraceResult
from cellc.mock.report_page.axes import TimeAxis, ticks
from cellc.mock.report_page.html import Child, at, breakable, cards, hint, seconds, tag
from cellc.mock.report_page.plots import plots
from cellc.mock.result import Contact, RehearsalResult
from cellc.mock.sweep.runs import SweepRun


@dataclass(frozen=True, slots=True)
class RunEvidence:
    """What the report knows of one rehearsal; the trace is None where a controller manager never started.

    Attributes:
        tolerances: path tolerance of each joint that has one, rad or m.
        files: names of the files beside the report.
        swept: the run of a sweep that was made again; it may have missed a goal that the robot believed it reached.
    """

    entry: RehearsalEntry
    result: RehearsalResult
    trace: TraceResult | None
    kpis: tuple[Kpi, ...]
    tolerances: Mapping[str, float]
    files: tuple[str, ...]
    swept: SweepRun | None = None

    @property
    def outcome(self) -> str:
        """How it ended."""
        return self.result.outcome if self.swept is None else self.swept.outcome

    @property
    def passed(self) -> bool:
        """Whether it ended as it must."""
        return self.result.passed and (self.swept is None or self.swept.passed)


@dataclass(frozen=True, slots=True)
class Bar:
    """A span of a lane; the kind decides its color, the words are read out where one points at it."""

    from_s: float
    until_s: float
    kind: str
    words: str


def lane(title: Sequence[Element | str], bars: Sequence[Bar], time: TimeAxis) -> Element:
    """Return a lane: its title, and its bars on the axis of the run."""
    track = tag(
        "div", *(_bar(each, time) for each in bars), *(_fault(at_s, time) for at_s in time.faults_s), class_="track"
    )
    return tag("div", tag("div", *title, class_="lane-title"), track, class_="lane")


def axis(time: TimeAxis) -> Element:
    """Return the axis below lanes."""
    values = ticks(time.start_s, time.end_s, 6)
    marks = [
        tag("span", f"{value:g}{' s' if value == values[-1] else ''}", style=f"left:{_percent(value, time)}")
        for value in values
    ]
    return tag("div", tag("div", class_="lane-title"), tag("div", *marks, class_="axis"), class_="lane")


def _bar(bar: Bar, time: TimeAxis) -> Element:
    left, right = _share(bar.from_s, time), _share(bar.until_s, time)
    style = f"left:{left:.2f}%;width:{max(right - left, 0.4):.2f}%"
    return tag("span", class_=f"bar {bar.kind}", style=style, title=bar.words)


def _fault(at_s: float, time: TimeAxis) -> Element:
    return tag("span", class_="fault-mark", style=f"left:{_percent(at_s, time)}", title=f"fault at {at_s:.3f} s")


def _percent(at_s: float, time: TimeAxis) -> str:
    return f"{_share(at_s, time):.2f}%"


def _share(at_s: float, time: TimeAxis) -> float:
    share = (at_s - time.start_s) / (time.end_s - time.start_s)
    return 100.0 * min(1.0, max(0.0, share))


def packet(made_steps: Mapping[PacketStep, MadeStep]) -> Element:
    """Return the eight steps with the time of each after the one before; steps that were not made are hollow."""
    return tag("ol", *_steps(made_steps), class_="packet")


def _steps(made_steps: Mapping[PacketStep, MadeStep]) -> Iterator[Element]:
    for number, step in enumerate(PacketStep, start=1):
        words = step.name.lower().replace("_", " ")
        if step not in made_steps:
            yield _step(number, words, "–", "missing", f"step {step.value}: not made")
            continue
        made_step = made_steps[step]  # an image is older than the attempt that uses it
        elapsed = f"{'+' if made_step.after_s >= 0.0 else '−'}{seconds(abs(made_step.after_s))}"
        yield _step(number, words, elapsed, "made", f"step {step.value}: at {made_step.stamp_ns / 1e9:.6f} s")


def _step(number: int, words: str, elapsed: str, state: str, hint: str) -> Element:
    return tag("li", tag("i", str(number)), tag("span", words), tag("b", elapsed), class_=state, title=hint)


def attempts(records: Sequence[AttemptRecord], time: TimeAxis) -> Element:
    """Return the timeline; the last record sums up and is left out."""
    rows = [row for record in records[:-1] for row in _attempt(record, time)]
    return tag("div", tag("h3", "Packet trace"), *rows, axis(time), class_="lanes")


def _attempt(record: AttemptRecord, time: TimeAxis) -> Iterator[Element]:
    good = record.outcome == AttemptOutcome.SUCCEEDED
    words = f"{at(record.started_ns)} to {at(record.ended_ns)}: {record.outcome}"
    bar = Bar(record.started_ns / 1e9, record.ended_ns / 1e9, "done" if good else "ended", words)
    outcome = tag("span", record.outcome, class_="plain" if good else "bad")
    yield lane([tag("b", record.step), " ", outcome], [bar], time)
    yield packet(record.made)
    yield tag("p", *(tag("span", text) for text in details(record)), class_="details")


def details(record: AttemptFields[Any]) -> Iterator[str]:
    """Yield what is known of an attempt, in words."""
    yield record.attempt_id
    if record.goal_frame is not None and record.goal_stamp is not None:
        yield f"goal in {record.goal_frame} at {at(record.goal_stamp)}"
    if record.joint_state_age is not None:
        yield f"joint state {seconds(record.joint_state_age)} old"
    if record.tf_lookup_age is not None:
        yield f"transform {seconds(record.tf_lookup_age)} old"
    if record.calibration_id:
        yield f"calibration {', '.join(record.calibration_id)}"
    if record.plan_result is not None:
        yield f"plan: {record.plan_result}"
    if record.controller_name is not None:
        scaling = "" if record.speed_scaling is None else f", speed scaling {record.speed_scaling:.0%}"
        yield f"controller {record.controller_name}{scaling}"
    if record.result is not None:
        yield " ".join(f"result {record.result.status} {record.result.error_string}".split())
    if record.cancel is not None:
        yield f"canceled at {at(record.cancel.requested_ns)}, held after {seconds(record.cancel.latency_s)}"
    if record.safety_state not in ("normal", None):
        yield f"safety state {record.safety_state}"
    if record.fault_code:
        yield f"reason: {record.fault_code}"
    if record.operator_intervention not in ("none", None):
        yield f"operator: {record.operator_intervention}"


_Spans = tuple[tuple[str, int, int, bool], ...]


def claims(trace: TraceResult, time: TimeAxis) -> Iterator[Element]:
    """Yield a lane for interfaces that were claimed alike, and the changes of controllers and hardware."""
    lanes = [_lane(interfaces, spans, time) for spans, interfaces in _alike(trace.claims).items()]
    lanes = lanes or [hint("no controller claimed a command interface")]
    yield tag("div", tag("h3", "Claims of command interfaces"), *lanes, axis(time), class_="lanes")
    if trace.changes:
        rows = [_change(change) for change in trace.changes]
        table = cards(("at", "what", "became", "because"), rows)
        title = f"{count(len(trace.changes), 'change')} of controllers and hardware"
        yield tag("details", tag("summary", title), table)


def _alike(all_claims: tuple[Claim, ...]) -> dict[_Spans, list[str]]:
    """Return the interfaces by what became of them."""
    by_interface: dict[str, list[tuple[str, int, int, bool]]] = {}
    for claim in all_claims:
        span = (claim.controller, claim.from_ns, claim.until_ns, claim.by_contract)
        by_interface.setdefault(claim.interface, []).append(span)
    alike: dict[_Spans, list[str]] = {}
    for interface, spans in by_interface.items():
        alike.setdefault(tuple(spans), []).append(interface)
    return alike


def _lane(interfaces: list[str], spans: _Spans, time: TimeAxis) -> Element:
    bars = [
        Bar(from_ns / 1e9, until_ns / 1e9, "claimed" if right else "ended", f"{owner}, {at(from_ns)} to {at(until_ns)}")
        for owner, from_ns, until_ns, right in spans
    ]
    owners = ", ".join(dict.fromkeys(owner for owner, *_ in spans))
    wrong = [] if all(right for *_, right in spans) else [tag("span", " not by contract", class_="bad")]
    named = interfaces[0] if len(interfaces) == 1 else count(len(interfaces), "interface")
    title = tag("span", breakable(named), title=", ".join(interfaces))
    return lane([tag("b", owners), " ", title, *wrong], bars, time)


def _change(change: StateChange) -> tuple[Child, ...]:
    reason = change.reason or "it was asked to"
    return tag("td", at(change.stamp_ns), class_="number"), f"{change.kind} {change.subject}", change.state, reason


def run_section(number: int, run: RunEvidence, contract: Contract) -> Element:
    """Return the section of a rehearsal."""
    result = run.result
    verdict = "passed" if run.passed else "FAILED"
    title = tag(
        "h2",
        f"Rehearsal {result.name}",
        tag("span", f" {run.outcome}, {verdict}", class_="good" if run.passed else "bad"),
    )
    problems = [
        tag("p", f"{stage.stage}: {text}", class_="note") for stage in result.bringup for text in stage.problems
    ]
    findings = [tag("p", f"finding: {text}", class_="note") for text in result.findings]
    files = hint("files: ", *_links(run.files))
    parts = [] if run.trace is None else list(_parts(run, run.trace, contract))
    contacts = [cards(("what", "presses on", "with up to", "at"), [_contact(each) for each in result.contacts])]
    pressed = [tag("h3", "Contacts"), *contacts] if result.contacts else []
    return tag("section", title, files, *problems, *findings, *parts, *pressed, id=f"run-{number}")


def _contact(contact: Contact) -> tuple[Child, ...]:
    force, stamp = f"{contact.most_n:.3g} N", at(contact.at_ns)
    return contact.one, contact.other, *(tag("td", text, class_="number") for text in (force, stamp))


def _links(files: tuple[str, ...]) -> Iterator[Child]:
    for index, name in enumerate(files):
        yield ", " if index else ""
        # A name that looks like a scheme would lead elsewhere.
        yield tag("a", name, href=f"./{name.replace('%', '%25')}")


def _parts(run: RunEvidence, trace: TraceResult, contract: Contract) -> Iterator[Element]:
    time = _time_axis(run, trace)
    yield attempts(run.result.attempts, time)
    yield from plots(trace, contract, run.tolerances, time, "fault")
    yield from claims(trace, time)


def _time_axis(run: RunEvidence, trace: TraceResult) -> TimeAxis:
    spans = tuple((record.started_ns / 1e9, record.ended_ns / 1e9) for record in run.result.attempts[:-1])
    end_s = max(trace.ended_ns / 1e9, 1e-3)
    faults_s = tuple(start_s for start_s, _ in fault_times(run.entry.faults, run.result.attempts))
    return TimeAxis(0.0, end_s, faults_s, spans)
