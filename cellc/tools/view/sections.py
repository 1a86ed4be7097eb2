"""What the page says in words: findings at the text of the spec, rehearsals, interfaces with their QoS, gates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from xml.etree.ElementTree import Element

from cellc.compiler.deploy.gates import GateText, gate_texts
from cellc.contract.contract import Contract
from cellc.contract.diagnostics import Diagnostic, Severity, Span
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.diagnostics.wording import count
from cellc.contract.entities import ContractEndpoint, ContractInterface
from cellc.contract.review import Review
from cellc.contract.vocabulary import Grade
from cellc.mock.bus.qos import unmatched_pairs
from cellc.mock.report_page.html import Child, breakable, cards, hint, section, tag
from cellc.tools.report.snippet import excerpt
from cellc.tools.view.playback import Run

_OPEN = (Severity.ERROR, Severity.WARNING)
"""Severities whose findings are shown immediately; the others are one click away."""


def findings_section(findings: Findings) -> Element:
    """Return every finding, the worst first, at its place in the spec."""
    ordered = sorted(findings.diagnostics, key=lambda one: (one.severity.rank, one.sort_key()))
    if not ordered:
        return section("Findings", tag("p", "None."), id_="findings")
    return section("Findings", *_by_severity(ordered, findings.texts), id_="findings")


def _by_severity(ordered: Sequence[Diagnostic], texts: Mapping[str, str]) -> Iterator[Element]:
    for severity, diagnostics in groupby(ordered, key=lambda one: one.severity):
        articles = [_finding(diagnostic, texts) for diagnostic in diagnostics]
        details = tag("details", tag("summary", count(len(articles), severity.value)), *articles)
        if severity in _OPEN:
            details.set("open", "")
        yield details


def _finding(found: Diagnostic, texts: Mapping[str, str]) -> Element:
    title = tag("h3", found.message, tag("span", f" {found.code}"))
    related = [
        part
        for related in found.related
        for part in (_place(related.span, related.message), *_snippet(related.span, texts))
    ]
    help_ = [hint(f"help: {found.help}")] if found.help else []
    return tag(
        "article",
        title,
        _place(found.span),
        *_snippet(found.span, texts),
        *related,
        *help_,
        class_=f"finding {found.severity.value}",
    )


def _place(span: Span, words: str = "") -> Element:
    return hint(f"{span}{': ' if words else ''}{words}")


def _snippet(span: Span, texts: Mapping[str, str]) -> Iterator[Element]:
    lines = texts.get(span.file, "").split("\n")
    if not 1 <= span.line <= len(lines):
        return
    line = lines[span.line - 1]
    end = span.end_column - 1 if span.end_line == span.line else len(line)
    shown = excerpt(line, span.column - 1, end)
    # Cells of the terminal and characters are one where nothing is wide.
    before, rest = shown.text[: shown.marked_from], shown.text[shown.marked_from :]
    yield tag("pre", f"{span.line} | {before}", tag("mark", rest[: shown.marked_cells]), rest[shown.marked_cells :])


def absent_section(not_drawn: Sequence[tuple[str, str]]) -> Element:
    """Return what the cell names and the drawing does not have, each with the reason."""
    rows = [(tag("b", name), why) for name, why in not_drawn]
    return section("Not drawn", cards(("what", "why"), rows), id_="absent")


def changes_section(review: Review) -> Element:
    """Return what changed since the other state, as `cellc diff` grades it, and the gates that must be passed again."""
    names = ("grade", "what", "before", "after", "difference", "why")
    rows = [
        (
            tag("span", change.grade.value, class_=_GRADES[change.grade]),
            tag("span", tag("b", ", ".join(change.subjects)), f" {change.quantity}", tag("small", change.area.value)),
            change.before or "–",
            change.after or "–",
            change.delta or "–",
            change.why or "–",
        )
        for change in review.changes
    ]
    text = f"{review.before.name} → {review.after.name}. Gates to repeat: "
    gates = ", ".join(gate.code.value for gate in review.gates) or "none"
    table = cards(names, rows) if rows else tag("p", "Nothing.")
    return section("What changed", hint(text, gates), table, id_="changes")


_GRADES = {Grade.SAFE: "good", Grade.REVIEW: "unknown", Grade.DANGEROUS: "bad"}


def rehearsals_section(runs: Sequence[Run], first: int = 0) -> Element:
    """Return how each rehearsal ended, with a button that plays it back; the first one is a run of this number."""
    names = ("", "rehearsal", "outcome", "expected", "faults", "why")
    rows = [
        (
            tag("button", "Play", class_="play", type="button", data_run=str(number)),
            run.name,
            tag("span", run.outcome, class_="good" if run.passed else "bad"),
            run.expected,
            "; ".join(f"{fault.name} at {fault.at_s:.2f}\u00a0s" for fault in run.faults) or "none",
            run.reason or "–",
        )
        for number, run in enumerate(runs, start=first)
    ]
    return section("Rehearsals on the mock", cards(names, rows), id_="rehearsals")


def interfaces_section(contract: Contract) -> Element:
    """Return who tells what to whom with which QoS, and which ends never connect."""
    broken = [tag("p", text, class_="note") for text in unmatched_pairs(contract)]
    names = ("interface", "type", "from", "to", "bounds", "owner")
    rows = [_interface(name, interface) for name, interface in contract.interfaces.items()]
    return section("Interfaces and QoS", *broken, cards(names, rows), id_="interfaces")


def _interface(name: str, one: ContractInterface) -> tuple[Child, ...]:
    return (
        tag("b", breakable(name)),
        tag("span", breakable(one.type), tag("small", one.kind)),
        _ends(one.sources, one.kind == "topic"),
        _ends(one.sinks, one.kind == "topic"),
        ", ".join(_bounds(one)) or "–",
        one.owner or "–",
    )


def _ends(ends: Iterable[ContractEndpoint], with_qos: bool) -> Element:
    shown = [tag("div", breakable(end.node), *([tag("small", _qos(end))] if with_qos else ())) for end in ends]
    return tag("div", *shown) if shown else tag("div", "none")


def _qos(end: ContractEndpoint) -> str:
    qos = end.qos
    history = f"last\u00a0{qos.depth}" if qos.history == "keep_last" else "all"
    timed = [
        f"{name} {value:g} s" for name, value in (("deadline", qos.deadline_s), ("lifespan", qos.lifespan_s)) if value
    ]
    return ", ".join((qos.reliability.replace("_", " "), qos.durability.replace("_", " "), history, *timed))


def _bounds(one: ContractInterface) -> Iterator[str]:
    if one.rate_hz is not None:
        yield f"{one.rate_hz:g} Hz"
    if one.max_age_s is not None:
        yield f"at most {one.max_age_s:g} s old{'' if one.on_stale is None else f', else {one.on_stale}'}"
    if one.timeout_s is not None:
        yield f"within {one.timeout_s:g} s{'' if one.on_timeout is None else f', else {one.on_timeout}'}"
    if one.cancel_within_s is not None:
        yield f"canceled within {one.cancel_within_s:g} s"


def gates_section(contract: Contract) -> Element:
    """Return the gates between this package and motion, in their order."""
    texts = gate_texts()
    names = ("gate", "what it shows", "state", "evidence", "signed by")
    rows = [_gate(text, contract) for text in (*texts.promotion, *texts.network)]
    sentence = "Passed by people at the cell, in this order; G3 layer by layer. The package has the checks of each."
    return section("Gates", hint(sentence), cards(names, rows), id_="gates")


def _gate(text: GateText, contract: Contract) -> tuple[Child, ...]:
    table_, _, name = text.signed_by.partition(".")
    owners = {"approvals": contract.approvals, "responsibilities": contract.responsibilities}.get(table_, {})
    title = tag("span", tag("b", text.code.value), f" {text.title}")
    return title, text.shows, text.state, text.evidence, owners.get(name, f"the {name}")
