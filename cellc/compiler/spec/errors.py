"""Turn one error of the models into a code, a message and a help in the words of a YAML author."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import Enum
from typing import Annotated, Literal, TypeAlias, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.place import Place, bare, branches, fields_by_key, is_tagged, model_of
from cellc.compiler.spec.quantity import UNIT_OF_SPELLING
from cellc.compiler.spec.wording import (
    could_mean,
    describe,
    help_for_bad_name,
    help_for_unknown_key,
    meant_key,
    quote,
    quote_path,
    scalar_text,
    value_at,
)
from cellc.contract.diagnostics import Advice, did_you_mean, nearest, only_nearest
from cellc.contract.frozen import dataclass

_TYPES: Mapping[str, str] = {
    "string_type": "text",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "bool_type": "`true` or `false`",
    "tuple_type": "a list",
    "dict_type": "a mapping",
    "model_type": "a mapping",
}


_TRUTHS = ("true", "false")
_WORDS_OF_YAML_1_1 = {"yes": "true", "y": "true", "on": "true", "no": "false", "n": "false", "off": "false"}


@dataclass(frozen=True, slots=True)
class Problem:
    """What is wrong in one place, before it has a span."""

    code: str
    message: str
    help: str
    written: str = ""
    meant: str | None = None
    """What may stand in the place of what is written, where one thing alone may."""


_Writer: TypeAlias = Callable[[ErrorDetails, Place, SourceDocument], Problem]


def problem_of(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    """Say what is wrong; a kind of error that no writer knows is reported as a value of the wrong type."""
    if error["type"] in _TYPES:
        return _wrong_type(_TYPES[error["type"]], place, document)
    return _WRITERS.get(error["type"], _other)(error, place, document)


def _missing(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    key = str(place.path[-1])
    message = f"{quote_path(place.path[:-1])} has no `{key}`"
    return Problem("missing-key", message, f"add `{key}`: {_meaning(place.field)}")


def _unknown_key(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    key = str(place.path[-1])
    message = f"{quote_path(place.path[:-1])} has no key {quote(key)}"
    help_ = help_for_unknown_key(key, place)
    if isinstance(help_, Advice):  # a key that is there already would be there twice
        help_ = help_.without(other for other in help_.instead if document.has((*place.path[:-1], other)))
    return Problem("unknown-key", message, help_, key, meant_key(key, place))


def _wrong_type(expected: str, place: Place, document: SourceDocument) -> Problem:
    value = value_at(document.data, place.path)
    text = document.text_at(place.path)
    message = f"expected {expected} for {quote_path(place.path)}, got {describe(value, text)}"
    if expected == "text" and isinstance(value, (int, float)):
        return Problem("wrong-type", message, Advice(f'put it in quotes: `"{text}"`', text, (f'"{text}"',)))
    help_ = f"write {expected}{_example(place.field)}"
    if expected == _TYPES["bool_type"] and isinstance(value, str):
        near = (_WORDS_OF_YAML_1_1[value.lower()],) if value.lower() in _WORDS_OF_YAML_1_1 else nearest(value, _TRUTHS)
        help_ = Advice(help_, value, dict.fromkeys((*near, *_TRUTHS)), is_near=bool(near))
    return Problem("wrong-type", message, help_)


def _other(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    return _wrong_type("another kind of value", place, document)


def _no_branch(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    return _wrong_type(error["msg"], place, document)


def _not_a_choice(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    if place.is_key:
        return _key_not_a_choice(place)
    value = value_at(document.data, place.path)
    choices = [str(choice) for choice in literals(place.expected)]
    text = value if isinstance(value, str) else ""
    message = f"{quote_path(place.path)} must be one of its choices, got {describe(value)}"
    help_ = did_you_mean(text, choices, "choices")
    return Problem("not-a-choice", message, help_, text, only_nearest(text, choices))


def _key_not_a_choice(place: Place) -> Problem:
    key, holder = str(place.path[-1]), place.path[:-1]
    model_path, model = place.models[-1]
    keys = bare(dict_keys(model, str(holder[-1]))) if len(holder) == len(model_path) + 1 else object
    allowed = [str(choice) for choice in literals(keys)]
    help_ = did_you_mean(key, allowed, "keys that are allowed")
    message = f"{quote_path(holder)} has no key {quote(key)}"
    return Problem("unknown-key", message, help_, key, only_nearest(key, allowed))


def dict_keys(model: type, key: str) -> object:
    """Return the annotation of the keys of a field that is a mapping of names."""
    field = fields_by_key(model)[key]
    arguments = get_args(field.annotation)
    return arguments[0] if arguments else object


def literals(annotation: object) -> tuple[object, ...]:
    """Return the values of a literal annotation or of an enumeration."""
    if get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    if isinstance(annotation, type) and issubclass(annotation, Enum):
        return tuple(member.value for member in annotation)
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def _bad_name(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    name = str(place.path[-1]) if place.is_key else str(value_at(document.data, place.path))
    where = f"in {quote_path(place.path[:-1])}" if place.is_key else f"as {quote_path(place.path)}"
    pattern = str(error.get("ctx", {}).get("pattern", ""))
    return Problem("bad-name", f"{quote(name)} cannot be used {where}", help_for_bad_name(name, pattern))


def _number_out_of_range(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    context = error.get("ctx", {})
    bound = f"at least {context['ge']}" if "ge" in context else f"at most {context.get('le')}"
    value = scalar_text(value_at(document.data, place.path))
    message = f"{quote_path(place.path)} must be {bound}, got {quote(value)}"
    return Problem("out-of-range", message, f"write a number of {bound}{_example(place.field)}")


def _quantity_out_of_range(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    context = error["ctx"]
    message = f"{quote_path(place.path)} must be {context['bounds']}, got {quote(str(context['text']))}"
    return Problem("out-of-range", message, f"write a value {context['bounds']}{_example(place.field)}")


def _length_out_of_range(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    context = error.get("ctx", {})
    unit = "characters" if error["type"].startswith("string") else "entries"
    fewest, most = context.get("min_length"), context.get("max_length")
    bound = f"at least {fewest}" if fewest is not None else f"at most {most}"
    value = str(place.path[-1]) if place.is_key else value_at(document.data, place.path)
    actual = len(value) if isinstance(value, (str, list, dict)) else 0
    where = f"key {quote(str(place.path[-1]))}" if place.is_key else quote_path(place.path)
    message = f"{where} must have {bound} {unit}, got {actual}"
    return Problem("out-of-range", message, f"write {bound} {unit}{_example(place.field)}")


def _missing_unit(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    context = error["ctx"]
    text = document.text_at(place.path) or str(context["text"])
    message = f"expected {context['what']} with its unit, got {quote(text)}"
    instead = (f"{text.strip()} {unit}" for unit in _units(error))
    return Problem("missing-unit", message, Advice(_units_help(error), text, instead, is_near=False))


def _wrong_unit(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    context = error["ctx"]
    message = f"{quote(str(context['unit']))} is not a unit of {context['what']}"
    unit = str(context["unit"])
    meant = UNIT_OF_SPELLING.get(unit.lower())
    units = _units(error)
    if meant in units:
        return Problem("wrong-unit", message, Advice(_units_help(error), unit, (meant,)), unit, meant)
    near = nearest(unit, units)
    return Problem("wrong-unit", message, Advice(_units_help(error), unit, (*near, *units), is_near=bool(near)))


def _not_a_quantity(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    value = value_at(document.data, place.path)
    message = f"expected {error['ctx']['what']} for {quote_path(place.path)}, got {describe(value)}"
    return Problem("not-a-quantity", message, _units_help(error))


def _wrong_count(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    context = error["ctx"]
    message = f"{quote_path(place.path)} must have {context['size']} numbers, got {context['actual']}"
    return Problem("wrong-count", message, f"write {context['size']} numbers and their unit: `{context['example']}`")


def _units_help(error: ErrorDetails) -> str:
    units = [f"`{unit}`" for unit in str(error["ctx"]["units"]).split(", ")]
    listed = units[0] if len(units) == 1 else f"{', '.join(units[:-1])} or {units[-1]}"
    return f"write a number and the unit {listed}, such as `{error['ctx']['example']}`"


def _units(error: ErrorDetails) -> tuple[str, ...]:
    """Return the units that fit, that of the example first."""
    units = str(error["ctx"]["units"]).split(", ")
    example = str(error["ctx"]["example"])
    return tuple(sorted(units, key=lambda unit: not example.endswith(f" {unit}")))


def _kind_missing(error: ErrorDetails, place: Place, document: SourceDocument) -> Problem:
    value = value_at(document.data, place.path)
    if not isinstance(value, dict):
        return _wrong_type("a mapping", place, document)
    kinds = list(branches(place.expected)) if is_tagged(place.expected) else []
    misspelt = [(key, kind) for key in value for kind in kinds if could_mean(key, kind)]
    listed = ", ".join(f"`{kind}`" for kind in kinds)
    help_ = f"write one of the keys {listed}"
    if misspelt:
        key, kind = misspelt[0]
        help_ = Advice(f"did you mean `{kind}` where {quote(key)} stands?", key, (kind,))
    return Problem(error["type"], f"{quote_path(place.path)} has none of the keys {listed}", help_)


def _meaning(field: FieldInfo | None) -> str:
    """Write what a field is for, with its example if that is a scalar."""
    text = (field.description or "").rstrip(".") if field is not None else ""
    return (text[:1].lower() + text[1:] if text[1:2].islower() else text) + _example(field)


def _example(field: FieldInfo | None) -> str:
    example = field.examples[0] if field is not None and field.examples else None
    if example is None or (field is not None and model_of(field.annotation) is not None):
        return ""
    return f", such as `{scalar_text(example)}`" if isinstance(example, (str, int, float)) else ""


_WRITERS: Mapping[str, _Writer] = {
    "missing": _missing,
    "extra_forbidden": _unknown_key,
    "literal_error": _not_a_choice,
    "enum": _not_a_choice,
    "string_pattern_mismatch": _bad_name,
    "greater_than_equal": _number_out_of_range,
    "less_than_equal": _number_out_of_range,
    "quantity-out-of-range": _quantity_out_of_range,
    "string_too_short": _length_out_of_range,
    "string_too_long": _length_out_of_range,
    "too_short": _length_out_of_range,
    "too_long": _length_out_of_range,
    "missing-unit": _missing_unit,
    "wrong-unit": _wrong_unit,
    "not-a-quantity": _not_a_quantity,
    "wrong-count": _wrong_count,
    "wrong-type": _no_branch,
    "interface-kind-missing": _kind_missing,
    "step-kind-missing": _kind_missing,
    "fault-kind-missing": _kind_missing,
    "solid-kind-missing": _kind_missing,
}
