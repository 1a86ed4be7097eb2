"""What is printed of a folder of evidence; every text of a file is a value."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Style, Styled
from cellc.tools.evidence.report import GateState, Piece, Report, Status, named

_STYLES = {
    Status.PASSED: Style.GREEN,
    Status.COMPLETE: Style.GREEN,
    Status.FAILED: Style.RED,
    Status.TO_READ: Style.DIM,
}
_WIDTH = 11


def render_text(report: Report) -> Iterator[Line]:
    """Yield what a terminal shows."""
    yield f"{report.cell}, {report.configuration_id}: {', '.join(report.folders)}"
    for gate in report.gates:
        yield ""
        yield from _gate(gate)
    for title, those in (("refused", report.refused), ("not read", report.unread)):
        yield from [""] if those else []
        yield from ((_word(Status.FAILED, title), f" {each.path}: {each.why}") for each in those)
    if report.beside:
        yield ""
        yield f"{count(len(report.beside), 'file')} that no gate asks for: {', '.join(report.beside[:10])}"
    yield ""
    numbers = ", ".join(f"{number} {word}" for _, number, word in report.numbers())
    yield f"{count(len(report.gates), 'gate')}: {numbers}. cellc signs nothing and promotes nothing."


def _gate(gate: GateState) -> Iterator[Line]:
    stated = gate.evidence
    shade = Status.UNKNOWN if gate.waits_for and gate.status is Status.COMPLETE else gate.status
    yield (Styled(f"{stated.gate} {stated.title}", Style.BOLD), ": ", _word(shade, gate.said))
    if not gate.is_ready:
        yield f"  signed by: {stated.signed_by}"
    yield from map(_piece, gate.pieces)
    for finding in gate.findings:
        yield ("  ", _word(finding.status, str(finding.status).ljust(_WIDTH)), finding.text)
    yield from (f"  {'note'.ljust(_WIDTH)}{note}" for note in (*gate.notes, *([gate.page] if gate.page else [])))


def _piece(piece: Piece) -> Line:
    said = f": {piece.said}" if piece.said else ""
    what = ", ".join(piece.paths) or named(piece.file)
    return ("  ", _word(piece.status, str(piece.status).ljust(_WIDTH)), f"{what}{said}")


def _word(status: Status, word: str) -> Styled:
    return Styled(word, _STYLES.get(status, Style.YELLOW))
