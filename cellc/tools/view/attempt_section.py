"""What the page says of an attempt: how it ended, where it and a rehearsal part, and each step with both sides."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.contract.diagnostics.wording import count
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.report_page.html import Child, cards, hint, seconds, section, tag
from cellc.tools.attempt.compare import STEP_NAMES, Comparison, step_words
from cellc.tools.attempt.record import UNKNOWN, Attempt, Report
from cellc.tools.attempt.text import shown_words
from cellc.tools.view.attempt import Viewed
from cellc.tools.view.bag_run import MOST_STEPS, cut
from cellc.tools.view.playback import STEP_NS, Apart


def attempt_section(viewed: Viewed) -> Element:
    """Return the attempt in words; a button of each step shows where it was farthest from the ghost, or its begin."""
    report = viewed.report
    comparison = report.comparison
    table = _steps(viewed) if comparison is None else _compared(viewed, comparison)
    left = len(report.attempts) - 1 - MOST_STEPS
    return section(
        "Attempt",
        tag("p", outcome_words(report.end.outcome), *_shown(report)),
        *([] if comparison is None else _parted(viewed, comparison)),
        table,
        *([hint(f"{count(left, 'further step')} are not shown.")] if left > 0 else []),
        *(hint(words) for words in _notes(viewed)),
        id_="attempt",
    )


def attempt_facts(viewed: Viewed) -> Iterator[tuple[str, Child]]:
    """Yield facts for the head of the page."""
    report = viewed.report
    length_s = report.since_begin_s(report.end_ns)
    yield "outcome", tag("dd", outcome_words(report.end.outcome))
    yield "bags", cut(", ".join(report.bags))
    yield "length", f"{length_s:.2f} s, {count(report.messages, 'message')}"
    yield "steps of", report.task or "no task named: each goal is a step"


def outcome_words(outcome: AttemptOutcome | None) -> Element:
    """Return an outcome, or UNKNOWN."""
    if outcome is None:
        return tag("span", UNKNOWN, class_="unknown")
    return tag("span", outcome.value, class_="good" if outcome is AttemptOutcome.SUCCEEDED else "bad")


def _shown(report: Report) -> Iterator[Child]:
    finding = report.end.finding
    if finding is not None:
        yield f", layer {finding.layer}. {cut(shown_words(report, finding))}"


def _parted(viewed: Viewed, comparison: Comparison) -> Iterator[Element]:
    lines = comparison.parted[:MOST_STEPS]
    ghost = viewed.runs[0].ghost
    words = f"Against {comparison.name}"
    if ghost is not None:
        words += ", drawn translucent where it is 2 mm or more elsewhere. Both are in step at the acceptance of the "
        words += f"first goal{_shifted(ghost.shift_s)}."
        farthest = max(ghost.apart, key=lambda each: each.far_m, default=None)
        if farthest is not None and farthest.far_m:
            words += f" Farthest apart: {_far(farthest)}."
    yield hint(words)
    if lines:
        yield tag("ul", *(tag("li", cut(line)) for line in lines), class_="parted")
    else:
        yield tag("p", "They part nowhere: same outcomes, times and errors.")


def _shifted(shift_s: float) -> str:
    """Return by how much the clocks of both differ."""
    return f", {seconds(abs(shift_s))} {'later' if shift_s > 0 else 'earlier'} in the attempt" if shift_s else ""


def _far(apart: Apart) -> str:
    return f"{apart.far_m * 1e3:.0f} mm at {apart.at_s:.2f} s, {apart.name}" if apart.far_m else "nowhere"


def _compared(viewed: Viewed, comparison: Comparison) -> Element:
    ghost = viewed.runs[0].ghost
    apart = () if ghost is None else ghost.apart
    rows = []
    for number, step in enumerate(comparison.steps[:MOST_STEPS]):
        name, outcome, rehearsed, *rest = map(cut, step_words(step))
        far = apart[number] if number < len(apart) else None
        at_s = _begin_s(viewed, number) if far is None else far.at_s
        marks = (_outcome(outcome), _outcome(rehearsed))
        rows.append((_button(at_s), name, *marks, *rest, "–" if far is None else _far(far)))
    return cards(("", *STEP_NAMES, "farthest apart"), rows)


def _outcome(words: str) -> Element:
    """Return an outcome of one side, or a word in its place."""
    known = {each.value: each for each in AttemptOutcome}
    return outcome_words(known[words]) if words in known else tag("span", words, class_="unknown")


def _steps(viewed: Viewed) -> Element:
    attempts = viewed.report.attempts[:-1][:MOST_STEPS]
    rows = [_step(viewed, number, attempt) for number, attempt in enumerate(attempts)]
    return cards(("", "step", "outcome", "from, s", "until, s", "why"), rows)


def _step(viewed: Viewed, number: int, attempt: Attempt) -> tuple[Child, ...]:
    span_s = viewed.report.span_s(attempt)
    times = (UNKNOWN, UNKNOWN) if span_s is None else tuple(f"{at_s:.3f}" for at_s in span_s)
    why = "–" if attempt.finding is None else cut(f"{attempt.finding.layer}: {attempt.finding.message}")
    return _button(_begin_s(viewed, number)), cut(attempt.step), outcome_words(attempt.outcome), *times, why


def _begin_s(viewed: Viewed, number: int) -> float | None:
    attempts = viewed.report.attempts[:-1]
    span_s = viewed.report.span_s(attempts[number]) if number < len(attempts) else None
    return None if span_s is None else span_s[0]


def _button(at_s: float | None) -> Child:
    """Return what shows the attempt at an instant."""
    if at_s is None:
        return ""
    return tag("button", "Show", class_="play", type="button", data_run="0", data_at=f"{at_s:.3f}")


def _notes(viewed: Viewed) -> Iterator[str]:
    report = viewed.report
    most = round(1e9 / STEP_NS)
    if not viewed.runs[0].times:
        yield "The bag has no joint states of this cell: nothing moves."
    elif viewed.step_s * 1e9 > STEP_NS:
        yield f"Joint states are drawn every {seconds(viewed.step_s)}, not {most} times a second: the bag is long."
    else:
        yield f"Joint states are drawn {most} times a second; `cellc attempt -o` has the curves of all of them."
    if viewed.no_ghost:
        yield f"No ghost: {viewed.no_ghost}."
    yield "What perception finds is drawn where the mock places it: its poses are not read from the bag."
    yield from (f"Note: {cut(note)}" for note in report.notes[:20])
    if report.missing:
        yield f"Not recorded: {cut(', '.join(report.missing))}."
