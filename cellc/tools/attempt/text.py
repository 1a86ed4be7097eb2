"""What is printed of an attempt, and its page in Markdown; every text of a bag is a value, never markup."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields

from cellc.compiler.formats.escape import code, markdown
from cellc.compiler.formats.markdown_table import table
from cellc.contract.attempt import PacketStep
from cellc.contract.printing import Line, Style, Styled
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.evidence.kpis import TITLES
from cellc.mock.report_page.html import at, plain, seconds
from cellc.tools.attempt.compare import MEASURE_NAMES, STEP_NAMES, Comparison, measure_words, step_words
from cellc.tools.attempt.record import UNKNOWN, Attempt, Figure, Finding, Report

_APART = ("trace", "finding", "unknown", "attempt_id", "step", "version_tuple", "configuration_id")
"""Fields that are elsewhere on the page than in the table of an attempt."""


def render_text(report: Report) -> Iterator[Line]:
    """Yield what a terminal shows."""
    yield f"{report.contract.cell}, {report.task or 'no task named: each goal is a step'}, {_seconds(report)}"
    yield ("outcome  ", Styled(_outcome(report.end), _style(report.end)))
    if report.end.finding is not None:
        yield f"layer    {report.end.finding.layer}"
        yield f"shown    {shown_words(report, report.end.finding)}"
    yield ""
    for attempt in report.attempts[:-1]:
        times = f"{_time(report, attempt, 'started_ns')} to {_time(report, attempt, 'ended_ns')}"
        yield (f"{attempt.step}: ", Styled(_outcome(attempt), _style(attempt)), f", {times}")
        reached = [f"{step.value[0]} at {time}" for step, time in _steps(report, attempt) if time]
        yield f"    steps {', '.join(reached) or 'not shown'}"
    for figure in report.figures:
        yield f"{figure_title(figure)}  {figure_words(figure)}"
    if report.comparison is not None:
        yield from _against(report.comparison)
    yield from (f"UNKNOWN  {name}: {why}" for name, why in unknown_fields(report))
    yield from (f"note     {note}" for note in report.notes)
    if report.missing:
        yield f"not recorded: {', '.join(report.missing)}"


def _against(comparison: Comparison) -> Iterator[str]:
    """Yield where an attempt and a rehearsal part, and what the bag measures beside it."""
    yield f"against  {comparison.name}"
    yield from (f"parted   {each}" for each in comparison.parted or ("nowhere",))
    for each in comparison.measures:
        name, real, rehearsed, stated, source = measure_words(each)
        yield f"measured {name}: {real}; rehearsed {rehearsed}; stated {stated}; from {source}"


def render_markdown(report: Report) -> str:
    """Return the page: what happened, each attempt with every field and the eight steps, figures, what is UNKNOWN."""
    return "\n".join(_page(report)) + "\n"


def _page(report: Report) -> Iterator[str]:
    contract = report.contract
    yield f"# Attempt of {code(contract.cell)}"
    yield ""
    rows = (
        ("bags", report.bags),
        ("configuration", contract.configuration_id),
        ("versions", ", ".join(f"{part} {version}" for part, version in contract.version_tuple.items())),
        ("steps of", report.task or "no task named: each goal is a step"),
        ("length", f"{_seconds(report)}, {report.messages} messages"),
        ("outcome", _outcome(report.end)),
    )
    yield table(("of", "this attempt"), rows)
    if report.end.finding is not None:
        yield ""
        yield f"Layer **{report.end.finding.layer}**: {markdown(shown_words(report, report.end.finding))}"
    if report.comparison is not None:
        yield from _against_tables(report.comparison)
    for attempt in report.attempts:
        yield from _attempt(report, attempt)
    yield from _rest(report)


def _against_tables(comparison: Comparison) -> Iterator[str]:
    yield from ("", f"## Against {markdown(comparison.name)}", "")
    yield from (f"- {markdown(each)}" for each in comparison.parted or ("They part nowhere",))
    yield from ("", table(STEP_NAMES, map(step_words, comparison.steps)))
    yield from ("", table(MEASURE_NAMES, map(measure_words, comparison.measures)))


def _attempt(report: Report, attempt: Attempt) -> Iterator[str]:
    yield ""
    yield f"## {markdown(attempt.step)} ({code(attempt.attempt_id)})"
    yield ""
    shown = (each.name for each in fields(attempt) if each.name not in _APART)
    yield table(
        ("field", "value"),
        (
            *((name.removesuffix("_ns"), _value(report, attempt, name) or "–") for name in shown),
            *_layer(report, attempt),
        ),
    )
    if attempt is not report.end:
        steps = ((step.value, time or _absent(attempt)) for step, time in _steps(report, attempt))
        yield from ("", table(("step of the packet", "s since the begin of the bag"), steps))


def _layer(report: Report, attempt: Attempt) -> Iterator[tuple[str, str]]:
    if attempt.finding is not None:
        yield "layer", f"{attempt.finding.layer}: {shown_words(report, attempt.finding)}"


def _rest(report: Report) -> Iterator[str]:
    yield ""
    yield "## Key figures"
    yield ""
    yield table(("figure", "value"), ((figure_title(each), figure_words(each)) for each in report.figures))
    for title, lines in lists(report):
        yield from ("", f"## {title}", "", *(f"- {markdown(line)}" for line in lines))


def lists(report: Report) -> Iterator[tuple[str, Sequence[str]]]:
    """Yield what the bag does not show, and notes, each under its title."""
    unknown = [f"{name}: {why}" for name, why in unknown_fields(report)]
    titles = ("UNKNOWN, and what would have to be recorded", "Topics of the cell that were not recorded", "Notes")
    yield from (each for each in zip(titles, (unknown, report.missing, report.notes), strict=True) if each[1])


def _outcome(attempt: Attempt) -> str:
    return UNKNOWN if attempt.outcome is None else attempt.outcome.value


def _style(attempt: Attempt) -> Style:
    return Style.GREEN if attempt.outcome is AttemptOutcome.SUCCEEDED else Style.RED


def shown_words(report: Report, finding: Finding) -> str:
    """Return the message that shows the layer, with its time and source."""
    at_s = (finding.at_ns - report.begin_ns) / 1e9
    return f"{at_s:.3f} s, {finding.source}: {finding.message}"


def _seconds(report: Report) -> str:
    return f"{(report.end_ns - report.begin_ns) / 1e9:.3f} s"


def _time(report: Report, attempt: Attempt, name: str) -> str:
    at_ns = getattr(attempt, name)
    return UNKNOWN if at_ns is None else f"{(at_ns - report.begin_ns) / 1e9:.3f} s"


def _steps(report: Report, attempt: Attempt) -> Iterator[tuple[PacketStep, str]]:
    """Yield each of the eight steps with its time, which is empty for one that the bag does not show."""
    for step in PacketStep:
        at_ns = attempt.stamps.get(step)
        yield step, "" if at_ns is None else f"{(at_ns - report.begin_ns) / 1e9:.3f}"


def _absent(attempt: Attempt) -> str:
    return UNKNOWN if "trace" in attempt.unknown else "not reached"


def _value(report: Report, attempt: Attempt, name: str) -> str:
    value = getattr(attempt, name)
    if value is None or value == ():
        return UNKNOWN if name in attempt.unknown else ""
    if isinstance(value, tuple):
        return ", ".join(map(str, value))
    if not hasattr(value, "__slots__"):
        return _plain(report, name, value)
    parts = {each.name: getattr(value, each.name) for each in fields(value)}
    lacking = {part for part in parts if f"{name}.{part}" in attempt.unknown}
    return ", ".join(
        f"{part.removesuffix('_ns')} {UNKNOWN if part in lacking else _plain(report, part, of_part)}"
        for part, of_part in parts.items()
        if of_part is not None or part in lacking
    )


def _plain(report: Report, name: str, value: object) -> str:
    """Return a value with its unit, which the name of its field tells."""
    if isinstance(value, int) and name.endswith(("_ns", "_stamp")):
        return at(value - report.begin_ns)
    if isinstance(value, float) and name.endswith(("_s", "_age")):
        return seconds(value)
    return f"{value:.0%}" if name == "speed_scaling" else f"{value}"


def figure_words(figure: Figure) -> str:
    """Return the value of a figure with its target."""
    value = "not met in this bag" if figure.value is None else plain(figure.value, figure.unit)
    return value if figure.target is None else f"{value}, target {plain(figure.target, figure.unit)}"


def figure_title(figure: Figure) -> str:
    """Return the name of a figure in words."""
    return TITLES.get(figure.name, figure.name.replace("_", " "))


def unknown_fields(report: Report) -> list[tuple[str, str]]:
    """Return every field that is UNKNOWN in some attempt, with what would have to be recorded."""
    found: dict[str, str] = {}
    for attempt in report.attempts:
        found |= attempt.unknown
    return sorted(found.items())
