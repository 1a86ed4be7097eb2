"""Every code that reading descriptions and the catalog can report."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.diagnostics import Severity

CODES: Mapping[str, Severity] = {
    **dict.fromkeys(
        (
            "catalog-entry-invalid",
            "urdf-bad-geometry",
            "urdf-bad-number",
            "urdf-missing-attribute",
            "urdf-missing-element",
            "urdf-not-a-robot",
            "urdf-not-expanded",
            "urdf-unknown-joint-type",
            "xacro-bad-yaml",
            "xacro-failed",
            "xacro-file-not-found",
            "xacro-missing-argument",
            "xacro-not-text",
            "xacro-outside-root",
            "xacro-package-not-found",
            "xacro-refused-expression",
            "xacro-refused-substitution",
            "xacro-too-large",
            "xacro-unknown-argument",
            "xml-entities",
            "xml-not-well-formed",
            "xml-too-deep",
            "xml-too-large",
        ),
        Severity.ERROR,
    ),
    "xacro-warning": Severity.WARNING,
}
