"""What findings propose in the place of a text, and whether a finding ends once that is done."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.compiler.pipeline import check
from cellc.compiler.source import SourceDocument
from cellc.contract.diagnostics import Advice, Diagnostic
from cellc.tools.edit.rewrite import Edit, apply_edits
from cellc.tools.lsp.remedies import Remedy, fixes


def proposing(found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the findings that propose a text."""
    return [one for one in found if "did you mean" in one.help or (isinstance(one.help, Advice) and one.help.instead)]


def remedies_of(found: Diagnostic, document: SourceDocument) -> list[Remedy]:
    """Return the fixes of a finding, without the comment that excuses it."""
    return [remedy for remedy in fixes([found], document) if "cellc: ignore" not in remedy.edit.text]


def faults(found: Diagnostic, document: SourceDocument) -> Iterator[str]:
    """Yield what is wrong with the fixes of a finding that proposes a text: the first must end it."""
    remedies = remedies_of(found, document)
    near = found.fix is not None or (isinstance(found.help, Advice) and found.help.is_near)
    preferred = [number for number, remedy in enumerate(remedies) if remedy.preferred]
    if not remedies or preferred != ([0] if near else []):
        yield f"{found}: {len(remedies)} fixes, preferred are {preferred}; {found.help}"
    elif stays(found, remedies[0].edit, document):
        yield f"{found} stays after {remedies[0].edit.message}"


def stays(found: Diagnostic, edit: Edit, document: SourceDocument) -> bool:
    """Whether a finding is still there after an edit."""
    texts = {**document.texts, edit.file: apply_edits(document.texts[edit.file], [edit])}
    after = check(document.file, texts).diagnostics
    return any((one.code, one.yaml_path, one.message) == (found.code, found.yaml_path, found.message) for one in after)
