"""An attempt as one page: its phases, plots of every joint, ages and speed scaling, figures, and what is UNKNOWN."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from xml.etree.ElementTree import Element

from cellc.contract.diagnostics.wording import count
from cellc.contract.store.regular_file import own_text
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.report_page.axes import TimeAxis
from cellc.mock.report_page.html import Child, cards, hint, pairs, seconds, section, tag, to_page
from cellc.mock.report_page.plots import plots, state_plot
from cellc.mock.report_page.run_section import Bar, axis, details, lane, packet
from cellc.tools.attempt.compare import MEASURE_NAMES, STEP_NAMES, Comparison, measure_words, step_words
from cellc.tools.attempt.record import UNKNOWN, Attempt, Report
from cellc.tools.attempt.text import figure_title, figure_words, lists, shown_words

_NO_TASK = "no task named: each goal is a step"


def render_page(report: Report, tolerances: Mapping[str, float]) -> str:
    """Return the page; the same bag gives the same bytes.

    Args:
        report: with its signals.
        tolerances: path tolerance of each joint that has one, rad or m.
    """
    style = own_text(Path(str(files("cellc.mock.report_page") / "style.css")))
    time = _time_axis(report)
    against = () if report.comparison is None else _against(report.comparison)
    parts = (_header(report), *against, _phases(report, time), *_plots(report, tolerances, time), *_rest(report))
    main = tag("main", *parts)
    return to_page(f"{report.contract.cell}: an attempt", style, tag("body", main), policy=_POLICY)


_POLICY = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
"""The page has no script, and asks nothing of anybody."""


def _header(report: Report) -> Element:
    contract, end = report.contract, report.end
    facts = [
        ("configuration", contract.configuration_id),
        ("ROS 2", contract.distro.value),
        ("steps of", report.task or _NO_TASK),
        ("bag", f"{seconds((report.end_ns - report.begin_ns) / 1e9)}, {count(report.messages, 'message')}"),
    ]
    shown = "" if end.finding is None else f", layer {end.finding.layer}. {shown_words(report, end.finding)}"
    return tag(
        "header",
        tag("p", "Attempt, read from a bag", class_="kicker"),
        tag("h1", contract.cell),
        tag("p", contract.summary, class_="summary"),
        tag("p", _outcome(end), shown),
        pairs(facts, "facts"),
        hint("bags: ", ", ".join(report.bags)),
    )


def _outcome(attempt: Attempt) -> Element:
    good = attempt.outcome is AttemptOutcome.SUCCEEDED
    return tag("span", attempt.outcome or UNKNOWN, class_="good" if good else "bad")


def _time_axis(report: Report) -> TimeAxis:
    spans = tuple(span for attempt in report.attempts[:-1] if (span := report.span_s(attempt)) is not None)
    marks = () if report.end.finding is None else (report.since_begin_s(report.end.finding.at_ns),)
    return TimeAxis(0.0, max(report.since_begin_s(report.end_ns), 1e-3), marks, spans)


def _phases(report: Report, time: TimeAxis) -> Element:
    rows = [row for attempt in report.attempts[:-1] for row in _attempt(report, attempt, time)]
    words = "Pale: before a controller accepted the goal; full: while it executed; striped: what failed."
    lanes = tag("div", *rows, axis(time), class_="lanes")
    return section("Phases", hint(words), lanes if rows else hint("The bag shows no step."))


def _attempt(report: Report, attempt: Attempt, time: TimeAxis) -> Iterator[Element]:
    yield lane([tag("b", attempt.step), " ", _outcome(attempt)], list(_bars(report, attempt)), time)
    counted = _since(report.begin_ns, attempt)
    yield packet(counted.made)
    yield tag("p", *(tag("span", text) for text in details(counted)), class_="details")


def _since(begin_ns: int, attempt: Attempt) -> Attempt:
    """Return an attempt whose stamps are counted from the begin of the bag."""
    started_ns, goal_ns, cancel = attempt.started_ns, attempt.goal_stamp, attempt.cancel
    return replace(
        attempt,
        started_ns=None if started_ns is None else started_ns - begin_ns,
        goal_stamp=None if goal_ns is None else goal_ns - begin_ns,
        cancel=None if cancel is None else replace(cancel, requested_ns=cancel.requested_ns - begin_ns),
        trace=tuple(replace(point, stamp_ns=point.stamp_ns - begin_ns) for point in attempt.trace),
    )


def _bars(report: Report, attempt: Attempt) -> Iterator[Bar]:
    span = report.span_s(attempt)
    if span is None:
        return
    begin_s, end_s = span
    good = attempt.outcome is AttemptOutcome.SUCCEEDED
    goal_s = [report.since_begin_s(at) for step, at in attempt.stamps.items() if step.name == "ACCEPTED"]
    words = f"{begin_s:.3f} s to {end_s:.3f} s: {attempt.outcome or UNKNOWN}"
    accepted_s = min(max(begin_s, *goal_s), end_s) if goal_s else begin_s
    if accepted_s > begin_s:
        yield Bar(begin_s, accepted_s, "claimed pale", f"{begin_s:.3f} s to {accepted_s:.3f} s: until it was accepted")
    yield Bar(accepted_s, end_s, "done" if good else "ended", words)


def _plots(report: Report, tolerances: Mapping[str, float], time: TimeAxis) -> Iterator[Element]:
    signals = report.signals
    if signals is None:
        return
    drawn = list(plots(signals, report.contract, tolerances, time, "what shows the failure"))
    if signals.scaling:
        drawn += [
            tag("h3", "Speed scaling"),
            tag("div", *(state_plot(each, None, time) for each in signals.scaling), class_="grid"),
        ]
    if not drawn:
        drawn = [hint("The bag has no states of joints or controllers, no transforms and no observations.")]
    yield section("Signals", hint("Seconds since the begin of the bag, by arrival on the recording computer."), *drawn)


def _against(comparison: Comparison) -> Iterator[Element]:
    """Yield where the attempt and a rehearsal part, and what the bag measures beside it."""
    parted = tag("ul", *(tag("li", each) for each in comparison.parted), class_="plain-list")
    steps = cards(STEP_NAMES, (step_words(each) for each in comparison.steps))
    words = hint("They part nowhere.") if not comparison.parted else parted
    yield section(f"Against {comparison.name}", words, steps)
    reading = "Facts for the spec: what the bag measures, beside what the rehearsal has and what the contract states."
    yield section(
        "Measured", hint(reading), cards(MEASURE_NAMES, (measure_words(each) for each in comparison.measures))
    )


def _rest(report: Report) -> Iterator[Element]:
    rows: list[tuple[Child, ...]] = [(figure_title(figure), figure_words(figure)) for figure in report.figures]
    yield section("Key figures", cards(("figure", "value"), rows))
    for title, lines in lists(report):
        yield section(title, tag("ul", *(tag("li", each) for each in lines), class_="plain-list"))
