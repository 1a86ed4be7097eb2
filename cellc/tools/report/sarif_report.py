"""Diagnostics as SARIF 2.1.0 (OASIS standard, errata 01), which code hosts and editors read.

One run; the rules are the pages of the codes that were reported. Blockers are level ``warning`` and audits ``note``: no
artifact stops because of them; cellc's own severity is in the properties. Columns count code points and their
end is exclusive, both as in spans. Left out: times, machines and absolute places, so that a report can be compared.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import PurePath

from cellc.compiler.pages import all_codes, family_of, render_page
from cellc.contract.code_page import page_of
from cellc.contract.diagnostics import Diagnostic, Fix, Severity, Span, format_path
from cellc.contract.diagnostics.unsafe_text import escaped, harmless_json
from cellc.tools.report.github_report import file_uri
from cellc.version import __version__

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {
    Severity.ERROR: "error",
    Severity.BLOCKER: "warning",
    Severity.WARNING: "warning",
    Severity.AUDIT: "note",
}


def render_sarif(diagnostics: Iterable[Diagnostic], folder: PurePath) -> str:
    """Return one SARIF log, keys in fixed order, findings by place, pure ASCII, ending in a line break.

    Args:
        folder: absolute; files in it are named relative to it, as ``%SRCROOT%``.
    """
    ordered = sorted(diagnostics, key=Diagnostic.sort_key)
    severities = all_codes()
    codes = sorted({diagnostic.code for diagnostic in ordered})
    driver = {
        "name": "cellc",
        "semanticVersion": __version__,
        "rules": [_rule(code, severities[code]) for code in codes],
    }
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "results": [_result(diagnostic, codes.index(diagnostic.code), folder) for diagnostic in ordered],
    }
    log = {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}
    return harmless_json(json.dumps(log, indent=2)) + "\n"


def _rule(code: str, severity: Severity) -> dict[str, object]:
    page = page_of(code)
    text, title = render_page(page), f"{page.title}."
    return {
        "id": code,
        "shortDescription": {"text": title},
        "fullDescription": {"text": title},
        "defaultConfiguration": {"level": _LEVELS[severity]},
        "help": {"text": text, "markdown": text},
        "properties": {"severity": severity.value, "tags": [family_of(code)]},
    }


def _result(diagnostic: Diagnostic, index: int, folder: PurePath) -> dict[str, object]:
    message = escaped(diagnostic.message)
    advice = f"\nhelp: {escaped(diagnostic.help)}" if diagnostic.help else ""
    result: dict[str, object] = {
        "ruleId": diagnostic.code,
        "ruleIndex": index,
        "level": _LEVELS[diagnostic.severity],
        "message": {"text": f"{message}{advice}"},
        "locations": [_location(diagnostic, folder)],
        "properties": {"severity": diagnostic.severity.value},
    }
    if diagnostic.related:
        result["relatedLocations"] = [
            {"id": number, **_place(related.span, folder), "message": {"text": escaped(related.message)}}
            for number, related in enumerate(diagnostic.related, 1)
        ]
    if diagnostic.fix is not None:
        result["fixes"] = [_fix(diagnostic.fix, folder)]
    return result


def _fix(fix: Fix, folder: PurePath) -> dict[str, object]:
    """Return the edit as section 3.55 of SARIF has it."""
    place = _physical(fix.span, folder)
    replaced = {"deletedRegion": place["region"], "insertedContent": {"text": escaped(fix.text)}}
    change = {"artifactLocation": place["artifactLocation"], "replacements": [replaced]}
    text = f"`{fix.written}` becomes `{fix.text}`"
    return {"description": {"text": escaped(text)}, "artifactChanges": [change]}


def _location(diagnostic: Diagnostic, folder: PurePath) -> dict[str, object]:
    location = _place(diagnostic.span, folder)
    if diagnostic.yaml_path:
        location["logicalLocations"] = [{"fullyQualifiedName": escaped(format_path(diagnostic.yaml_path))}]
    return location


def _place(span: Span, folder: PurePath) -> dict[str, object]:
    return {"physicalLocation": _physical(span, folder)}


def _physical(span: Span, folder: PurePath) -> dict[str, object]:
    uri = file_uri(span.file, folder)
    artifact = {"uri": uri}
    # A base is only for what lies under it (section 3.4.4).
    if not uri.startswith(("file:", "..")):
        artifact["uriBaseId"] = "%SRCROOT%"
    region = {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }
    return {"artifactLocation": artifact, "region": region}
