"""What a command prints of findings whose texts are hostile, in every format."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

from cellc.pipeline import Checked
from cellc.report.github_report import render_github
from cellc.report.json_report import render_json
from cellc.report.sarif_report import render_sarif
from cellc.report.text_report import render_text

# What a terminal obeys, and what hides or turns text: Unicode 15, categories Cc and Cf but for the soft hyphen, Zl, Zp.
_OBEYED = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]")
# A runner of GitHub or Azure takes such a line of any output for a command.
_COMMAND = re.compile(r"^\s*(::|##\[|##vso\[)", re.M)
_WORKFLOW = re.compile(r"::(error|warning|notice) [^:]*::[^\n]*")


def outputs(checked: Checked, folder: Path) -> Iterator[str]:
    """Yield where an output holds more than text."""
    found = checked.diagnostics
    text = render_text(found, checked.findings.texts, colour=False)
    github = render_github(found, folder)
    tool = {"json": render_json(found), "sarif": render_sarif(found, folder)}
    for name, said in {"text": text, "github": github, **tool}.items():
        if obeyed := _OBEYED.search(said):
            yield f"output {name}: U+{ord(obeyed[0]):04X} in {said[max(0, obeyed.start() - 80) : obeyed.start()]!r}"
    if command := _COMMAND.search(text):
        yield f"output text: {text[command.start() : command.start() + 80]!r}"
    lines = github.splitlines()
    if len(lines) != len(found) or not all(map(_WORKFLOW.fullmatch, lines)):
        yield f"output github: {[line for line in lines if not _WORKFLOW.fullmatch(line)][:1]}"
    messages = sorted(one.message for one in found)
    if sorted(one["message"] for one in json.loads(tool["json"])["diagnostics"]) != messages:
        yield "output json: other messages"
    if len(json.loads(tool["sarif"])["runs"][0]["results"]) != len(found):
        yield "output sarif: other results"
