"""One expansion of a xacro file in this process, every failure told as a diagnostic."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from xml.dom import minidom

import xacro

from cellc.description.xacro_confinement import Confinement, place_of
from cellc.description.xacro_expression import ExpressionError
from cellc.description.xacro_files import XacroRefusedError
from cellc.description.xml_tree import MAX_BYTES
from cellc.diagnostics import Diagnostic, Outcome, Severity, Span, did_you_mean


@dataclass(frozen=True, slots=True)
class Expansion:
    """URDF text, and where each ``("link", name)`` and ``("joint", name)`` was written before the expansion."""

    text: str
    origins: dict[tuple[str, str], Span]


def expand_here(
    file: str, arguments: Mapping[str, str], root: str, shown_root: str | None = None
) -> Outcome[Expansion]:
    """Expand a xacro file in this process: for files of the catalogue, or inside a limited child process.

    Args:
        file: the xacro file, as the user named it; its includes are found beside it.
        arguments: values of ``<xacro:arg>``.
        root: the folder that no file may lie outside of.
        shown_root: what stands for ``root`` in messages, where its place on the machine is of no interest.
    """
    confinement = Confinement(root, shown_root)
    start = Span(confinement.files.shown(file), 1, 1, 1, 1)
    with confinement.installed():
        try:
            document = _process(confinement, file, arguments)
            text = document.toprettyxml(indent="  ")
        except Exception as error:
            return Outcome(None, (_failure(error, confinement, start),))
    unknown = _unknown_arguments(arguments, confinement.declared_arguments, start)
    if unknown:
        return Outcome(None, unknown)
    if len(text.encode()) > MAX_BYTES:
        message = f"the expansion is larger than {MAX_BYTES // 2**20} MiB"
        return Outcome(None, (Diagnostic("xacro-too-large", Severity.ERROR, message, start),))
    warnings = tuple(
        Diagnostic("xacro-warning", Severity.WARNING, _one_line(warning), start) for warning in confinement.warnings
    )
    return Outcome(Expansion(text, _origins(document)), warnings)


def _process(confinement: Confinement, file: str, arguments: Mapping[str, str]) -> Any:
    xacro.init_stacks(file)
    document = confinement.parse(None, file)
    try:
        xacro.process_doc(document, mappings=dict(arguments), verbosity=0)
    finally:
        xacro.all_includes.clear()
        xacro.substitution_args_context["arg"] = {}
    return document


def _origins(document: Any) -> dict[tuple[str, str], Span]:
    places: dict[tuple[str, str], Span] = {}
    for node in document.documentElement.childNodes:
        place = place_of(node) if node.nodeType == minidom.Node.ELEMENT_NODE else None
        if place is not None and node.tagName in ("link", "joint"):
            places.setdefault((node.tagName, node.getAttribute("name")), place)
    return places


def _unknown_arguments(arguments: Mapping[str, str], declared: set[str], start: Span) -> tuple[Diagnostic, ...]:
    return tuple(
        Diagnostic(
            "xacro-unknown-argument",
            Severity.ERROR,
            f"the description has no argument `{name}`",
            start,
            help=did_you_mean(name, declared, "arguments of the description"),
        )
        for name in arguments
        if name not in declared
    )


def _failure(error: Exception, confinement: Confinement, start: Span) -> Diagnostic:
    place = confinement.place or start
    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, XacroRefusedError):
            return Diagnostic(
                cause.code, Severity.ERROR, _one_line(cause.message), cause.span or place, help=cause.help_text
            )
        if isinstance(cause, ExpressionError):
            help_text = "use numbers, texts, lists and the functions that xacro documents"
            return Diagnostic("xacro-refused-expression", Severity.ERROR, _one_line(str(cause)), place, help=help_text)
        if isinstance(cause, (RecursionError, MemoryError)):
            message = "the expansion does not end within the memory and depth that it may use"
            return Diagnostic("xacro-too-large", Severity.ERROR, message, place)
        cause = getattr(cause, "exc", None)
    return Diagnostic("xacro-failed", Severity.ERROR, _one_line(str(error)) or type(error).__name__, place)


def _one_line(text: str) -> str:
    line = " ".join(text.replace(os.getcwd() + os.sep, "").split())
    return line if len(line) <= 300 else line[:299] + "…"
