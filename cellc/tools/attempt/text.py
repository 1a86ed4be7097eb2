"""What is printed of an attempt, and its page in Markdown; every text of a bag is a value, never markup."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields

from cellc.compiler.formats.escape import code
from cellc.contract.attempt import PacketStep
from cellc.contract.printing import Line, Style, Styled
from cellc.contract.vocabulary import AttemptOutcome
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
        yield f"{figure.name}  {figure_words(figure)}"
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
    yield from _table(
        ("bags", ", ".join(report.bags)),
        ("configuration", contract.configuration_id),
        ("versions", ", ".join(f"{part} {version}" for part, version in contract.version_tuple.items())),
        ("steps of", report.task or "no task named: each goal is a step"),
        ("length", f"{_seconds(report)}, {report.messages} messages"),
        ("outcome", _outcome(report.end)),
    )
    if report.end.finding is not None:
        yield ""
        yield f"Layer **{report.end.finding.layer}**: {code(shown_words(report, report.end.finding))}"
    if report.comparison is not None:
        yield from _against_tables(report.comparison)
    for attempt in report.attempts:
        yield from _attempt(report, attempt)
    yield from _rest(report)


def _against_tables(comparison: Comparison) -> Iterator[str]:
    yield from ("", f"## Against {code(comparison.name)}", "")
    yield from (f"- {code(each)}" for each in comparison.parted or ("They part nowhere",))
    tables = (
        (STEP_NAMES, [step_words(each) for each in comparison.steps]),
        (MEASURE_NAMES, [measure_words(each) for each in comparison.measures]),
    )
    for names, rows in tables:
        yield ""
        yield f"| {' | '.join(names)} |"
        yield "|" + "---|" * len(names)
        yield from (f"| {' | '.join(code(cell).replace('|', '&#124;') for cell in row)} |" for row in rows)


def _attempt(report: Report, attempt: Attempt) -> Iterator[str]:
    yield ""
    yield f"## {code(attempt.attempt_id)} {code(attempt.step)}"
    yield ""
    yield from _table(
        *((each.name, _value(attempt, each.name)) for each in fields(attempt) if each.name not in _APART),
        *_layer(report, attempt),
    )
    if attempt is not report.end:
        yield ""
        yield "| step of the packet | s since the begin of the bag |"
        yield "|---|---|"
        yield from (f"| {step.value} | {time or _absent(attempt)} |" for step, time in _steps(report, attempt))


def _layer(report: Report, attempt: Attempt) -> Iterator[tuple[str, str]]:
    if attempt.finding is not None:
        yield "layer", f"{attempt.finding.layer}: {shown_words(report, attempt.finding)}"


def _rest(report: Report) -> Iterator[str]:
    yield ""
    yield "## Key figures"
    yield ""
    yield from _table(*((figure.name, figure_words(figure)) for figure in report.figures))
    for title, lines in (
        ("UNKNOWN, and what would have to be recorded", [f"{name}: {why}" for name, why in unknown_fields(report)]),
        ("Topics of the cell that were not recorded", report.missing),
        ("Notes", report.notes),
    ):
        if lines:
            yield from ("", f"## {title}", "", *(f"- {code(line)}" for line in lines))


def _table(*rows: tuple[str, str]) -> Iterator[str]:
    yield "| | |"
    yield "|---|---|"
    yield from (f"| {name} | {code(value).replace('|', '&#124;') if value else ''} |" for name, value in rows)


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


def _value(attempt: Attempt, name: str) -> str:
    value = getattr(attempt, name)
    if value is None or value == ():
        return UNKNOWN if name in attempt.unknown else ""
    if isinstance(value, tuple):
        return ", ".join(map(str, value))
    shown = [(each.name, getattr(value, each.name)) for each in fields(value)] if hasattr(value, "__slots__") else []
    known = [
        f"{part} {UNKNOWN if f'{name}.{part}' in attempt.unknown else of_part}"
        for part, of_part in shown
        if of_part is not None or f"{name}.{part}" in attempt.unknown
    ]
    return ", ".join(known) if shown else f"{value.value if isinstance(value, AttemptOutcome) else value}"


def figure_words(figure: Figure) -> str:
    """Return the value of a figure with its target."""
    value = "not met in this bag" if figure.value is None else f"{figure.value:.6g} {figure.unit}"
    return value if figure.target is None else f"{value}, target {figure.target:g} {figure.unit}"


def unknown_fields(report: Report) -> list[tuple[str, str]]:
    """Return every field that is UNKNOWN in some attempt, with what would have to be recorded."""
    found: dict[str, str] = {}
    for attempt in report.attempts:
        found |= attempt.unknown
    return sorted(found.items())
