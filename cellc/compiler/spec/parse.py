"""Read the plain data of a spec into strict models, and say everything that does not fit in one pass."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import TypeVar

from pydantic import ValidationError

from cellc.compiler.source.document import MAX_FINDINGS, Plain, SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.errors import Problem, problem_of
from cellc.compiler.spec.place import place_of
from cellc.compiler.spec.wording import could_mean, describe, quote_path, value_at
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath, is_slip
from cellc.contract.stated import StatedModel

_Spec = TypeVar("_Spec", bound=StatedModel)
_FORMATS = (1,)
_UNKNOWN = "extra_forbidden"  # how the models report a key that they do not have


def parse(document: SourceDocument) -> Outcome[CellSpec]:
    """Return the spec of a cell as its author wrote it, or one diagnostic for every mistake of shape.

    Names are not resolved and values not judged: that is for link and the rules.
    """
    return parse_as(CellSpec, document)


def parse_as(model: type[_Spec], document: SourceDocument) -> Outcome[_Spec]:
    """Return what a document says by the model of its root, or one diagnostic for every mistake of shape."""
    data = document.data
    unsupported = _unsupported_format(data, document)
    if unsupported is not None:
        return Outcome(None, (unsupported,))
    empty = tuple(islice(_empty_values(data, ()), MAX_FINDINGS))
    try:
        spec = model.model_validate(_with_tuples(data))
    except ValidationError as error:
        problems = tuple(_diagnostics(error, document, model))
        unknown = {d.yaml_path for d in problems if d.code == "unknown-key"}
        problems += tuple(_empty_diagnostics(tuple(path for path in empty if path not in unknown), document))
        return Outcome(None, tuple(sorted(problems, key=Diagnostic.sort_key)))
    return Outcome(None if empty else spec, tuple(_empty_diagnostics(empty, document)))


def _unsupported_format(data: Plain, document: SourceDocument) -> Diagnostic | None:
    # Another format has other keys: its first error would be the only one that means anything.
    value = data.get("format") if isinstance(data, dict) else None
    if value is None or (value in _FORMATS and type(value) is int):
        return None
    message = f"`format` must be `1`, got {describe(value)}"
    help_ = "write `format: 1`, or use the release of cellc that the spec was written for"
    return _diagnostic(Problem("unsupported-format", message, help_), ("format",), document, is_key=False)


def _empty_values(data: Plain, path: YamlPath) -> Iterator[YamlPath]:
    if data is None:
        yield path
    elif isinstance(data, dict):
        for key, value in data.items():
            yield from _empty_values(value, (*path, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from _empty_values(value, (*path, index))


def _with_tuples(data: Plain) -> object:
    """Turn lists into tuples, which is what strict frozen models take."""
    if isinstance(data, dict):
        return {key: _with_tuples(value) for key, value in data.items()}
    return tuple(_with_tuples(value) for value in data) if isinstance(data, list) else data


def _diagnostics(error: ValidationError, document: SourceDocument, model: type[StatedModel]) -> Iterator[Diagnostic]:
    details = error.errors(include_url=False, include_input=False)[:MAX_FINDINGS]
    places = [place_of(detail["loc"], model) for detail in details]
    unknown = [place.path for place, detail in zip(places, details, strict=True) if detail["type"] == _UNKNOWN]
    for place, detail in zip(places, details, strict=True):
        kind = detail["type"]
        is_key = place.is_key or kind == _UNKNOWN
        if kind == "missing" and _is_misspelled(place.path, unknown):
            continue
        if is_key or kind == "missing" or value_at(document.data, place.path) is not None:
            yield _diagnostic(problem_of(detail, place, document), place.path, document, is_key=is_key)


def _is_misspelled(missing: YamlPath, unknown: list[YamlPath]) -> bool:
    return any(path[:-1] == missing[:-1] and could_mean(str(path[-1]), str(missing[-1])) for path in unknown)


def _empty_diagnostics(empty: tuple[YamlPath, ...], document: SourceDocument) -> Iterator[Diagnostic]:
    for path in empty:
        help_ = "write a value, or delete the key" if isinstance(path[-1], str) else "write a value, or delete the dash"
        problem = Problem("empty-value", f"{quote_path(path)} has no value", help_)
        yield _diagnostic(problem, path, document, is_key=True)


def _diagnostic(problem: Problem, path: YamlPath, document: SourceDocument, *, is_key: bool) -> Diagnostic:
    span = document.locate_key(path) if is_key else document.locate(path)
    fix = None
    if problem.meant is not None and not (problem.code == "unknown-key" and document.has((*path[:-1], problem.meant))):
        # A unit has its spellings; of a key or a choice, one slip of the fingers is sure.
        sure = problem.code == "wrong-unit" or is_slip(problem.written, problem.meant)
        fix = document.fix(span, problem.written, problem.meant, sure=sure)
    return Diagnostic(problem.code, Severity.ERROR, problem.message, span, path, problem.help, fix=fix)
