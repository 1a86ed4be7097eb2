"""Mappings whose kind is the first of its keys: a fault is a `freeze`, a `delay`, ….

A model is made, and its validator built, when the first mapping of its kind is read: a check of a cell pays for the
kinds that the cell has.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, SchemaValidator, core_schema

from cellc.contract.stated import StatedModel

_Key = TypeVar("_Key", bound=str)


def first_key(value: object, keys: tuple[_Key, ...]) -> _Key | None:
    """Return the first of ``keys`` that a mapping has."""
    return next((key for key in keys if key in value), None) if isinstance(value, dict) else None


class Kinds(Generic[_Key]):
    """Annotates the base of several models: a mapping is read by the model of its kind.

    Args:
        keys: one for each kind, in the order of the reference.
        model: makes the model of a key, and returns the same one whenever it is asked.
        noun: the thing in messages; NOUN-kind-missing is the code of a mapping without any of the keys.
    """

    def __init__(self, noun: str, keys: tuple[_Key, ...], model: Callable[[_Key], type[StatedModel]]) -> None:
        self.keys = keys
        self.model = model
        self._missing = f"{noun}-kind-missing"
        self._readers: dict[str, SchemaValidator] = {}

    def key_of(self, value: object) -> _Key | None:
        """Return the key that says the kind of a mapping; None without one."""
        return first_key(value, self.keys)

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self._read)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return handler(self._union(self.keys))

    def _read(self, value: object) -> object:
        key = self.key_of(value)
        if key is None:
            raise PydanticCustomError(self._missing, "none of the keys {keys}", {"keys": ", ".join(self.keys)})
        if key not in self._readers:
            self._readers[key] = SchemaValidator(self._union((key,)))
        return self._readers[key].validate_python(value)

    def _union(self, keys: tuple[_Key, ...]) -> core_schema.CoreSchema:
        """Return the schema of some kinds; the key is a part of the location of an error, as in every tagged union."""
        choices: dict[str, core_schema.CoreSchema] = {}
        for key in keys:
            model = self.model(key)
            model.model_rebuild()
            choices[str(key)] = model.__pydantic_core_schema__
        return core_schema.tagged_union_schema(choices, discriminator=self.key_of)
