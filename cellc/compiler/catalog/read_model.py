"""A catalog file into its model, with the places of its values kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from cellc.compiler.catalog.catalog_model import DAY, INNER, URL
from cellc.compiler.source.compose import compose
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.source.text import read_text
from cellc.compiler.spec.errors import problem_of
from cellc.compiler.spec.place import place_of
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, YamlPath, format_path
from cellc.contract.limits import Limits, limits

ModelT = TypeVar("ModelT", bound=BaseModel)
_CODE = "catalog-entry-invalid"
_UNKNOWN_KEY = "extra_forbidden"
_WORDINGS = {_UNKNOWN_KEY: "there is no key `{}`", "missing": "`{}` is missing"}
_A_NAME = "use letters, digits and `_`, a letter first"
_SHAPES = {
    DAY: "write the day as `2026-07-01`",
    INNER: "write the path from the folder down, with forward slashes",
    URL: "write `https://HOST/PATH`, `ssh://HOST/PATH` or `git@HOST:PATH`",
}
_HELP = {"missing": "add it"}
_KEPT = 32  # files of the devices of a few cells


def is_device(data: object) -> bool:
    """Tell whether a document is a device, by its first keys; a spec has `devices`."""
    return isinstance(data, dict) and ("model" in data or "family" in data) and "devices" not in data


def read_model(path: Path, shown: str, model: type[ModelT]) -> Outcome[tuple[ModelT, SourceDocument]]:
    """Read one YAML file of the catalog, or one like it that a user wrote.

    Args:
        path: the file.
        shown: its name in spans.
        model: what it must be.
    """
    read = read_document(path, shown)
    return Outcome(None, read.diagnostics) if read.value is None else validated(read.value, model)


def read_document(path: Path, shown: str, fill: Mapping[str, str] | None = None) -> Outcome[SourceDocument]:
    """Read one YAML file that holds data; ``fill`` has what represents placeholders in its text."""
    text = read_text(path, shown, Span(shown, 1, 1, 1, 1))
    if text.value is None:
        return Outcome(None, text.diagnostics)
    filled = text.value
    for placeholder, value in (fill or {}).items():
        filled = filled.replace(placeholder, value)
    return _composed(shown, text.value, filled, limits())


@lru_cache(maxsize=_KEPT)
def _composed(shown: str, text: str, filled: str, _bounds: Limits) -> Outcome[SourceDocument]:
    """Return a text as a document; cells of one folder name the same devices, and an editor asks at every change."""
    composed = compose(shown, filled)
    if composed.diagnostics:
        return Outcome(None, composed.diagnostics)
    if composed.value is None or composed.value.data is None:
        place = Span(shown, 1, 1, 1, 1)
        return Outcome(None, (Diagnostic("empty-file", Severity.ERROR, f"`{shown}` holds no data", place),))
    return Outcome(SourceDocument(shown, {shown: text}, composed.value))


def validated(document: SourceDocument, model: type[ModelT]) -> Outcome[tuple[ModelT, SourceDocument]]:
    """Return what a document says as a model, or a finding at each value that it cannot be."""
    try:
        value = model.model_validate(_frozen(document.data))
    except ValidationError as error:
        return Outcome(None, tuple(_findings(error, document, model)))
    return Outcome((value, document))


def _frozen(data: object) -> object:
    # Strict models of frozen values take tuples; YAML gives lists.
    if isinstance(data, list):
        return tuple(_frozen(item) for item in data)
    if isinstance(data, dict):
        return {key: _frozen(value) for key, value in data.items()}
    return data


def _findings(error: ValidationError, document: SourceDocument, model: type[BaseModel]) -> Iterator[Diagnostic]:
    for problem in error.errors(include_url=False):
        path = _path_in(document.data, problem["loc"])
        name = format_path(path) or document.file
        wording = _WORDINGS.get(problem["type"])
        said = problem_of(problem, place_of(problem["loc"], model), document)
        message = wording.format(name) if wording else said.message
        place = document.locate_key(path) if problem["type"] == _UNKNOWN_KEY else document.locate(path)
        shape = str(problem.get("ctx", {}).get("pattern", ""))
        advice = _SHAPES.get(shape, _A_NAME) if shape else _HELP.get(problem["type"], said.help)
        yield Diagnostic(_CODE, Severity.ERROR, message, place, path, advice)


def _path_in(data: object, location: tuple[int | str, ...]) -> YamlPath:
    # pydantic puts union tags and `[key]` among the parts: they are no part of the document.
    path: list[int | str] = []
    for position, part in enumerate(location):
        if isinstance(data, dict) and (part in data or position == len(location) - 1):
            data = data.get(part)
        elif isinstance(data, list) and isinstance(part, int) and part < len(data):
            data = data[part]
        else:
            continue
        path.append(part)
    return tuple(path)
