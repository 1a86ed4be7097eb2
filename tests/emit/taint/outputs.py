"""What a command prints of findings whose texts are hostile, in every format."""

from __future__ import annotations

import contextlib
import io
import json
import re
from collections.abc import Iterator

from cellc.compiler.pipeline import Checked
from cellc.tools.cli.findings import show_findings
from tests.printing.payloads import harm

_OWN = frozenset(("error", "warning", "notice"))
_WORKFLOW = re.compile(r"::(error|warning|notice) [^:]*::[^\n]*")


def outputs(checked: Checked) -> Iterator[str]:
    """Yield where an output holds more than text."""
    found = checked.diagnostics
    said = {form: _shown(checked, form) for form in ("text", "json", "sarif", "github")}
    for form, text in said.items():
        yield from (f"output {form}: {line!r}" for line in harm(text, _OWN if form == "github" else frozenset()))
    lines = said["github"].splitlines()
    if len(lines) != len(found) or not all(map(_WORKFLOW.fullmatch, lines)):
        yield f"output github: {[line for line in lines if not _WORKFLOW.fullmatch(line)][:1]}"
    if len(json.loads(said["json"])["diagnostics"]) != len(found):
        yield "output json: other findings"
    if len(json.loads(said["sarif"])["runs"][0]["results"]) != len(found):
        yield "output sarif: other findings"


def _shown(checked: Checked, form: str) -> str:
    shown = io.StringIO()
    with contextlib.redirect_stdout(shown):
        show_findings([checked.findings], form)
    return shown.getvalue()
