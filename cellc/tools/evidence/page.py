"""The page to hand over: one HTML file without scripts, for a screen and for paper, with lines for the signatures."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element

from cellc.contract.diagnostics.wording import count
from cellc.contract.store.regular_file import own_text
from cellc.contract.vocabulary import UNKNOWN
from cellc.mock.report_page.html import Child, cards, hint, pairs, section, style, tag, to_page
from cellc.tools.evidence.folder import Unread
from cellc.tools.evidence.report import GateState, Piece, Report, Status, named

_POLICY = "default-src 'none'; style-src 'unsafe-inline'"
_NO_STYLE = re.compile(r"[^A-Za-z0-9_, -]")
_CLASSES = {Status.PASSED: "good", Status.COMPLETE: "good", Status.FAILED: "bad", Status.TO_READ: "hint"}


def to_html(report: Report) -> str:
    """Return the page; the same report gives the same bytes."""
    main = tag(
        "main",
        _header(report),
        _table(report),
        *_others("Refused", "Evidence of another cell, configuration or host. It counts for no gate.", report.refused),
        *_others("Not read", "What is in the folder and cannot be read.", report.unread),
        *(_gate(gate) for gate in report.gates),
        _versions(report),
        *_beside(report),
        _colophon(),
    )
    own = own_text(Path(__file__).with_name("page.css")) + _foot(report)
    return to_page(f"{report.cell}: evidence of the gates", style() + own, tag("body", main), policy=_POLICY)


def _foot(report: Report) -> str:
    """Return the style of the foot of each sheet: a loose one says of which cell and configuration it is."""
    whose = _NO_STYLE.sub("?", f"{report.cell}, {report.configuration_id}")
    left, right = f'content: "{whose}"', 'content: counter(page) " of " counter(pages)'
    return f"@media print {{ @page {{ @bottom-left {{ {left} }} @bottom-right {{ {right} }} }} }}\n"


def _header(report: Report) -> Element:
    verdict = (
        tag("span", f"{number} {word}", class_=_class(status)) for status, number, word in report.numbers() if number
    )
    facts = [("configuration", report.configuration_id), ("folder", ", ".join(report.folders))]
    facts += [("hosts", ", ".join(report.hosts))] if report.hosts else []
    return tag(
        "header",
        tag("p", "Evidence of the gates", class_="kicker"),
        tag("h1", report.cell),
        tag("p", report.summary, class_="summary"),
        tag("p", f"{count(len(report.gates), 'gate')}: ", *_between(list(verdict))),
        pairs(facts, "facts"),
    )


def _between(parts: Sequence[Element]) -> Iterator[Child]:
    for number, part in enumerate(parts):
        yield from [", "] if number else []
        yield part


def _table(report: Report) -> Element:
    rows = [
        (
            tag("a", f"{gate.evidence.gate} {gate.evidence.title}", href=f"#{gate.evidence.gate}"),
            tag("span", _short_of(gate), class_=_class(_shade(gate))),
            gate.evidence.signed_by,
            _short(gate.missing),
            str(len(gate.findings) or "–"),
        )
        for gate in report.gates
    ]
    reading = "PASSED is what a program compared; notes are for people to read. Complete is not signed."
    return section("Gates", hint(reading), cards(("gate", "status", "signs", "missing", "findings"), rows))


def _gate(gate: GateState) -> Element:
    stated = gate.evidence
    head = tag("h2", f"{stated.gate} {stated.title} ", tag("span", gate.said, class_=_class(_shade(gate))))
    rows = [_piece(piece) for piece in gate.pieces]
    parts: list[Child] = [head, tag("p", f"{stated.shows[0].upper()}{stated.shows[1:]}." if stated.shows else "")]
    parts += [cards(("status", "file", "what it says"), rows)] if rows else []
    parts += [_findings(gate)] if gate.findings else []
    further = (*gate.notes, *([gate.page] if gate.page else []))
    parts += [tag("ul", *(tag("li", note) for note in further), class_="plain-list")] if further else []
    parts += [hint(f"To be recorded: {'; '.join(stated.measured)}.")] if stated.measured else []
    if gate.is_ready:
        blanks = ("Result", f"Name, for {stated.signed_by}", "Date, time", "Signature")
        parts.append(tag("div", *(tag("p", blank, class_="blank") for blank in blanks), class_="signed"))
    else:
        parts.append(hint(f"To be signed by the owner {stated.signed_by} once it is complete."))
    return tag("section", *parts, id=stated.gate, class_="of-gate")


def _short(names: Sequence[str]) -> str:
    more = f", and {len(names) - 2} more" if len(names) > 2 else ""
    return f"{', '.join(names[:2])}{more}" if names else "–"


def _piece(piece: Piece) -> tuple[Child, ...]:
    mark = tag("span", str(piece.status), class_=_class(piece.status))
    return mark, ", ".join(piece.paths) or named(piece.file), piece.said or "–"


def _findings(gate: GateState) -> Element:
    rows = (
        tag("li", tag("span", f"{finding.status} ", class_=_class(finding.status)), finding.text)
        for finding in gate.findings
    )
    return tag("ul", *rows, class_="plain-list")


def _others(title: str, reading: str, those: Sequence[Unread]) -> Iterator[Element]:
    if those:
        yield section(title, hint(reading), cards(("file", "why"), [(each.path, each.why) for each in those]))


def _versions(report: Report) -> Element:
    rows = (
        (name, tag("dd", version, class_="unknown" if version == UNKNOWN else "plain"))
        for name, version in report.version_tuple
    )
    return section("Version tuple of the package", pairs(rows, "pairs columns"))


def _beside(report: Report) -> Iterator[Element]:
    if report.beside:
        yield section("Files that no gate asks for", tag("p", ", ".join(report.beside)))


def _colophon() -> Element:
    words = (
        "Made by cellc from the files of the folder. It signs nothing, checks no signature and promotes nothing: "
        "people read the evidence, and sign."
    )
    return tag("footer", tag("p", words))


def _shade(gate: GateState) -> Status:
    return Status.UNKNOWN if gate.waits_for and gate.status is Status.COMPLETE else gate.status


def _short_of(gate: GateState) -> str:
    after = f", after {', '.join(code for code, _ in gate.waits_for)}" if gate.waits_for else ""
    return f"{gate.status}{after}" if gate.status is Status.COMPLETE else str(gate.status)


def _class(status: Status) -> str:
    return _CLASSES.get(status, "unknown")
