"""Findings to render."""

from __future__ import annotations

from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span

FILE = "cells/a.yaml"


def finding(
    span: Span | None = None,
    message: str = "limit is reversed",
    *,
    severity: Severity = Severity.ERROR,
    advice: str = "",
    related: tuple[Related, ...] = (),
) -> Diagnostic:
    place = span if span is not None else Span(FILE, 1, 1, 1, 4)
    return Diagnostic("reversed-limits", severity, message, place, ("arm", 0), advice, related)
