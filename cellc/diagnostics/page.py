"""The documentation page behind a diagnostic code."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.diagnostics.diagnostic import Severity


@dataclass(frozen=True, slots=True)
class CodePage:
    """What ``cellc explain CODE`` prints.

    Args:
        code: stable kebab-case name of the defect, such as ``duplicate-key``.
        title: what is wrong, as a phrase that ends without a full stop.
        why: one paragraph on what would happen if it passed unreported.
        fix: what to do, beginning with a verb; also the help of a finding that knows nothing more precise.
    """

    code: str
    severity: Severity
    title: str
    why: str
    fix: str
