"""A whole review for people at a terminal: one line that sums it up, then every change under what causes it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Style, Styled
from cellc.contract.review import Review, ReviewChange, ReviewFinding, ReviewGate, ReviewRehearsal
from cellc.contract.vocabulary import Grade
from cellc.tools.review.groups import asking_of, groups_of, values_of

STYLES = {Grade.DANGEROUS: Style.RED, Grade.REVIEW: Style.YELLOW, Grade.SAFE: Style.GREEN}
_FEW = 4


def render_review(review: Review) -> Iterator[Line]:
    """Yield the lines of a review."""
    yield summed_up(review)
    yield f"before  {review.before.name}, {review.before.configuration_id}"
    yield f"after   {review.after.name}, {review.after.configuration_id}"
    for note in review.notes:
        yield f"note: {note}"
    yield from finding_lines("new findings", review.new_findings)
    for group in groups_of(review):
        yield ""
        yield (Styled(group.grade.value, STYLES[group.grade]), "  ", Styled(group.title, Style.BOLD))
        asking = asking_of(group.changes)
        for change in group.changes:
            yield from _change(change, is_asking=change in asking)
    yield from finding_lines("resolved findings", review.gone_findings)
    if review.rehearsals:
        yield ""
        yield "rehearsals"
        yield from (f"  {outcomes(rehearsal)}" for rehearsal in review.rehearsals)
    if review.gates:
        yield ""
        yield "gates to repeat (their evidence is no longer valid)"
        yield from (f"  {gate_line(gate)}" for gate in review.gates)


def summed_up(review: Review) -> str:
    """Return one line: how many headings have each grade, and how many changes stand under them."""
    if not review.changes:
        differing = len(review.files)
        text = f"; {differing} files differ only in order or spelling" if differing else ""
        return f"{review.after.name}: no change{text}"
    groups = groups_of(review)
    counts = ((sum(group.grade is grade for group in groups), grade) for grade in reversed(Grade))
    listed = ", ".join(f"{number} {grade}" for number, grade in counts if number)
    noun = "cause" if review.causes else "area"
    told = count(len(review.changes), "change")
    return f"{review.after.name}: {count(len(groups), noun)} ({listed}), {told}{_breaking(review.changes)}"


def _breaking(changes: Sequence[ReviewChange]) -> str:
    number = sum(change.breaking for change in changes)
    return f"; {number} may break consumers outside the cell" if number else ""


def subjects_of(change: ReviewChange, few: int = _FEW) -> str:
    """Return what changed; of many, the first and their number."""
    shown = change.subjects if len(change.subjects) <= few else change.subjects[:few]
    more = len(change.subjects) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def outcomes(rehearsal: ReviewRehearsal) -> str:
    """Return how a rehearsal ended on both sides."""
    before, after = rehearsal.before or "not run", rehearsal.after or "not run"
    ended = before if before == after else f"{before} -> {after}"
    return f"{rehearsal.name}: {ended}" + (", not as declared" if rehearsal.passed_after is False else "")


def gate_line(gate: ReviewGate) -> str:
    """Return a gate with the evidence to record again."""
    because = f" (because of {', '.join(gate.because)})" if gate.because else ""
    return f"{gate.code} {gate.title}: {gate.evidence}{because}"


def approved_by(change: ReviewChange) -> str:
    """Return whose approval a change needs."""
    asked = {area: owner or "no owner" for area, owner in {change.approval: change.owner, **change.beside}.items()}
    return f"approval {', '.join(f'{area}: {owner}' for area, owner in asked.items())}"


def _change(change: ReviewChange, *, is_asking: bool) -> Iterator[Line]:
    breaking: tuple[str | Styled, ...] = ("  ", Styled("may break consumers", Style.RED)) if change.breaking else ()
    grade = Styled(change.grade.value, STYLES[change.grade])
    yield ("  ", grade, f" {change.area}  {subjects_of(change)}: {change.quantity}", *breaking)
    yield from (f"      {values}" for values in [values_of(change)] if values)
    said = "; ".join(part for part in (change.why, approved_by(change) if is_asking else "") if part)
    if said:
        yield ("      ", Styled(said, Style.DIM))


def finding_lines(title: str, findings: tuple[ReviewFinding, ...]) -> Iterator[Line]:
    """Yield findings of the check under a title, if any."""
    if findings:
        yield ""
        yield title
        yield from (
            f"  {finding.severity}[{finding.code}]: {finding.message} ({finding.place})" for finding in findings
        )
