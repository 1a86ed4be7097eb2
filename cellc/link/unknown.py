"""The one mistake that linking reports most: a name that nothing has."""

from __future__ import annotations

from collections.abc import Iterable

from cellc.diagnostics import Diagnostic, Severity, YamlPath, did_you_mean
from cellc.source.document import SourceDocument


def unknown_name(
    code: str, name: str, kind: str, candidates: Iterable[str], document: SourceDocument, path: YamlPath
) -> Diagnostic:
    """Report a reference to something that does not exist, with the nearest names that do.

    Args:
        kind: singular noun, such as ``frame``; its plural is formed with ``s``.
        path: where the reference is written.
    """
    return Diagnostic(
        code=code,
        severity=Severity.ERROR,
        message=f"there is no {kind} `{name}`",
        span=document.locate(path),
        yaml_path=path,
        help=did_you_mean(name, candidates, f"{kind}s of this cell"),
    )
