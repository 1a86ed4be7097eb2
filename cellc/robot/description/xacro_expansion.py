"""One expansion of a xacro file, every failure a diagnostic: in this process, or in a child with limits.

A file of the catalog is expanded here. A file of the user is expanded in a child process with bounded time, memory
and output: the confinement refuses what reaches out of the folder, the process ends an expansion that takes too long.
Started as a program, this module is that child: it reads one request from stdin and answers on stdout.
"""

from __future__ import annotations

import json
import math
import os
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.dom import minidom

import xacro

from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, did_you_mean, nearest
from cellc.contract.frozen import dataclass
from cellc.contract.limits import MIB, Budget, as_options, limits, option, raised, use
from cellc.robot.description.confined_child import HANG_S, ChildEndedError, ask_child, confine_this_process
from cellc.robot.description.packages import package_path, use_packages
from cellc.robot.description.xacro_confinement import Confinement, place_of
from cellc.robot.description.xacro_expression import ExpressionError
from cellc.robot.description.xacro_files import XacroRefusedError

_MISFIT = re.compile(r"Invalid parameter|Undefined parameters|Not enough blocks|Unused block")
_UNKNOWN_MACRO = re.compile(r"unknown macro name: (?:xacro:)?(\S+)")


@dataclass(frozen=True, slots=True)
class Expansion:
    """URDF text, and where each ``("link", name)`` and ``("joint", name)`` was written before the expansion."""

    text: str
    origins: dict[tuple[str, str], Span]


def expand_here(
    file: str, arguments: Mapping[str, str], root: str, shown_root: str | None = None, beside: Sequence[str] = ()
) -> Outcome[Expansion]:
    """Expand a xacro file in this process: for files of the catalog, or inside a limited child process.

    Args:
        file: the xacro file, as the user named it; its includes are found beside it.
        arguments: values of ``<xacro:arg>``.
        root: the folder that no file may lie outside of.
        shown_root: what represents ``root`` in messages, where its place on the machine is of no interest.
        beside: further folders of packages that the spec names.
    """
    confinement = Confinement(root, shown_root, beside)
    start = Span(confinement.files.shown(file), 1, 1, 1, 1)
    with confinement.installed():
        try:
            document = _process(confinement, file, arguments)
            for mesh in document.getElementsByTagName("mesh"):
                mesh.setAttribute("filename", confinement.in_packages(mesh.getAttribute("filename")))
            text = document.toprettyxml(indent="  ")
        except Exception as error:
            return Outcome(None, (_failure(error, confinement, start),))
    unknown = _unknown_arguments(arguments, confinement.known_arguments, start)
    if unknown:
        return Outcome(None, unknown)
    if len(text.encode()) > limits().xml_bytes:
        message = f"the expansion is larger than {limits().xml_bytes // MIB} MiB"
        return Outcome(None, (Diagnostic("xacro-too-large", Severity.ERROR, message, start, help=option("xml-bytes")),))
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
    message = _one_line(str(error)) or type(error).__name__
    return Diagnostic("xacro-failed", Severity.ERROR, message, place, help=_macro_help(message, confinement))


def _macro_help(message: str, confinement: Confinement) -> str:
    """Write the help for a macro that is unknown, does not fit its call or has no prefix; empty for another message."""
    unknown, misfit = _UNKNOWN_MACRO.search(message), _MISFIT.match(message)
    called = unknown[1] if unknown else confinement.called
    defined = confinement.macros.get(called)
    place = "" if defined is None else f"line {defined.line} of `{defined.file.rpartition('/')[2]}`"
    if misfit:
        advice = f"compare with `params` of macro `{called}`, {place}, or take a release whose files fit each other"
        return advice if place else ""
    if unknown is None:
        tag = confinement.unprefixed
        return f"write `<xacro:{tag}>` for the `<{tag}>` around it: tags of xacro need the prefix" if tag else ""
    if place:
        return f"move its definition, {place}, above this call: xacro reads in order"
    if nearest(called, confinement.macros):
        return did_you_mean(called, confinement.macros, "macros")
    return "include the file that defines it above this call"


def _one_line(text: str) -> str:
    line = " ".join(text.replace(os.getcwd() + os.sep, "").split())
    return line if len(line) <= 300 else line[:299] + "…"


def expand_xacro(
    file: Path,
    arguments: Mapping[str, str],
    root: Path,
    wall_seconds: float = HANG_S,
    budget: Budget | None = None,
    beside: Sequence[str] = (),
) -> Outcome[Expansion]:
    """Expand a xacro file that the compiler does not vouch for.

    Args:
        file: the xacro file, as the user named it.
        arguments: values of ``<xacro:arg>``.
        root: the folder that no file may lie outside of.
        wall_seconds: time by the clock after which the expansion hangs.
        budget: processor time of the expansions of the spec; one that ends for its time is the last.
        beside: further folders of packages that the spec names.

    Returns:
        The URDF text with the places of its links and joints, or diagnostics; never an exception.
    """
    request = {
        "file": file.as_posix(),
        "arguments": dict(arguments),
        "root": root.as_posix(),
        "beside": list(beside),
        "folder": os.getcwd(),
        "limits": as_options(limits()),
        "packages": [os.path.abspath(folder) for folder in package_path()],
        "seconds": limits().xacro_seconds,
    }
    start = Span(file.as_posix(), 1, 1, 1, 1)
    if budget is not None:
        if not budget.left_s:
            return _ended("the expansion was not started: others of the spec used the time", start, "-together")
        request["seconds"] = min(limits().xacro_seconds, math.ceil(budget.left_s))
    try:
        answer = ask_child(__name__, json.dumps(request).encode(), wall_seconds)
    except ChildEndedError as reason:
        if budget is not None:
            budget.empty()
        return _ended(f"the expansion {reason}", start)
    return _decoded(json.loads(answer))


def _ended(message: str, start: Span, of: str = "") -> Outcome[Expansion]:
    help_text = f"look for a macro or an include that calls itself; {option('xacro-seconds' + of)}"
    return Outcome(None, (Diagnostic("xacro-too-large", Severity.ERROR, message, start, help=help_text),))


def _encoded(outcome: Outcome[Expansion]) -> dict[str, Any]:
    """Write an outcome as JSON values, for the way from the child to the parent."""
    expansion = outcome.value
    return {
        "text": None if expansion is None else expansion.text,
        "origins": [] if expansion is None else [[*key, _span_values(span)] for key, span in expansion.origins.items()],
        "diagnostics": [
            [
                diagnostic.code,
                diagnostic.severity.value,
                diagnostic.message,
                _span_values(diagnostic.span),
                diagnostic.help,
            ]
            for diagnostic in outcome.diagnostics
        ],
    }


def _span_values(span: Span) -> list[str | int]:
    return [span.file, span.line, span.column, span.end_line, span.end_column]


def _decoded(answer: dict[str, Any]) -> Outcome[Expansion]:
    diagnostics = tuple(
        Diagnostic(code, Severity(severity), message, Span(*span), help=help_text)
        for code, severity, message, span, help_text in answer["diagnostics"]
    )
    if answer["text"] is None:
        return Outcome(None, diagnostics)
    origins = {(tag, name): Span(*span) for tag, name, span in answer["origins"]}
    return Outcome(Expansion(answer["text"], origins), diagnostics)


def main() -> None:
    """Expand what stdin asks for."""
    request = json.load(sys.stdin)
    use(raised(request["limits"]))
    use_packages(request["packages"])
    confine_this_process(request["seconds"], limits().xacro_memory, 4 * limits().xml_bytes)
    os.chdir(request["folder"])  # names in diagnostics stay those that the user wrote
    expanded = expand_here(request["file"], request["arguments"], request["root"], beside=request["beside"])
    json.dump(_encoded(expanded), sys.stdout)


if __name__ == "__main__":
    main()
